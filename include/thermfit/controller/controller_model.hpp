#pragma once

#include "thermfit/controller/controller_feature.hpp"
#include "thermfit/controller/row.hpp"

namespace thermfit {

/// `error_j = intercept_j + sum_i coefficient_ji * temperature_i`, added up in the order of the sensors, so that every
/// target gets the same bits. Coefficients in um/K, one row per error.
template <class Scalar, int Inputs, int Errors>
struct ControllerEquation {
  Row<Row<Scalar, Inputs>, Errors> coefficients{};  ///< um/K, a row an error
  Row<Scalar, Errors> intercept_um{};               ///< prediction where all temperatures are 0

  /// The error number `error` in um from temperatures in the model's order and reference (K of rise, or degC).
  template <class Temperatures>
  constexpr Scalar predict(std::size_t error, const Temperatures& temperatures) const noexcept {
    return added_up(error, intercept_um[error], temperatures);
  }

  /// What the error number `error` has changed by, um, where the temperatures have changed by `rises`, K.
  template <class Temperatures>
  constexpr Scalar change(std::size_t error, const Temperatures& rises) const noexcept {
    return added_up(error, Scalar(0), rises);
  }

 private:
  template <class Temperatures>
  constexpr Scalar added_up(std::size_t error, Scalar sum, const Temperatures& temperatures) const noexcept {
    for (std::size_t i = 0; i < coefficients[error].size(); ++i) sum += coefficients[error][i] * temperatures[i];
    return sum;
  }
};

/// The training domain of training_domain.hpp with its divisions done beforehand. Empty rows of components mean that
/// the domain is unknown. A limit of 0 switches that part off.
template <class Scalar, int Inputs, int Components>
struct ControllerDomain {
  Row<Scalar, Inputs> mean{};                        ///< of the training temperatures, in the model's reference
  Row<Scalar, Inputs> inverse_scale{};               ///< 1 over their standard deviation, 1/K
  Row<Row<Scalar, Inputs>, Components> rotations{};  ///< from standardised temperatures to scores, a row a component
  Row<Row<Scalar, Inputs>, Components> loadings{};   ///< from scores back, a row a component
  Row<Scalar, Components> inverse_score_variance{};  ///< 1 over the variance of each score in training
  Scalar t2_limit = 0;                               ///< of T2; 0: not checked
  Scalar spe_limit = 0;                              ///< of SPE; 0: not checked
};

/// All that a compensator knows about the machine: plain constant data, fit for `constexpr` and flash.
/// narrow_model.hpp makes it from a TrainedModel, `thermfit export --target cpp` writes it as source.
///
/// A model on derived channels (rises, lagged rises, rises times the climate, differences: the method transfer) has
/// `Features` coefficients an error and `Lags` lags; its domain and substitutes are of the features. Others have as
/// many coefficients as sensors, and nothing of the features costs them a byte.
template <class Scalar, int Sensors, int Errors, int Components, int Features = none_or_dynamic(Sensors),
          int Lags = none_or_dynamic(Sensors)>
struct ControllerModel {
  static constexpr int Inputs = inputs_of(Sensors, Features);   ///< how many numbers coefficients multiply
  using Equation = ControllerEquation<Scalar, Inputs, Errors>;  ///< temperatures, or features of them, to errors

  bool rise = true;                                       ///< temperatures count from a zero (datum.hpp); false: degC
  ControllerFeatures<Scalar, Features, Lags> features{};  ///< what coefficients are of; empty: of the temperatures
  Equation equation{};                                    ///< with all sensors
  Row<Equation, Sensors> substitutes{};                   ///< without sensor i, its coefficients zero
  Row<bool, Sensors> has_substitute{};                    ///< whether substitutes[i] can stand in
  /// How far substitutes[i] may be from the equation, um, for sensor i to agree with the others; 0: not known
  Row<Row<Scalar, Errors>, Sensors> agreement_um{};
  ControllerDomain<Scalar, Inputs, Components> domain{};  ///< what the inputs looked like in training
  Row<Scalar, Errors> centre_um{};  ///< prediction at the domain's mean: where `shrink` shrinks to
  std::uint32_t identity = 0;       ///< tells models apart: a retained zero belongs to one

  /// How many temperatures it takes.
  constexpr std::size_t sensors() const noexcept { return has_substitute.size(); }
  /// How many errors it predicts.
  constexpr std::size_t errors() const noexcept { return centre_um.size(); }
  /// How many numbers its coefficients multiply.
  constexpr std::size_t inputs() const noexcept { return domain.mean.size(); }
};

}  // namespace thermfit
