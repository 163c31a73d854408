#pragma once

#include <string>
#include <vector>

#include "thermfit/compiled.hpp"
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

/// Temperatures of `batch` as `model` wants them: its points, in its order, as rise or absolute; rows x points. Throws
/// Error on a point the batch lacks, naming those there are. Allocates the result.
template <typename Scalar = double>
MatrixX<Scalar> model_inputs(const TrainedModel& model, const Batch& batch) {
  const MatrixX<Scalar> all = model_temperatures<Scalar>(batch, model.reference);
  MatrixX<Scalar> chosen(all.rows(), static_cast<Index>(model.temperatures.size()));
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

/// Prediction, residuals where the batch holds all of the model's errors, and distances to the training domain,
/// computed in Scalar. Errors as model_inputs. Allocates the result.
template <typename Scalar = double>
BatchPrediction predict(const TrainedModel& trained, const Batch& batch) {
  const MatrixX<Scalar> inputs = model_inputs<Scalar>(trained, batch);
  const MatrixX<Scalar> predicted = detail::lazy<Scalar>(trained.model).template cast<Scalar>().predict_rows(inputs);
  const TrainingDomain<Scalar> domain = detail::lazy<Scalar>(trained.domain).template cast<Scalar>();
  BatchPrediction result;
  result.errors = predicted.template cast<double>();
  for (Index i = 0; i < inputs.rows(); ++i) {
    const DomainDistance<Scalar> distance = domain.distance(inputs.row(i).transpose());
    result.distances.push_back({static_cast<double>(distance.t2), static_cast<double>(distance.spe)});
  }
  MatrixX<Scalar> measured(inputs.rows(), static_cast<Index>(trained.errors.size()));
  for (std::size_t e = 0; e < trained.errors.size(); ++e) {
    const Index column = batch.errors.find(trained.errors[e]);
    if (column < 0) return result;
    measured.col(static_cast<Index>(e)) = detail::lazy<Scalar>(batch.errors.values).col(column).template cast<Scalar>();
  }
  const MatrixX<Scalar> residuals = predicted - measured;
  result.residuals = residuals.template cast<double>();
  result.S_um = (residuals.colwise().squaredNorm() / static_cast<Scalar>(inputs.rows() - 1))
                    .cwiseSqrt()
                    .transpose()
                    .template cast<double>();
  return result;
}

THERMFIT_COMPILED_TEMPLATE(BatchPrediction predict<double>(const TrainedModel&, const Batch&));

}  // namespace thermfit
