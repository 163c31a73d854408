#pragma once

#include <algorithm>

#include "thermfit/lazy.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Takes the white noise off a slow reading, in place: an effect that follows the room must not follow its thermometer.
///
/// Random walk plus noise, x_k = x_{k-1} + w_k, y_k = x_k + v_k. Steps d_k = y_k - y_{k-1} have cov(d_k, d_{k+1}) = -r
/// and var(d) = q + 2 r, which gives both variances without a knob; then the Kalman filter and the smoother of Rauch,
/// Tung and Striebel (1965). A reading whose steps do not alternate has no noise to take off and stays as it is.
template <typename Scalar = double>
void smooth_level(Lazy<VectorX<Scalar>>& y) {
  const Index n = y.size();
  if (n < 8) return;
  const VectorX<Scalar> steps = y.tail(n - 1) - y.head(n - 1);
  const double r = -steps.tail(n - 2).dot(steps.head(n - 2)) / static_cast<double>(n - 2);
  if (r <= 0) return;
  const double q = std::max(steps.squaredNorm() / static_cast<double>(n - 1) - 2 * r, 1e-4 * r);
  VectorX<Scalar> filtered(n), variance(n);
  filtered(0) = y(0);
  variance(0) = r;
  for (Index k = 1; k < n; ++k) {
    const double before = variance(k - 1) + q, gain = before / (before + r);
    filtered(k) = filtered(k - 1) + gain * (y(k) - filtered(k - 1));
    variance(k) = (1 - gain) * before;
  }
  y(n - 1) = filtered(n - 1);
  for (Index k = n - 2; k >= 0; --k) y(k) = filtered(k) + variance(k) / (variance(k) + q) * (y(k + 1) - filtered(k));
}

}  // namespace thermfit
