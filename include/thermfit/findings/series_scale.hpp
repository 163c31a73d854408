#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/statistics/white_noise.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Median of `values`, the mean of the middle two for an even count; NaN of none. Takes a copy to sort.
inline double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

/// The readings of a channel that there are, and the rows they are from.
struct Series {
  std::vector<double> values;  ///< in the order of the rows, finite
  std::vector<Index> rows;     ///< row of the batch that each value is from, increasing

  /// Leaves out what is not finite. Allocates.
  explicit Series(const Eigen::Ref<const Vector>& column) {
    for (Index row = 0; row < column.size(); ++row)
      if (std::isfinite(column(row))) {
        values.push_back(column(row));
        rows.push_back(row);
      }
  }
  /// How many readings there are.
  std::size_t size() const { return values.size(); }
};

/// How finely a channel is written down and how much it shakes.
struct SeriesScale {
  double lowest = 0;      ///< smallest value
  double highest = 0;     ///< largest value
  double resolution = 0;  ///< smallest difference between two of its values; 0 for a constant channel
  double noise = 0;       ///< standard deviation, by white_noise(): blind to drift, steps and bad readings

  /// From the smallest to the largest value.
  double range() const { return highest - lowest; }
  /// The larger of the noise and what rounding alone does.
  double shake() const { return std::max(noise, resolution / std::sqrt(12.0)); }
};

/// Scale of a series. Without readings everything is 0. Allocates.
inline SeriesScale series_scale(const Series& series) {
  SeriesScale scale;
  if (series.size() == 0) return scale;
  std::vector<double> sorted = series.values;
  std::sort(sorted.begin(), sorted.end());
  scale.lowest = sorted.front();
  scale.highest = sorted.back();
  const double rounding = 1e-9 * std::max({scale.range(), std::abs(scale.lowest), std::abs(scale.highest)});
  double smallest = scale.range();
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] - sorted[i - 1] > rounding) smallest = std::min(smallest, sorted[i] - sorted[i - 1]);
  scale.resolution = smallest;
  const std::vector<std::vector<double>> one{series.values};
  scale.noise = white_noise(one);
  // One reading in two, three or five wrong is in most second differences, but not in those over two or three rows, and
  // not in the smallest.
  if (scale.noise > scale.resolution)
    for (const double other : {white_noise(one, 2), white_noise(one, 3), white_noise(one, 1, true)})
      if (other < scale.noise / 2 && other > scale.resolution / 2) scale.noise = other;
  return scale;
}

}  // namespace thermfit
