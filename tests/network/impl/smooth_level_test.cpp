#include "thermfit/network/impl/smooth_level.hpp"

#include <cmath>
#include <random>

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("smoothing takes most of the noise off a slow reading") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.05);
  Vector room(200), read(200);
  for (Index k = 0; k < 200; ++k) {
    room(k) = 20 + std::sin(static_cast<double>(k) / 40);
    read(k) = room(k) + noise(random);
  }
  const double before = (read - room).norm();
  smooth_level(read);
  CHECK((read - room).norm() < 0.7 * before);
}

TEST_CASE("smoothing leaves readings without noise as they are") {
  Vector ramp = Vector::LinSpaced(50, 18, 25), still = Vector::Constant(50, 21.0), few = Vector::LinSpaced(5, 0, 1);
  for (const Vector& one : {ramp, still, few}) {
    Vector smoothed = one;
    smooth_level(smoothed);
    CHECK((smoothed - one).cwiseAbs().maxCoeff() == 0);
  }
}
