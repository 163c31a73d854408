#include "thermfit/findings/course.hpp"

#include <cmath>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

std::vector<double> warming(std::size_t count) {
  std::vector<double> x;
  for (std::size_t i = 0; i < count; ++i) x.push_back(20 + 8 * (1 - std::exp(-double(i) / 25)));
  return x;
}

SeriesCourse course(const std::vector<double>& x, bool known = false) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < x.size(); ++i) rows.push_back(static_cast<Index>(i));
  return series_course(x, rows, {0.5, 4, 5}, [&](std::size_t, std::size_t) { return known; });
}

using Readings = std::vector<std::size_t>;

}  // namespace

TEST_CASE("a smooth course, its corners and a fast start have nothing off it", "[findings]") {
  CHECK(course(warming(100)).off.empty());
  std::vector<double> corner;
  for (int i = 0; i < 60; ++i) corner.push_back(i < 30 ? 20. + i : 50 - 2. * (i - 30));
  CHECK(course(corner).off.empty());
  CHECK(course(corner).breaks.empty());
  CHECK(course({20, 23, 24.5, 25.2, 25.6, 25.8, 25.9}).off.empty());
  CHECK(course({1, 2, 3}).off.empty());
}

TEST_CASE("up to five readings in a row that the course comes back from are off it, wherever they lie", "[findings]") {
  for (std::size_t length = 1; length <= 5; ++length)
    for (std::size_t first = 3; first + length < 96; ++first) {
      std::vector<double> x = warming(100);
      Readings wrong;
      for (std::size_t i = first; i < first + length; ++i) {
        x[i] += 6;
        wrong.push_back(i);
      }
      CHECK(course(x).off == wrong);
      CHECK(course(x).breaks.empty());
    }
}

TEST_CASE("of alternate readings the wrong ones are off the course", "[findings]") {
  std::vector<double> x = warming(100);
  Readings wrong;
  for (std::size_t i = 21; i < 80; i += 2) {
    x[i] -= 4;
    wrong.push_back(i);
  }
  CHECK(course(x).off == wrong);
}

TEST_CASE("a step that stays is one break, and costs less where its cause is known", "[findings]") {
  std::vector<double> x = warming(100);
  for (std::size_t i = 50; i < 100; ++i) x[i] += 3;
  const SeriesCourse one = course(x);
  CHECK(one.off.empty());
  REQUIRE(one.breaks.size() == 1);
  CHECK(one.breaks[0].from == 49);
  CHECK(one.breaks[0].to == 50);
  std::vector<double> burst = warming(100);
  for (std::size_t i = 50; i < 54; ++i) burst[i] += 3;
  CHECK(course(burst).off.size() == 4);
  CHECK(course(burst, true).off.empty());
}
