#include "thermfit/statistics/reading_step.hpp"

#include <random>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

/// A slow course with noise of `sd`, rounded to steps of `step` (0: not at all).
Vector readings(double step, double sd, Index samples = 900) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Vector series(samples);
  for (Index k = 0; k < samples; ++k) {
    const double value = 20 + 30 * (1 - std::exp(-static_cast<double>(k) / 200)) + sd * normal(random);
    series(k) = step > 0 ? step * std::round(value / step) : value;
  }
  return series;
}

}  // namespace

TEST_CASE("the step of readings is found, also where the log rounds it and where they jump by several steps") {
  CHECK(step_of(readings(0.3223, 0.05)) == Approx(0.3223));
  const Vector logged = (100 * readings(0.3223, 0.05)).array().round() / 100;
  CHECK(step_of(logged) == Approx(0.32).margin(0.011));
  CHECK(step_of(readings(0.1, 0.3, 121)) == Approx(0.1));
}

TEST_CASE("continuous, constant and missing readings have next to no step") {
  CHECK(step_of(readings(0, 0.05)) < 0.005);
  CHECK(step_of(Vector::Constant(50, 21.5)) == 0);
  CHECK(step_of(Vector::Constant(50, std::nan(""))) == 0);
}

TEST_CASE("rounding adds step / sqrt(12), weighed by samples where batches differ") {
  CHECK(resolution_sd({readings(0.3223, 0.05)}) == Approx(0.3223 / std::sqrt(12.)));
  const double both = std::sqrt((0.3223 * 0.3223 + 0.1 * 0.1) / 24);
  CHECK(resolution_sd({readings(0.3223, 0.05), readings(0.1, 0.05)}) == Approx(both));
  CHECK(resolution_sd({}) == 0);
}
