#include "thermfit/controller/sensor_guard.hpp"

#include <cmath>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

struct Bench {
  SensorGuard<double, 3> guard;
  std::array<SensorLimits<double>, 3> limits{{{0, 60, 1, 10}, {0, 60, 1, 10}, {0, 60, 1, 10}}};
  GuardPatience<double> patience{3, 4, 2};

  Bench() { guard.reset(3); }
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

TEST_CASE("a sensor is lost after so many bad readings and trusted after so many good ones", "[controller]") {
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
    CHECK(bench.check(20.3) == SensorFault::none);
  }
  SECTION("then it is used again") {
    CHECK(bench.check(20.3) == SensorFault::none);
    CHECK_FALSE(bench.guard.lost(0));
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

TEST_CASE("a single sensor has no others and is never stuck", "[controller]") {
  SensorGuard<double, 1> guard;
  guard.reset(1);
  for (int i = 0; i < 100; ++i) guard.check({20}, {{{0, 60, 1, 10}}}, {});
  CHECK(guard.fault(0) == SensorFault::none);
}

TEST_CASE("a sensor that first reports late does not make the others look stuck", "[controller]") {
  Bench bench;
  for (int i = 0; i < 50; ++i) CHECK(bench.check(20, 20, std::nan("")) == SensorFault::none);
  CHECK(bench.check(20, 20, 50) == SensorFault::none);
  CHECK(bench.check(20, 20, 50) == SensorFault::none);
}
