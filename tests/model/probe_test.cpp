#include "thermfit/model/probe.hpp"

#include "support/catch.hpp"
#include "thermfit/model/held_correction.hpp"

using namespace thermfit;

TEST_CASE("what the model misses is held from a reading to the next", "[model]") {
  const ProbeLimits<> limits;
  HeldCorrection<> held;
  CHECK(held.value(0, limits) == 0);
  CHECK(held.take(12, 10, 60, limits) == ProbeReading::taken);
  CHECK(held.value(1e9, limits) == 2);
  CHECK(held.take(7, 10, 120, limits) == ProbeReading::taken);
  CHECK(held.value(121, limits) == -3);
}

TEST_CASE("a reading that is no number, too large or too old does not count", "[model]") {
  ProbeLimits<> limits;
  limits.largest_um = 20;
  limits.longest_s = 600;
  HeldCorrection<> held;
  CHECK(held.take(5, 0, 0, limits) == ProbeReading::taken);
  CHECK(held.take(std::nan(""), 0, 10, limits) == ProbeReading::no_number);
  CHECK(held.take(HUGE_VAL, 0, 10, limits) == ProbeReading::no_number);
  CHECK(held.take(21, 0, 10, limits) == ProbeReading::too_large);
  CHECK(held.value(600, limits) == 5);
  CHECK(held.value(601, limits) == 0);
}

TEST_CASE("a reading far off the last is taken only when the next agrees", "[model]") {
  ProbeLimits<> limits;
  limits.jump_um = 4;
  HeldCorrection<> held;
  CHECK(held.take(3, 0, 0, limits) == ProbeReading::taken);
  CHECK(held.take(30, 0, 1, limits) == ProbeReading::to_be_repeated);
  CHECK(held.value(1, limits) == 3);
  CHECK(held.take(2, 0, 2, limits) == ProbeReading::taken);  // it was an outlier
  CHECK(held.take(30, 0, 3, limits) == ProbeReading::to_be_repeated);
  CHECK(held.take(28, 0, 4, limits) == ProbeReading::taken);  // it was none
  CHECK(held.value(4, limits) == 28);
}

TEST_CASE("a drift that a model lacks is halved by a reading in the middle", "[model]") {
  Batch batch;
  batch.time_s = Vector::LinSpaced(101, 0, 6000);
  BatchPrediction prediction;
  prediction.errors = Matrix::Zero(101, 1);
  prediction.residuals = -Vector::LinSpaced(101, 0, 10);
  prediction.S_um = Vector::Constant(1, 5.8);
  const Vector any = Vector::Constant(1, HUGE_VAL);
  const ProbedPrediction one = hold_readings(prediction, batch, {50}, {}, any);
  CHECK(one.taken == 1);
  CHECK(one.prediction.residuals(50, 0) == Approx(-5));  // known only from then on
  CHECK(one.prediction.residuals(51, 0) == Approx(-.1));
  CHECK(one.prediction.residuals(100, 0) == Approx(-5));
  CHECK(one.prediction.errors(100, 0) == Approx(5));
  CHECK(one.prediction.S_um(0) == Approx(prediction.S_um(0) / 2).epsilon(.02));
  CHECK(hold_readings(prediction, batch, {50}, {}, Vector::Constant(1, 1)).refused == 1);
  CHECK(hold_readings(prediction, batch, {}, {}, any).prediction.S_um(0) == Approx(prediction.S_um(0)).epsilon(.01));
  prediction.residuals.resize(101, 0);
  CHECK_THROWS_WITH(hold_readings(prediction, batch, {50}, {}, any), Catch::Contains("no measured error"));
}
