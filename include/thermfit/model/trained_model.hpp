#pragma once

#include <string>
#include <vector>

#include "thermfit/batch/error_reference.hpp"
#include "thermfit/batch/temperature_rise.hpp"
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

/// A linear model with everything a predictor needs and where it came from: the in-memory `thermfit-model/1`.
struct TrainedModel {
  std::string method;                     ///< "pls", "mlr", "pcr", "ridge"
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

  LinearModel<> model;                       ///< raw units: um, um/K
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
};

}  // namespace thermfit
