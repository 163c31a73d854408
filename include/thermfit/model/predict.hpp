#pragma once

#include <vector>

#include "thermfit/error.hpp"
#include "thermfit/model/outside_domain.hpp"
#include "thermfit/model/trained_model.hpp"

namespace thermfit {

/// What a model says of one batch.
struct BatchPrediction {
  Matrix errors;                            ///< rows x errors, um
  Matrix residuals;                         ///< prediction minus measurement, um; no columns where not measured
  Vector S_um;                              ///< eq. (10) per error; empty where not measured
  std::vector<DomainDistance<>> distances;  ///< per row

  /// Share of rows beyond the 95 % or 99 % limit of `domain`, 0 … 1.
  double share_beyond(const TrainingDomain<>& domain, int percent) const {
    double count = 0;
    for (const DomainDistance<>& distance : distances) count += outside_limits(domain, distance, percent).any();
    return distances.empty() ? 0 : count / static_cast<double>(distances.size());
  }
};

/// Temperatures of `batch` as `model` wants them: its points, in its order, as rise or absolute. Throws Error on a
/// point the batch lacks, naming those there are.
inline Matrix model_inputs(const TrainedModel& model, const Batch& batch) {
  const Matrix all = model_temperatures(batch, model.reference);
  Matrix chosen(all.rows(), static_cast<Index>(model.temperatures.size()));
  for (std::size_t i = 0; i < model.temperatures.size(); ++i) {
    const Index column = batch.temperatures.find(model.temperatures[i]);
    if (column < 0) {
      std::string there;
      for (const std::string& name : batch.temperatures.names) there += (there.empty() ? "" : ", ") + name;
      throw Error(batch.source.empty() ? batch.name : batch.source,
                  "no temperature point '" + model.temperatures[i] + "', which the model needs", there);
    }
    chosen.col(static_cast<Index>(i)) = all.col(column);
  }
  return chosen;
}

/// Prediction, residuals where the batch holds all of the model's errors, and distances to the training domain.
/// Errors as model_inputs. Allocates the result.
inline BatchPrediction predict(const TrainedModel& model, const Batch& batch) {
  const Matrix inputs = model_inputs(model, batch);
  BatchPrediction result;
  result.errors = model.model.predict_rows(inputs);
  for (Index i = 0; i < inputs.rows(); ++i)
    result.distances.push_back(model.domain.distance(inputs.row(i).transpose()));
  Matrix measured(inputs.rows(), static_cast<Index>(model.errors.size()));
  for (std::size_t e = 0; e < model.errors.size(); ++e) {
    const Index column = batch.errors.find(model.errors[e]);
    if (column < 0) return result;
    measured.col(static_cast<Index>(e)) = batch.errors.values.col(column);
  }
  result.residuals = result.errors - measured;
  result.S_um = (result.residuals.colwise().squaredNorm() / static_cast<double>(inputs.rows() - 1)).cwiseSqrt();
  return result;
}

}  // namespace thermfit
