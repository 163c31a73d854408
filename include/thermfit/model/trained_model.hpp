#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/error_reference.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/error.hpp"
#include "thermfit/features/climate_range.hpp"
#include "thermfit/features/feature.hpp"
#include "thermfit/model/latent_variables.hpp"
#include "thermfit/model/linear_model.hpp"
#include "thermfit/model/sensor_envelope.hpp"
#include "thermfit/model/training_domain.hpp"

namespace thermfit {

/// A batch a model was trained on, so that the model can be traced to its data.
struct TrainingBatch {
  std::string name;    ///< of the batch
  Index rows = 0;      ///< it had
  std::string digest;  ///< SHA-256 of the numbers, hex
};

/// What stands in for one lost sensor: a model on the others, fitted on the same batches.
struct SubstituteModel {
  Index lost = 0;                ///< index into TrainedModel::temperatures
  LinearModel<> model;           ///< on all sensors in their order, coefficient of the lost one zero
  Vector residual_deviation_um;  ///< per error, on the training rows
  Vector agreement_um;  ///< per error: while the lost sensor is well, the whole model is nearer than this to it
                        ///< (4 standard deviations on the training rows, and the sensor's scatter); empty: unknown
};

/// How the method transfer penalised the blocks of one error. Infinite: the block is not there.
struct TransferRecord {
  double rise_penalty = 0;               ///< of the rises
  double lag_penalty = 0;                ///< of the lagged rises
  double climate_penalty = 0;            ///< of the rises times the climate
  double lag_min = 0;                    ///< time constant; 0 without lag
  double input_penalty = HUGE_VAL;       ///< of changes of known inputs
  double input_lag_penalty = HUGE_VAL;   ///< of lagged inputs
  double difference_penalty = HUGE_VAL;  ///< of differences of points
};

/// A linear model with everything a predictor needs and where it came from: the in-memory `thermfit-model/1`.
struct TrainedModel {
  std::string method;                     ///< "pls", "mlr", "pcr", "ridge", "transfer"
  std::string selection;                  ///< how the points were chosen: "correlation", "fcgr", "given", "all"
  Index components = 0;                   ///< latent variables used; 0 for MLR and ridge
  double ridge_lambda = 0;                ///< penalty; 0 for the others
  std::vector<std::string> temperatures;  ///< chosen points, in coefficient order
  std::vector<std::string> errors;        ///< responses, in coefficient order
  TemperatureReference reference = TemperatureReference::rise;  ///< what its temperatures are measured from
  /// What its errors are measured from, in training and where they are compared with new ones.
  ///
  /// `start`: the intercept is what the fit leaves at rise 0, where these errors are 0 but for noise; a datum takes it
  /// off, so that the machine gets what these errors count: the change since the datum. `batch`: every batch has an
  /// intercept of its own, so that the model has none: it gives changes, 0 at rise 0.
  ErrorReference error_reference = ErrorReference::recorded;

  std::vector<std::string> known_inputs;  ///< columns of Batch::inputs that features are of
  std::vector<Feature> features;       ///< what the coefficients are of; empty: of the rises (temperatures) themselves
  ClimateRange<> climate;              ///< of training, where features need it
  std::vector<TransferRecord> blocks;  ///< of the method transfer, per error; empty for the others

  LinearModel<> model;                       ///< raw units: um, um/K; of the features where there are any, else points
  Matrix standardised_coefficients;          ///< sensors x errors
  Vector temperature_mean;                   ///< per sensor, K of rise or degC
  Vector temperature_scale;                  ///< per sensor, K
  Vector error_mean;                         ///< per error, um
  Vector error_scale;                        ///< per error, um
  LatentVariables<> latent;                  ///< PLS and PCR; empty for the others
  Vector residual_deviation_um;              ///< per error, S of eq. (10) on the training rows; of K own intercepts
                                             ///< with divisor n - K
  Index degrees_of_freedom = 0;              ///< of the residuals, rounded
  double condition_number = 0;               ///< of the standardised temperatures
  TrainingDomain<> domain;                   ///< where it may be trusted
  SensorEnvelope envelope;                   ///< of the chosen points, absolute; empty when unknown
  std::vector<SubstituteModel> substitutes;  ///< one per sensor, or none
  std::vector<TrainingBatch> batches;        ///< it was trained on
  std::string tool_version;                  ///< of the library that trained it

  /// How many numbers the coefficients multiply: features, or points where there are none.
  Index inputs() const { return static_cast<Index>(features.empty() ? temperatures.size() : features.size()); }
  /// What coefficient `i` multiplies, by name. Allocates the text.
  std::string input_name(Index i) const {
    const auto position = static_cast<std::size_t>(i);
    return features.empty() ? temperatures[position] : thermfit::name(features[position], temperatures, known_inputs);
  }
};

/// Refuses, in `place`, a model with features of known inputs, which that place does not hear of: throws Error with the
/// key path.
inline void require_no_inputs(const TrainedModel& model, const std::string& place) {
  for (std::size_t f = 0; f < model.features.size(); ++f)
    if (of_input(model.features[f].kind))
      throw Error(place + ": transfer.features[" + std::to_string(f) + "]",
                  "'" + model.input_name(static_cast<Index>(f)) + "', a known input", "features of temperatures",
                  "predict takes it; here fit a model on rises, lags and climate alone");
}

}  // namespace thermfit
