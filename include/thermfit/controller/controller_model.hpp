#pragma once

#include "thermfit/controller/row.hpp"

namespace thermfit {

/// `error_j = intercept_j + sum_i coefficient_ji * temperature_i`, added up in the order of the sensors, so that every
/// target gets the same bits. Coefficients in um/K, one row per error.
template <class Scalar, int Sensors, int Errors>
struct ControllerEquation {
  Row<Row<Scalar, Sensors>, Errors> coefficients{};  ///< um/K, a row an error
  Row<Scalar, Errors> intercept_um{};                ///< prediction where all temperatures are 0

  /// The error number `error` in um from temperatures in the model's order and reference (K of rise, or degC).
  template <class Temperatures>
  constexpr Scalar predict(std::size_t error, const Temperatures& temperatures) const noexcept {
    Scalar sum = intercept_um[error];
    for (std::size_t i = 0; i < coefficients[error].size(); ++i) sum += coefficients[error][i] * temperatures[i];
    return sum;
  }
};

/// The training domain of training_domain.hpp with its divisions done beforehand. Empty rows of components mean that
/// the domain is unknown. A limit of 0 switches that part off.
template <class Scalar, int Sensors, int Components>
struct ControllerDomain {
  Row<Scalar, Sensors> mean{};                        ///< of the training temperatures, in the model's reference
  Row<Scalar, Sensors> inverse_scale{};               ///< 1 over their standard deviation, 1/K
  Row<Row<Scalar, Sensors>, Components> rotations{};  ///< from standardised temperatures to scores, a row a component
  Row<Row<Scalar, Sensors>, Components> loadings{};   ///< from scores back, a row a component
  Row<Scalar, Components> inverse_score_variance{};   ///< 1 over the variance of each score in training
  Scalar t2_limit = 0;                                ///< of T2; 0: not checked
  Scalar spe_limit = 0;                               ///< of SPE; 0: not checked
};

/// All that a compensator knows about the machine: plain constant data, fit for `constexpr` and flash.
/// narrow_model.hpp makes it from a TrainedModel, `thermfit export --target cpp` writes it as source.
template <class Scalar, int Sensors, int Errors, int Components>
struct ControllerModel {
  using Equation = ControllerEquation<Scalar, Sensors, Errors>;  ///< temperatures to errors

  bool rise = true;                      ///< temperatures count from the first usable readings; false: absolute degC
  Equation equation{};                   ///< with all sensors
  Row<Equation, Sensors> substitutes{};  ///< without sensor i, its coefficients zero
  Row<bool, Sensors> has_substitute{};   ///< whether substitutes[i] can stand in
  ControllerDomain<Scalar, Sensors, Components> domain{};  ///< what the training temperatures looked like
  Row<Scalar, Errors> centre_um{};  ///< prediction at the domain's mean: where `shrink` shrinks to

  /// How many temperatures it takes.
  constexpr std::size_t sensors() const noexcept { return has_substitute.size(); }
  /// How many errors it predicts.
  constexpr std::size_t errors() const noexcept { return centre_um.size(); }
};

}  // namespace thermfit
