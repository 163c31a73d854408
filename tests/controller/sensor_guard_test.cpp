#include "thermfit/controller/sensor_guard.hpp"

#include <cmath>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

struct Bench {
  SensorGuard<double, 3> guard;
  std::array<SensorLimits<double>, 3> limits{};
  GuardPatience<double> patience{3, 4, 2, 0};

  Bench() {
    for (SensorLimits<double>& one : limits) {
      one.lowest_degC = 0;
      one.highest_degC = 60;
      one.largest_step_K = 1;
      one.stuck_steps = 10;
    }
    guard.reset(3);
  }
  SensorFault check(double a, double b = 20, double c = 20) {
    guard.check({a, b, c}, limits, patience);
    return guard.fault(0);
  }
};

}  // namespace

TEST_CASE("NaN, infinities and readings out of range are rejected and not remembered", "[controller]") {
  Bench bench;
  CHECK(bench.check(20) == SensorFault::none);
  CHECK(bench.check(std::nan("")) == SensorFault::not_finite);
  CHECK(bench.check(HUGE_VAL) == SensorFault::not_finite);
  bench.guard.reset(3);
  bench.check(20);
  CHECK(bench.check(-HUGE_VAL) == SensorFault::not_finite);
  CHECK(bench.check(60.001) == SensorFault::range);
  CHECK(bench.guard.reading_degC(0) == 20);
  bench.guard.reset(3);
  CHECK(bench.check(60) == SensorFault::none);
  bench.guard.reset(3);
  CHECK(bench.check(0) == SensorFault::none);
  bench.guard.reset(3);
  CHECK(bench.check(-1e-9) == SensorFault::range);
}

TEST_CASE("a spike is forgotten at once, a lasting jump is accepted once it is plausible", "[controller]") {
  Bench bench;
  bench.check(20);
  CHECK(bench.check(25) == SensorFault::rate);
  CHECK(bench.check(20.5) == SensorFault::none);
  CHECK(bench.check(24) == SensorFault::rate);  // 3.5 K away: plausible after four steps
  CHECK(bench.check(24) == SensorFault::rate);
  CHECK(bench.check(24) == SensorFault::rate);
  CHECK(bench.guard.lost(0));
  CHECK(bench.check(24) == SensorFault::recovering);
}

TEST_CASE("a sensor is lost after so many bad readings and returns after so many good ones, if it agrees",
          "[controller]") {
  Bench bench;
  bench.check(20);
  bench.check(-5);
  bench.check(-5);
  CHECK_FALSE(bench.guard.lost(0));
  bench.check(-5);
  CHECK(bench.guard.lost(0));
  for (int i = 0; i < 3; ++i) CHECK(bench.check(20.1 + i * .01) == SensorFault::recovering);
  SECTION("a bad one in between starts the count anew") {
    bench.check(-5);
    for (int i = 0; i < 3; ++i) CHECK(bench.check(20.2 + i * .01) == SensorFault::recovering);
    CHECK(bench.check(20.3) == SensorFault::disagrees);
  }
  SECTION("then it waits for the word that it agrees, and is used again") {
    for (int i = 0; i < 3; ++i) CHECK(bench.check(20.3) == SensorFault::disagrees);
    REQUIRE(bench.guard.returning(0));
    bench.guard.trust(0);
    CHECK(bench.guard.fault(0) == SensorFault::none);
    CHECK_FALSE(bench.guard.lost(0));
    CHECK(bench.check(20.3) == SensorFault::none);
  }
}

TEST_CASE("a reading that rests is stuck only when the others moved", "[controller]") {
  Bench bench;
  SECTION("all rest") {
    for (int i = 0; i < 100; ++i) CHECK(bench.check(20) == SensorFault::none);
  }
  SECTION("the others toggle in the last digit") {
    for (int i = 0; i < 100; ++i) CHECK(bench.check(20, 20 + i % 2 * .9, 20) == SensorFault::none);
  }
  SECTION("the others warm up by 2 K on average") {
    for (int i = 0; i <= 20; ++i) {
      INFO(i);
      CHECK(bench.check(20, 20 + .1 * i, 20 + .1 * i) ==
            (i > 0 && .1 * i >= 2 - 1e-9 ? SensorFault::stuck : SensorFault::none));
    }
    CHECK(bench.check(20.1, 22, 22) == SensorFault::none);
  }
  SECTION("the check is off at 0 steps") {
    bench.limits[0].stuck_steps = 0;
    for (int i = 0; i <= 100; ++i) CHECK(bench.check(20, 20 + .1 * i, 20 + .1 * i) == SensorFault::none);
  }
}

TEST_CASE("a reading that rests longer than it ever did is frozen whatever the others do, a single one too",
          "[controller]") {
  Bench bench;
  bench.limits[0].frozen_steps = 50;
  for (int i = 0; i <= 60; ++i) {
    INFO(i);
    CHECK(bench.check(20, 20 + i % 2 * .1, 20) == (i >= 50 ? SensorFault::stuck : SensorFault::none));
  }
  SensorGuard<double, 1> alone;
  alone.reset(1);
  for (int i = 0; i <= 60; ++i) {
    alone.check({20}, {{bench.limits[0]}}, {});
    CHECK(alone.fault(0) == (i >= 50 ? SensorFault::stuck : SensorFault::none));
  }
}

TEST_CASE("when no reading changes at all, all are frozen sooner than each by itself", "[controller]") {
  Bench bench;
  bench.patience.all_frozen_steps = 20;
  for (int i = 0; i <= 30; ++i) {
    INFO(i);
    CHECK(bench.check(20) == (i >= 20 ? SensorFault::stuck : SensorFault::none));
    CHECK(bench.guard.fault(2) == bench.guard.fault(0));
  }
}

TEST_CASE("stale readings are not remembered, and the time they took counts", "[controller]") {
  Bench bench;
  bench.check(20);
  bench.guard.check({30, 30, 30}, bench.limits, bench.patience, 5, true);
  CHECK(bench.guard.fault(0) == SensorFault::stale);
  CHECK(bench.guard.reading_degC(0) == 20);
  CHECK(bench.guard.lost(0));                         // 5 of 3 steps
  CHECK(bench.check(26) == SensorFault::recovering);  // 6 K in 6 steps
}

TEST_CASE("counters stay at their end instead of beginning again", "[controller]") {
  Bench bench;
  bench.check(20);
  for (int i = 0; i < 5; ++i)
    bench.guard.check({std::nan(""), 20, 20}, bench.limits, bench.patience, 4000000000u, false);
  CHECK(bench.guard.lost(0));
  CHECK(bench.check(59) == SensorFault::recovering);
}

TEST_CASE("a sensor that first reports late does not make the others look stuck", "[controller]") {
  Bench bench;
  for (int i = 0; i < 50; ++i) CHECK(bench.check(20, 20, std::nan("")) == SensorFault::none);
  CHECK(bench.check(20, 20, 50) == SensorFault::none);
  CHECK(bench.check(20, 20, 50) == SensorFault::none);
}
