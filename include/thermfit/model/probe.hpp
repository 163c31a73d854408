#pragma once

#include <cmath>
#include <vector>

#include "thermfit/model/held_correction.hpp"
#include "thermfit/model/predict.hpp"

namespace thermfit {

/// A prediction corrected by a probe now and then.
struct ProbedPrediction {
  BatchPrediction prediction;  ///< corrected: errors, residuals and S
  Index taken = 0;             ///< readings that became the correction of an error
  Index refused = 0;           ///< those that did not
};

/// `prediction` of `batch` with its measured errors taken in the rows `readings` (increasing, from 0), each held from
/// the next row on until the next reading. `jump_um` (per error) as ProbeLimits::jump_um; rows are seconds where the
/// batch has no clock. Residuals must be there: Error otherwise. Allocates the result.
template <typename Scalar = double>
ProbedPrediction hold_readings(BatchPrediction prediction, const Batch& batch, const std::vector<Index>& readings,
                               const ProbeLimits<>& limits, const Vector& jump_um) {
  if (prediction.residuals.cols() == 0)
    throw Error(batch.source.empty() ? batch.name : batch.source, "no measured error to take as a probe's reading");
  ProbedPrediction result{std::move(prediction), 0, 0};
  Matrix& errors = result.prediction.errors;
  Matrix& residuals = result.prediction.residuals;
  for (Index e = 0; e < errors.cols(); ++e) {
    ProbeLimits<> own = limits;
    own.jump_um = jump_um(e);
    HeldCorrection<> held;
    std::size_t next = 0;
    double squares = 0, count = 0;
    for (Index row = 0; row < errors.rows(); ++row) {
      const double now_s = batch.has_time() ? batch.time_s(row) : static_cast<double>(row);
      const double predicted = errors(row, e), measured = predicted - residuals(row, e);
      const double correction = held.value(now_s, own);
      errors(row, e) += correction;
      residuals(row, e) += correction;
      if (std::isfinite(residuals(row, e))) squares += residuals(row, e) * residuals(row, e), ++count;
      if (next == readings.size() || readings[next] != row) continue;
      ++next;
      const bool taken = held.take(measured, predicted, now_s, own) == ProbeReading::taken;
      ++(taken ? result.taken : result.refused);
    }
    result.prediction.S_um(e) = std::sqrt(squares / (count - 1));
  }
  return result;
}

}  // namespace thermfit
