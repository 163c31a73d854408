#pragma once

/// Is a residual noise? The cumulated periodogram (Bartlett; Bacher & Madsen 2011).

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/constants.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Outcome of the test.
struct Whiteness {
  bool white = true;    ///< the cumulated periodogram stays inside its 5 % band
  double excess = 0;    ///< largest distance of the cumulated periodogram from the straight line
  double band = 0;      ///< the 5 % band: 1.358 / (sqrt(m) + 0.12 + 0.11 / sqrt(m)), m ordinates
  Index ordinates = 0;  ///< fewer than 8 say nothing, and `white` is then true
};

/// Tests evenly spaced series (one a batch, means removed here) together: their periodograms, each scaled to mean one,
/// are pooled over frequency. Constant series are left out. Allocates.
template <typename Scalar = double>
Whiteness whiteness(const std::vector<Vector>& series) {
  std::vector<std::pair<double, double>> pooled;  // frequency, ordinate
  for (const VectorX<Scalar>& values : series) {
    const Index count = values.size(), half = (count - 1) / 2;
    const VectorX<Scalar> centred = values.array() - (count ? values.mean() : 0.);
    if (half < 2 || centred.squaredNorm() < 1e-24) continue;
    std::vector<double> ordinates;
    double sum = 0;
    for (Index k = 1; k <= half; ++k) {
      double re = 0, im = 0;
      for (Index i = 0; i < count; ++i) {
        const double angle = 2 * pi * static_cast<double>((i * k) % count) / static_cast<double>(count);
        re += centred(i) * std::cos(angle);
        im += centred(i) * std::sin(angle);
      }
      ordinates.push_back(re * re + im * im);
      sum += ordinates.back();
    }
    for (Index k = 1; k <= half; ++k)
      pooled.emplace_back(static_cast<double>(k) / static_cast<double>(count),
                          ordinates[static_cast<std::size_t>(k - 1)] * static_cast<double>(half) / sum);
  }
  Whiteness result;
  result.ordinates = static_cast<Index>(pooled.size());
  if (pooled.size() < 8) return result;
  std::sort(pooled.begin(), pooled.end());
  double total = 0, cumulated = 0;
  for (const auto& [frequency, ordinate] : pooled) total += ordinate;
  for (std::size_t m = 0; m < pooled.size(); ++m) {
    cumulated += pooled[m].second / total;
    result.excess =
        std::max(result.excess, std::abs(cumulated - static_cast<double>(m + 1) / static_cast<double>(pooled.size())));
  }
  const double root = std::sqrt(static_cast<double>(pooled.size()));
  result.band = 1.358 / (root + .12 + .11 / root);
  result.white = result.excess <= result.band;
  return result;
}

THERMFIT_COMPILED_TEMPLATE(Whiteness whiteness<double>(const std::vector<Vector>&));

}  // namespace thermfit
