#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit::detail {

/// A time at which the state is needed, and what it is needed for.
struct GridPoint {
  double time_s = 0;
  Index sample = 0;              ///< the sample whose inputs are held from here on
  std::vector<Index> readings;   ///< samples whose readings are taken here (at most one)
  std::vector<Index> positions;  ///< samples whose displacements are taken here
};

/// The times of a batch whose displacements were logged `delay_s` late: the sample at t shows the machine at
/// t - delay_s, before the first sample the machine at its start. Times closer than a microsecond are one.
template <typename Scalar = double>
std::vector<GridPoint> time_grid(const Vector& time_s, double delay_s) {
  const Index samples = time_s.size();
  std::vector<GridPoint> grid(static_cast<std::size_t>(samples));
  for (Index k = 0; k < samples; ++k) {
    GridPoint& point = grid[static_cast<std::size_t>(k)];
    point.time_s = time_s(k);
    point.sample = k;
    point.readings = {k};
    if (delay_s == 0) point.positions = {k};
  }
  if (delay_s == 0) return grid;
  for (Index k = 0; k < samples; ++k) {
    GridPoint point;
    point.time_s = std::max(time_s(k) - delay_s, time_s(0));
    const double* begin = time_s.data();
    point.sample = std::upper_bound(begin, begin + samples, point.time_s + 1e-6) - begin - 1;
    point.positions = {k};
    grid.push_back(std::move(point));
  }
  std::stable_sort(grid.begin(), grid.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s - 1e-6; });
  std::vector<GridPoint> merged;
  for (GridPoint& point : grid) {
    if (merged.empty() || point.time_s > merged.back().time_s + 1e-6) {
      merged.push_back(std::move(point));
      continue;
    }
    GridPoint& last = merged.back();
    last.sample = std::max(last.sample, point.sample);
    last.readings.insert(last.readings.end(), point.readings.begin(), point.readings.end());
    last.positions.insert(last.positions.end(), point.positions.begin(), point.positions.end());
  }
  return merged;
}

}  // namespace thermfit::detail
