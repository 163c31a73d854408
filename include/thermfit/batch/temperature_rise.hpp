#pragma once

#include "thermfit/batch/batch.hpp"

namespace thermfit {

/// What a model's temperatures are measured from. Rise is the paper's reading and the default.
enum class TemperatureReference {
  rise,     ///< since the first sample of the batch, K
  absolute  ///< as measured, degC
};

/// Temperatures as a model sees them, rows x points: `T(t) - T(first row)` in K for rise, degC for absolute. Taken off
/// in double, then rounded to Scalar. A batch without rows gives an empty matrix. Allocates the result.
template <typename Scalar = double>
MatrixX<Scalar> model_temperatures(const Batch& batch, TemperatureReference reference) {
  const auto& values = detail::lazy<Scalar>(batch.temperatures.values);
  if (reference == TemperatureReference::absolute || values.rows() == 0) return values.template cast<Scalar>();
  return (values.rowwise() - values.row(0)).template cast<Scalar>();
}

}  // namespace thermfit
