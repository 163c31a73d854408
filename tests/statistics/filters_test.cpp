#include "thermfit/statistics/filters.hpp"

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("a first-order lag answers a held step and a ramp as their closed forms say, whatever the sampling",
          "[gap]") {
  Vector time_s(6);
  time_s << 0, 10, 15, 60, 200, 900;
  const Vector step = low_pass_held(time_s, Vector::Ones(6), 120);
  const Vector ramp = low_pass(time_s, .5 * time_s, 120, 0);
  for (int k = 0; k < 6; ++k) {
    const double decay = std::exp(-time_s(k) / 120);
    CHECK(step(k) == Approx(1 - decay).margin(1e-12));
    CHECK(ramp(k) == Approx(.5 * (time_s(k) - 120 * (1 - decay))).margin(1e-12));
  }
}

TEST_CASE("a delayed line is the line earlier, and holds its first value before the start", "[gap]") {
  const Vector time_s = Vector::LinSpaced(11, 0, 1000);
  const Vector late = delayed(time_s, 2 * time_s, 150);
  CHECK(late(0) == 0);
  CHECK(late(1) == 0);
  CHECK(late(5) == Approx(2 * (500 - 150)));
}

TEST_CASE("play follows with its half-width behind and stays where the course turns", "[gap]") {
  Vector course(6);
  course << 0, 1, 3, 2.5, 1.5, -2;
  const Vector late = play(course, .5);
  Vector expected(6);
  expected << 0, .5, 2.5, 2.5, 2, -1.5;
  CHECK((late - expected).norm() == Approx(0).margin(1e-12));
}
