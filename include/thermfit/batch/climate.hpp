#pragma once

#include <vector>

#include "thermfit/batch/batch.hpp"

namespace thermfit {

/// The climate of a batch: mean of its temperatures `points` where its rises count from, degC; 0 without rows or
/// points. Does not allocate.
inline double climate_degC(const Batch& batch, const std::vector<Index>& points) {
  if (batch.temperatures.values.rows() == 0 || points.empty()) return 0;
  double sum = 0;
  for (const Index point : points)
    sum += batch.first_degC.size() > 0 ? batch.first_degC(point) : batch.temperatures.values(0, point);
  return sum / static_cast<double>(points.size());
}

}  // namespace thermfit
