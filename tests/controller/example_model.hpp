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

/// The same machine with a model on derived channels of every kind: rises, lagged rises of two lags, rises times the
/// climate and a difference; 11 coefficients an error, 4 lags.
inline thermfit::TrainedModel example_transfer_model() {
  using namespace thermfit;
  TrainedModel m = example_model();
  m.method = "transfer";
  m.components = 0;
  m.latent = {};
  m.error_reference = ErrorReference::start;
  for (Index p = 0; p < 3; ++p) m.features.push_back({FeatureKind::rise, p});
  for (Index p = 0; p < 3; ++p) m.features.push_back({FeatureKind::lag, p, -1, 20});
  m.features.push_back({FeatureKind::lag, 0, -1, 5});
  for (Index p = 0; p < 3; ++p) m.features.push_back({FeatureKind::climate, p});
  m.features.push_back({FeatureKind::difference, 0, 1});
  m.climate = {18, 24, 20.5};
  m.blocks = {{.01, .1, 1, 20}, {.01, .1, 1, 5}};
  const Index n = m.inputs();
  m.model.coefficients.resize(n, 2);
  for (Index f = 0; f < n; ++f)
    m.model.coefficients.row(f) << static_cast<double>((f * 7) % 5 - 2) / 8, static_cast<double>((f * 5) % 7 - 3) / 4;
  m.model.intercept.setZero();
  m.standardised_coefficients = m.model.coefficients;
  m.temperature_mean = Vector::LinSpaced(n, 6, 1);
  m.temperature_scale = Vector::LinSpaced(n, 3, 1);
  m.error_mean = m.model.predict(m.temperature_mean);
  m.domain.mean = m.temperature_mean;
  m.domain.scale = m.temperature_scale;
  m.domain.lowest = Vector::Constant(n, -20);
  m.domain.highest = Vector::Constant(n, 40);
  m.domain.rotations.resize(n, 2);  // orthonormal: the first two of the discrete cosines
  for (Index f = 0; f < n; ++f)
    for (Index a = 0; a < 2; ++a)
      m.domain.rotations(f, a) =
          std::sqrt((a == 0 ? 1. : 2.) / static_cast<double>(n)) *
          std::cos(std::acos(-1.) * (static_cast<double>(f) + .5) * static_cast<double>(a) / static_cast<double>(n));
  m.domain.loadings = m.domain.rotations;
  m.domain.score_variance = Eigen::Vector2d(9, 4);
  m.domain.t2_limit_95 = 8, m.domain.t2_limit_99 = 12;
  m.domain.spe_limit_95 = 30, m.domain.spe_limit_99 = 40;
  for (SubstituteModel& substitute : m.substitutes) {
    substitute.model = m.model;
    for (Index f = 0; f < n; ++f) {
      const Feature& feature = m.features[static_cast<std::size_t>(f)];
      if (feature.point == substitute.lost || feature.other == substitute.lost)
        substitute.model.coefficients.row(f).setZero();
      else
        substitute.model.coefficients.row(f) *= 1.25;
    }
  }
  return m;
}
