#include "thermfit/statistics/quantiles.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {
/// Published tables give four to six digits; the closed forms below give all.
bool close(double a, double b, double relative) { return std::abs(a - b) <= relative * std::abs(b); }
}  // namespace

TEST_CASE("quantiles agree with published tables", "[model]") {
  CHECK(close(normal_quantile(.975), 1.959963984540054, 1e-13));
  CHECK(close(normal_quantile(.99), 2.326347874040841, 1e-13));
  CHECK(close(normal_quantile(.001), -3.090232306167813, 1e-12));
  CHECK(close(t_quantile(.975, 10), 2.2281388519649385, 1e-10));
  CHECK(close(t_quantile(.005, 3), -5.840909309, 1e-9));
  CHECK(close(t_quantile(.95, 120), 1.6577, 5e-5));
  CHECK(close(chi2_quantile(.99, 1), 6.634896601021213, 1e-12));
  CHECK(close(chi2_quantile(.95, 10), 18.307038053275146, 1e-12));
  CHECK(close(chi2_quantile(.999, 100), 149.4493, 1e-6));
  CHECK(close(f_quantile(.95, 5, 10), 3.3258, 2e-5));
  CHECK(close(f_quantile(.99, 10, 20), 3.3682, 2e-5));
  CHECK(close(f_quantile(.99, 3, 1), 5403.352, 1e-6));
}

TEST_CASE("quantiles agree with closed forms", "[model]") {
  for (const double p : {1e-6, .01, .3, .5, .9, .99, .999999}) {
    CAPTURE(p);
    CHECK(close(chi2_quantile(p, 2), -2 * std::log1p(-p), 1e-11));  // exponential
    CHECK(close(f_quantile(p, 2, 8), 4 * (std::pow(1 - p, -1 / 4.0) - 1), 1e-9));
    if (p != .5) CHECK(close(t_quantile(p, 1), std::tan(std::acos(-1.0) * (p - .5)), 1e-9));  // Cauchy
    const double u = 2 * p - 1;
    if (p != .5) CHECK(close(t_quantile(p, 2), u * std::sqrt(2 / (1 - u * u)), 1e-9));
  }
  CHECK(t_quantile(.5, 7) == 0);
  CHECK(normal_quantile(.5) == 0);
}

TEST_CASE("relations between the distributions hold", "[model]") {
  CHECK(close(f_quantile(.99, 4, 1e7), chi2_quantile(.99, 4) / 4, 1e-6));
  CHECK(close(f_quantile(.05, 3, 12), 1 / f_quantile(.95, 12, 3), 1e-10));
  CHECK(close(t_two_sided(t_quantile(.975, 11), 11), .05, 1e-10));
  CHECK(t_two_sided(0, 5) == Approx(1));
}

TEST_CASE("an impossible probability or number of degrees is an Error", "[model]") {
  CHECK_THROWS_AS(normal_quantile(0), Error);
  CHECK_THROWS_AS(chi2_quantile(1, 3), Error);
  CHECK_THROWS_AS(t_quantile(std::nan(""), 3), Error);
  CHECK_THROWS_AS(f_quantile(.5, 0, 3), Error);
  CHECK_THROWS_AS(f_quantile(.5, 2, -1), Error);
}
