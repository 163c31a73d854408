#include "thermfit/statistics/follows.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {
struct Draws {
  std::mt19937 random;
  Vector steps() {
    Vector series(120);
    double level = 0;
    for (int i = 0; i < 120; ++i) series(i) = level = random() % 15 == 0 ? static_cast<double>(random() % 7) : level;
    return series;
  }
};
}  // namespace

TEST_CASE("a residual that trails an input is said to follow it, with its lag", "[gap]") {
  Draws draws{std::mt19937(3)};
  Course speed{"spindle_rpm", {}}, feed{"feed_mm_min", {}};
  std::vector<Vector> residual;
  for (int b = 0; b < 6; ++b) {
    speed.series.push_back(draws.steps());
    feed.series.push_back(draws.steps());
    Vector late = speed.series.back();
    for (int i = 119; i >= 0; --i) late(i) = -2 * late(std::max(0, i - 12));
    residual.push_back(late);
  }
  const Follows found = follows(residual, {feed, speed});
  CHECK(found.course == "spindle_rpm");
  CHECK(found.correlation < -.9);
  CHECK(found.lag_share == Approx(.1).margin(.02));
}

TEST_CASE("slow residuals that have nothing to do with the inputs are rarely said to follow one", "[gap]") {
  Draws draws{std::mt19937(11)};
  int named = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Course speed{"spindle_rpm", {}}, feed{"feed_mm_min", {}};
    std::vector<Vector> residual;
    for (int b = 0; b < 6; ++b) {
      speed.series.push_back(draws.steps());
      feed.series.push_back(draws.steps());
      residual.push_back(draws.steps());
    }
    named += !follows(residual, {feed, speed}).course.empty();
  }
  CHECK(named <= 5);
}
