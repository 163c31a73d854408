#include "thermfit/network/impl/phi.hpp"

#include <initializer_list>

#include "support/catch.hpp"

using thermfit::detail::Phi;
using thermfit::detail::PhiDifference;

namespace {

/// phi_k(z), k >= 1, by 40-point composite Gauss quadrature of its integral, in extended precision.
long double phi_by_quadrature(int k, long double z, bool derivative = false) {
  const long double at[] = {-0.7745966692414833770L, 0.0L, 0.7745966692414833770L};
  const long double weight[] = {5.0L / 9, 8.0L / 9, 5.0L / 9};
  const int panels = 4000;
  long double factorial = 1, sum = 0;
  for (int i = 2; i < k; ++i) factorial *= i;
  for (int p = 0; p < panels; ++p)
    for (int i = 0; i < 3; ++i) {
      const long double t = (p + 0.5L + 0.5L * at[i]) / panels;
      sum += weight[i] / 2 / panels * std::exp(t * z) * std::pow(1 - t, static_cast<long double>(k - 1)) / factorial *
             (derivative ? t : 1);
    }
  return sum;
}

}  // namespace

TEST_CASE("phi functions equal their integrals from stiff to vanishing rates", "[network]") {
  for (const double z : {-300.0, -30.0, -2.0, -1.0, -0.999, -0.3, -1e-3, -1e-9, 0.0, 0.7}) {
    const Phi phi(z);
    INFO("z = " << z);
    CHECK(phi.phi0 == std::exp(z));
    CHECK(phi.phi1 == Approx(static_cast<double>(phi_by_quadrature(1, z))).epsilon(1e-12));
    CHECK(phi.phi2 == Approx(static_cast<double>(phi_by_quadrature(2, z))).epsilon(1e-12));
    CHECK(phi.phi3 == Approx(static_cast<double>(phi_by_quadrature(3, z))).epsilon(1e-12));
  }
}

TEST_CASE("divided differences hold from equal to far apart arguments", "[network]") {
  for (const double a : {-40.0, -3.0, -0.4, -1e-6, 0.0})
    for (const double gap : {0.0, 1e-12, 1e-6, 1e-3, 0.3, 0.49999, 0.5, 2.0, 60.0}) {
      const double b = a - gap;
      const PhiDifference d(a, b, Phi(a), Phi(b));
      const PhiDifference swapped(b, a, Phi(b), Phi(a));
      INFO("a = " << a << ", gap = " << gap);
      const auto expected = [&](int k) {
        if (gap < 1e-4) return static_cast<double>(phi_by_quadrature(k, 0.5L * (a + b), true));
        return static_cast<double>((phi_by_quadrature(k, a) - phi_by_quadrature(k, b)) /
                                   (static_cast<long double>(a) - b));
      };
      CHECK(d.phi1 == Approx(expected(1)).epsilon(1e-9));
      CHECK(d.phi2 == Approx(expected(2)).epsilon(1e-9));
      const double sinhc = gap == 0 ? 1 : std::sinh(gap / 2) / (gap / 2);
      CHECK(d.phi0 == Approx(std::exp((a + b) / 2) * sinhc).epsilon(1e-11));
      CHECK(swapped.phi2 == Approx(d.phi2).epsilon(1e-12));
    }
}
