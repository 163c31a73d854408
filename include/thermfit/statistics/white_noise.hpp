#pragma once

/// White noise of slowly varying series, from second differences.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit {

/// Median absolute value of a standard normal variable: quantile .75.
constexpr double normal_median = 0.6745;
/// Its lower quartile.
constexpr double normal_quarter = 0.3186;

/// Standard deviation of what changes from sample to sample in all of `batches` together, in their unit; 0 where no
/// three neighbouring samples are known.
///
/// A slow signal cancels in r_{k-1} - 2 r_k + r_{k+1}, whose variance is 6 times that of white noise. The median of
/// absolute differences, `normal_median` of the standard deviation, so that rare jumps do not count as noise. Missing
/// samples (NaN) are left out. A series is anything with size() and []: a Vector, a std::vector. Neighbours are `lag`
/// samples apart; by the lower `quarter` of the differences instead of the median where more than half may be no noise.
/// Allocates.
template <class Series = Vector>
double white_noise(const std::vector<Series>& batches, int lag = 1, bool quarter = false) {
  std::vector<double> differences;
  for (const Series& r : batches)
    for (auto by = static_cast<decltype(r.size())>(lag), k = by; k + by < r.size(); ++k) {
      const double d = r[k - by] - 2 * r[k] + r[k + by];
      if (!std::isnan(d)) differences.push_back(std::abs(d));
    }
  if (differences.empty()) return 0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / (quarter ? 4 : 2));
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle / (quarter ? normal_quarter : normal_median) / std::sqrt(6.0);
}

}  // namespace thermfit
