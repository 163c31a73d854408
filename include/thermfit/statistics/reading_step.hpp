#pragma once

/// The step in which readings come: noise that repeats hide and that second differences do not see.

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/statistics/residual_noise.hpp"

namespace thermfit {

/// Step of the grid on which the values of `series` lie: the first decile of the distances between neighbouring
/// distinct values, so that a few roundings of the log do not count. Next to nothing where the values are continuous; 0
/// where fewer than three differ.
inline double step_of(const Vector& series) {
  std::vector<double> values;
  for (Index k = 0; k < series.size(); ++k)
    if (std::isfinite(series(k))) values.push_back(series(k));
  std::sort(values.begin(), values.end());
  std::vector<double> distances;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (const double d = values[k] - values[k - 1]; d > 1e-12 * std::abs(values[k])) distances.push_back(d);
  if (distances.size() < 2) return 0;
  const auto decile = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 10);
  std::nth_element(distances.begin(), decile, distances.end());
  return *decile;
}

/// Standard deviation that rounding to steps of q adds to a channel, q / sqrt(12), over all batches.
inline double resolution_sd(const SeriesByBatch& measured) {
  double squares = 0, count = 0;
  for (const Vector& series : measured) {
    const double step = step_of(series), samples = static_cast<double>(series.size());
    squares += samples * step * step / 12;
    count += samples;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

}  // namespace thermfit
