#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "thermfit/batch/climate.hpp"
#include "thermfit/batch/known_inputs.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/error.hpp"
#include "thermfit/features/feature_columns.hpp"
#include "thermfit/model/outside_domain.hpp"
#include "thermfit/model/trained_model.hpp"

namespace thermfit {

/// What a model says of one batch.
struct BatchPrediction {
  Matrix errors;     ///< rows x errors, um
  Matrix residuals;  ///< prediction minus measurement, um, NaN in rows without one; no columns
                     ///< where an error was measured in no row
  Vector S_um;       ///< eq. (10) per error over the rows measured, NaN of one; empty where not measured
  std::vector<DomainDistance<>> distances;  ///< per row

  /// Share of rows beyond the 95 % or 99 % limit of `domain`, 0 … 1.
  double share_beyond(const TrainingDomain<>& domain, int percent) const {
    double count = 0;
    for (const DomainDistance<>& distance : distances) count += outside_limits(domain, distance, percent).any();
    return distances.empty() ? 0 : count / static_cast<double>(distances.size());
  }
};

namespace detail {

/// The batch as rises of a model count in it: from its first row, or, where that was left out and errors do so too,
/// from the first that is there; a copy only then.
class CountedBatch {
 public:
  CountedBatch(const TrainedModel& model, const Batch& batch) : batch_(batch) {
    if (model.error_reference != ErrorReference::recorded && !lacks_first_reading(batch).empty())
      later_ = from_first_row_there(batch);
  }
  const Batch& operator*() const { return later_ ? *later_ : batch_; }

 private:
  const Batch& batch_;
  std::optional<Batch> later_;
};

/// Columns of the model's points. Throws Error on one that the batch lacks, naming those there are.
inline std::vector<Index> columns_of(const TrainedModel& model, const Batch& batch) {
  std::vector<Index> columns;
  for (const std::string& point : model.temperatures) {
    columns.push_back(batch.temperatures.find(point));
    if (columns.back() >= 0) continue;
    std::string there;
    for (const std::string& name : batch.temperatures.names) there += (there.empty() ? "" : ", ") + name;
    throw Error(batch.source.empty() ? batch.name : batch.source,
                "no temperature point '" + point + "', which the model needs", there);
  }
  return columns;
}

}  // namespace detail

/// The climate of `batch` for a model with features, degC. Throws Error on a point the batch lacks.
inline double model_climate_degC(const TrainedModel& model, const Batch& batch) {
  return climate_degC(*detail::CountedBatch(model, batch), detail::columns_of(model, batch));
}

/// Temperatures of `batch` as `model` wants them: its points, in its order, as rise or absolute, or its features; rows
/// x inputs. Throws Error on a point the batch lacks, naming those there are, and on a rise without a first reading,
/// unless errors have another reference than recorded: then rises count from the first row that is there. Allocates the
/// result.
template <typename Scalar = double>
MatrixX<Scalar> model_inputs(const TrainedModel& model, const Batch& batch) {
  if (model.reference == TemperatureReference::rise && model.error_reference == ErrorReference::recorded)
    require_first_readings(batch, model.temperatures);
  const detail::CountedBatch counted(model, batch);
  const std::vector<Index> columns = detail::columns_of(model, batch);
  const MatrixX<Scalar> chosen = model_temperatures<Scalar>(*counted, model.reference)(Eigen::all, columns);
  if (model.features.empty()) return chosen;
  for (const Feature& feature : model.features)
    if ((feature.kind == FeatureKind::lag || feature.kind == FeatureKind::input_lag) && !batch.has_time())
      throw Error(batch.source.empty() ? batch.name : batch.source, "no clock, which the lags of the model need",
                  "time_s, time_min, time_h, Time, or a column of ISO 8601 date-times",
                  "name it (CsvOptions::time_column, CsvOptions::time_unit)");
  return feature_columns(model.features, chosen,
                         VectorX<Scalar>(detail::lazy<Scalar>(batch.time_s).template cast<Scalar>()),
                         static_cast<Scalar>(model.climate.factor(climate_degC(*counted, columns))),
                         known_inputs<Scalar>(batch, model.known_inputs));
}

/// How much further each error would be predicted to move at most over the rows of `batch`, um, were the climate's part
/// of the model to go on beyond the climates of training as within them: what clipping the climate withholds, so that
/// no climate takes a prediction further than those of training do. 0 within them. Errors as model_inputs. Allocates.
template <typename Scalar = double>
Vector beyond_climate_um(const TrainedModel& model, const Batch& batch) {
  Vector most = Vector::Zero(model.model.errors());
  const detail::CountedBatch counted(model, batch);
  const std::vector<Index> columns = detail::columns_of(model, batch);
  const auto beyond_K = static_cast<Scalar>(model.climate.beyond_K(climate_degC(*counted, columns)));
  if (!(beyond_K > 0) || batch.rows() == 0) return most;
  const MatrixX<Scalar> rises = model_temperatures<Scalar>(*counted, model.reference)(Eigen::all, columns);
  MatrixX<Scalar> slopes = MatrixX<Scalar>::Zero(rises.cols(), most.size());
  for (std::size_t f = 0; f < model.features.size(); ++f)
    if (model.features[f].kind == FeatureKind::climate)
      for (Index e = 0; e < most.size(); ++e)
        slopes(model.features[f].point, e) = static_cast<Scalar>(model.model.coefficients(static_cast<Index>(f), e));
  const MatrixX<Scalar> withheld = beyond_K * rises * slopes;
  for (Index e = 0; e < most.size(); ++e)
    for (Index row = 0; row < withheld.rows(); ++row)
      if (std::isfinite(withheld(row, e))) most(e) = std::max(most(e), std::abs(static_cast<double>(withheld(row, e))));
  return most;
}

namespace detail {

/// Prediction minus measurement of one error, NaN where there is none, as `reference` counts what was measured. Until
/// the row where it starts it has moved by what is predicted from `at_start` on: where it begins later than rises do.
template <typename Scalar>
VectorX<Scalar> residuals_of(const VectorX<Scalar>& predicted, Scalar at_start, const Vector& measured,
                             ErrorReference reference) {
  VectorX<Scalar> residuals = predicted - lazy<Scalar>(measured).template cast<Scalar>();
  if (reference == ErrorReference::recorded) return residuals;
  Scalar sum = 0, count = 0;
  for (Index row = 0; row < residuals.size(); ++row)
    if (std::isfinite(residuals(row))) sum += residuals(row), ++count;
  if (reference == ErrorReference::batch) {
    residuals.array() -= count > 0 ? sum / count : Scalar(0);
    return residuals;
  }
  const ErrorStart start = error_start(measured);
  if (start.row < 0) return residuals;
  residuals.array() += static_cast<Scalar>(start.value_um) - (predicted(start.row) - at_start);
  return residuals;
}

}  // namespace detail

/// Prediction, residuals where the batch holds readings of all of the model's errors, and distances to the training
/// domain, computed in Scalar. Errors measured are counted as those of training, so that S has the same reference.
/// Errors as model_inputs. Allocates the result.
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
  const bool rise = trained.reference == TemperatureReference::rise;
  const Index errors = static_cast<Index>(trained.errors.size());
  MatrixX<Scalar> residuals(inputs.rows(), errors);
  VectorX<Scalar> S(errors);
  for (Index e = 0; e < errors; ++e) {
    const Index column = batch.errors.find(trained.errors[static_cast<std::size_t>(e)]);
    if (column < 0) return result;
    const VectorX<Scalar> own =
        detail::residuals_of<Scalar>(predicted.col(e), static_cast<Scalar>(rise ? trained.model.intercept(e) : 0),
                                     batch.errors.values.col(column), trained.error_reference);
    Scalar squares = 0;
    Index measured = 0;
    for (Index row = 0; row < own.size(); ++row)
      if (std::isfinite(own(row))) squares += own(row) * own(row), ++measured;
    if (measured == 0) return result;
    residuals.col(e) = own;
    S(e) = measured > 1 ? std::sqrt(squares / static_cast<Scalar>(measured - 1))
                        : std::numeric_limits<Scalar>::quiet_NaN();
  }
  result.residuals = residuals.template cast<double>();
  result.S_um = S.template cast<double>();
  return result;
}

THERMFIT_COMPILED_TEMPLATE(BatchPrediction predict<double>(const TrainedModel&, const Batch&));

}  // namespace thermfit
