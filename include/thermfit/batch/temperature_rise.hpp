#pragma once

#include "thermfit/batch/batch.hpp"

namespace thermfit {

/// What a model's temperatures are measured from. Rise is the paper's reading and the default.
enum class TemperatureReference {
  rise,     ///< since the first sample of the batch, K
  absolute  ///< as measured, degC
};

/// Temperatures as a model sees them, rows x points: `T(t) - T(first row)` in K for rise, degC for absolute.
/// A batch without rows gives an empty matrix. Allocates the result.
inline Matrix model_temperatures(const Batch& batch, TemperatureReference reference) {
  const Matrix& values = batch.temperatures.values;
  if (reference == TemperatureReference::absolute || values.rows() == 0) return values;
  return values.rowwise() - values.row(0);
}

}  // namespace thermfit
