#include "thermfit/statistics/white_noise.hpp"

#include <cmath>
#include <random>

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("the high-frequency floor sees the noise and neither a slow signal nor rare jumps") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 0.25);
  Vector series(2000);
  for (Index k = 0; k < series.size(); ++k) {
    const double t = static_cast<double>(k);
    series(k) = normal(random) + 30 * std::sin(t / 300) + (k > 1000 ? 15 : 0);
  }
  CHECK(white_noise({series}) == Approx(0.25).epsilon(0.08));
  CHECK(white_noise({}) == 0);
}
