#pragma once

#include "thermfit/controller/compensator.hpp"
#include "thermfit/controller/settings_for.hpp"

/// A model on three sensors and two errors with all a compensator can use, small enough to check by hand.
inline thermfit::TrainedModel example_model() {
  using namespace thermfit;
  TrainedModel m;
  m.method = "pls";
  m.selection = "given";
  m.components = 2;
  m.temperatures = {"T1", "T2", "T3"};
  m.errors = {"X", "Z"};
  m.model.coefficients = (Matrix(3, 2) << -.5, 2, .25, 1, .125, -1).finished();
  m.model.intercept = Eigen::Vector2d(.5, 1);
  m.temperature_mean = Eigen::Vector3d(6, 5, 2);
  m.temperature_scale = Eigen::Vector3d(3, 2, 1);
  m.error_mean = m.model.predict(m.temperature_mean);
  m.error_scale = Eigen::Vector2d(1.5, 6);
  m.standardised_coefficients = m.model.coefficients;
  m.residual_deviation_um = Eigen::Vector2d(.3, .9);
  m.degrees_of_freedom = 70;
  m.latent.weights = m.latent.loadings = m.latent.rotations = Matrix::Identity(3, 2);
  m.latent.error_loadings = Matrix::Identity(2, 2);
  m.latent.explained_temperature_variance = m.latent.explained_error_variance = Eigen::Vector2d(.8, .95);
  m.latent.vip = Vector::Ones(3);
  m.domain.mean = m.temperature_mean;
  m.domain.scale = m.temperature_scale;
  m.domain.lowest = Vector::Zero(3);
  m.domain.highest = Eigen::Vector3d(12, 9, 4);
  m.domain.rotations = m.domain.loadings = Matrix::Identity(3, 2);
  m.domain.score_variance = Eigen::Vector2d(2, .5);
  m.domain.t2_limit_95 = 6, m.domain.t2_limit_99 = 9.5;
  m.domain.spe_limit_95 = 4, m.domain.spe_limit_99 = 6.5;
  for (Index lost = 0; lost < 2; ++lost) {  // none for the third
    SubstituteModel substitute{lost, m.model, Eigen::Vector2d(.6, 1.8), Eigen::Vector2d(2, 8)};
    substitute.model.coefficients.row(lost).setZero();
    substitute.model.coefficients.row(1 - lost) *= 1.75;
    m.substitutes.push_back(substitute);
  }
  m.envelope = {Eigen::Vector3d(18, 18, 18), Eigen::Vector3d(40, 35, 30), Eigen::Vector3d(2, 1, .5),
                Eigen::Vector3d(1, 2, 4),    Eigen::Vector3d(18, 18, 18), Eigen::Vector3d(22, 22, 22),
                Eigen::Vector3d(.1, .1, .1)};
  m.batches = {{"made", 79, std::string(64, '0')}};
  m.tool_version = "0";
  return m;
}
