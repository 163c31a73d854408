#pragma once

#include <cmath>
#include <initializer_list>

namespace thermfit::detail {

/// phi_k(z) = integral over t in 0…1 of exp(t z) (1-t)^(k-1)/(k-1)!, phi_0 = exp: the weights of exponential
/// integrators (Hochbruck & Ostermann 2010, eq. 2.10). Accurate to a few units in the last place for all z.
struct Phi {
  double phi0, phi1, phi2, phi3;

  explicit Phi(double z) : phi0(std::exp(z)) {
    if (std::abs(z) < 1) {
      // Upwards from the series of phi_3, where the recursion downwards would cancel.
      double term = 1.0 / 6, sum = 0;
      for (int k = 4; k < 22; ++k) {
        sum += term;
        term *= z / k;
      }
      phi3 = sum;
      phi2 = 0.5 + z * phi3;
      phi1 = 1 + z * phi2;
    } else {
      phi1 = std::expm1(z) / z;
      phi2 = (phi1 - 1) / z;
      phi3 = (phi2 - 0.5) / z;
    }
  }
};

/// First divided differences phi_k[a, b] = (phi_k(a) - phi_k(b)) / (a - b), also where a and b are close or equal.
struct PhiDifference {
  double phi0, phi1, phi2;

  PhiDifference(double a, double b, const Phi& at_a, const Phi& at_b) : phi0(0), phi1(0), phi2(0) {
    if (std::abs(a - b) >= 0.5) {
      phi0 = (at_a.phi0 - at_b.phi0) / (a - b);
      phi1 = (at_a.phi1 - at_b.phi1) / (a - b);
      phi2 = (at_a.phi2 - at_b.phi2) / (a - b);
      return;
    }
    // The mean of the derivative phi_k' = phi_k - k phi_(k+1) between b and a, by Gauss-Legendre with four points.
    constexpr double place[] = {0.3399810435848562648, 0.8611363115940525752};
    constexpr double weight[] = {0.3260725774312730713, 0.1739274225687269287};
    for (int i = 0; i < 2; ++i)
      for (const double side : {-1.0, 1.0}) {
        const Phi at(0.5 * (a + b) + side * place[i] * 0.5 * (a - b));
        phi0 += weight[i] * at.phi0;
        phi1 += weight[i] * (at.phi1 - at.phi2);
        phi2 += weight[i] * (at.phi2 - 2 * at.phi3);
      }
  }
};

}  // namespace thermfit::detail
