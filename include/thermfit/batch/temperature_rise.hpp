#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/error.hpp"

namespace thermfit {

/// What a model's temperatures are measured from. Rise is the paper's reading and the default.
enum class TemperatureReference {
  rise,     ///< since the first sample of the batch, K
  absolute  ///< as measured, degC
};

/// Points that have no reading in a first row that was left out, so that no rise of theirs is known. Allocates.
inline std::vector<std::string> lacks_first_reading(const Batch& batch) {
  std::vector<std::string> points;
  for (Index p = 0; p < batch.first_degC.size(); ++p)
    if (!std::isfinite(batch.first_degC(p))) points.push_back(batch.temperatures.names[static_cast<std::size_t>(p)]);
  return points;
}

/// The same batch, its rises counted from the first row that is there. Allocates a copy.
inline Batch from_first_row_there(Batch batch) {
  batch.first_degC.resize(0);
  return batch;
}

/// Throws Error when one of `points` has no reading in the first row, which its rises count from.
inline void require_first_readings(const Batch& batch, const std::vector<std::string>& points) {
  for (const std::string& lacking : lacks_first_reading(batch))
    if (std::find(points.begin(), points.end(), lacking) != points.end())
      throw Error(
          batch.source.empty() ? batch.name : batch.source,
          lacking + " has no reading in the first row, from which its rise counts; the first row with all is " +
              std::to_string(batch.number_of(0)),
          "a reading in the first row",
          "leave that point out (CsvOptions::temperatures), delete the rows above, or let the errors count from "
          "the same row (TrainingPlan::error_reference = start)");
}

/// Temperatures as a model sees them, rows x points: `T(t) - T(first row)` in K for rise, degC for absolute. Taken off
/// in double, then rounded to Scalar; NaN for points of lacks_first_reading(). A batch without rows gives an empty
/// matrix. Allocates the result.
template <typename Scalar = double>
MatrixX<Scalar> model_temperatures(const Batch& batch, TemperatureReference reference) {
  const auto& values = detail::lazy<Scalar>(batch.temperatures.values);
  if (reference == TemperatureReference::absolute || values.rows() == 0) return values.template cast<Scalar>();
  if (batch.first_degC.size() == 0) return (values.rowwise() - values.row(0)).template cast<Scalar>();
  const auto& first = detail::lazy<Scalar>(batch.first_degC);
  return (values.rowwise() - first.transpose()).template cast<Scalar>();
}

}  // namespace thermfit
