#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/controller/arithmetic.hpp"
#include "thermfit/controller/controller_model.hpp"
#include "thermfit/controller/dynamic_row.hpp"
#include "thermfit/error.hpp"
#include "thermfit/model/trained_model.hpp"

/// Host only: from the model as fitted to the model as it runs.

namespace thermfit {

/// Which limit of the training domain counts.
enum class DomainLimit {
  percent_95,  ///< 5 % of ordinary samples lie beyond it
  percent_99   ///< 1 % of ordinary samples lie beyond it
};

namespace detail {

/// Rounds to Scalar; a value that this makes infinite, or that was not finite before, is an error.
template <class Scalar>
Scalar narrowed(double value, const std::string& name) {
  const auto result = static_cast<Scalar>(value);
  if (!is_finite(result)) throw Error(name, "a value that the controller's number type cannot hold");
  return result;
}

template <class T, int Size>
void fit_size(Row<T, Size>& row, Index size, const char* what) {
  if (Size != dynamic_size && Size != size)
    throw Error("controller model", std::to_string(size) + ' ' + what, std::to_string(Size),
                "change the sizes of the ControllerModel, or fit a model of that size");
  set_size(row, static_cast<std::size_t>(size));
}

template <class Scalar, int Size, class Values>
void fill(Row<Scalar, Size>& row, const Values& values, const char* what) {
  fit_size<Scalar, Size>(row, values.size(), what);
  for (Index i = 0; i < values.size(); ++i) row[static_cast<std::size_t>(i)] = narrowed<Scalar>(values(i), what);
}

template <class Scalar, int Rows, int Size>
void fill_columns(Row<Row<Scalar, Size>, Rows>& rows, const Matrix& columns, const char* row, const char* what) {
  fit_size<Row<Scalar, Size>, Rows>(rows, columns.cols(), row);
  for (Index j = 0; j < columns.cols(); ++j)
    fill<Scalar, Size>(rows[static_cast<std::size_t>(j)], columns.col(j), what);
}

/// The lags of a model: point and time constant in minutes, in the order of its features, each once.
inline std::vector<std::pair<Index, double>> lags_of(const TrainedModel& trained) {
  std::vector<std::pair<Index, double>> lags;
  for (const Feature& feature : trained.features) {
    const std::pair<Index, double> lag{feature.point, feature.lag_min};
    if (feature.kind == FeatureKind::lag && std::find(lags.begin(), lags.end(), lag) == lags.end()) lags.push_back(lag);
  }
  return lags;
}

/// Features and lags, checked against the points; the climates of training.
template <class Scalar, int Features, int Lags>
void fill_features(ControllerFeatures<Scalar, Features, Lags>& features, const TrainedModel& trained) {
  const Index sensors = static_cast<Index>(trained.temperatures.size());
  const auto lags = lags_of(trained);
  fit_size<ControllerFeature, Features>(features.channels, static_cast<Index>(trained.features.size()), "features");
  fit_size<std::uint8_t, Lags>(features.lag_sensor, static_cast<Index>(lags.size()), "lags");
  for (std::size_t f = 0; f < trained.features.size(); ++f) {
    const Feature& from = trained.features[f];
    const bool difference = from.kind == FeatureKind::difference;
    if (from.point < 0 || from.point >= sensors || (difference && (from.other < 0 || from.other >= sensors)))
      throw Error("controller model", "a feature of a point that the model has not", "0 to sensors - 1");
    const auto lag = std::find(lags.begin(), lags.end(), std::pair<Index, double>{from.point, from.lag_min});
    features.channels[f] = {static_cast<ControllerFeatureKind>(from.kind), static_cast<std::uint8_t>(from.point),
                            static_cast<std::uint8_t>(difference ? from.other : 0),
                            static_cast<std::uint16_t>(from.kind == FeatureKind::lag ? lag - lags.begin() : 0)};
  }
  for (std::size_t k = 0; k < lags.size(); ++k) features.lag_sensor[k] = static_cast<std::uint8_t>(lags[k].first);
  features.climate_lowest_degC = narrowed<Scalar>(trained.climate.lowest, "climate");
  features.climate_highest_degC = narrowed<Scalar>(trained.climate.highest, "climate");
  features.climate_mean_degC = narrowed<Scalar>(trained.climate.mean, "climate");
}

/// A number for each model: FNV-1a, 32 bits, over names, reference, features and coefficients; never 0.
inline std::uint32_t identity_of(const TrainedModel& trained) {
  std::uint32_t result = fnv1a_begin;
  const auto add = [&](const void* bytes, std::size_t size) { result = fnv1a(result, bytes, size); };
  for (const std::string& name : trained.temperatures) add(name.c_str(), name.size() + 1);
  const Index values = trained.model.coefficients.size(), errors = trained.model.intercept.size();
  add(trained.model.coefficients.data(), static_cast<std::size_t>(values) * sizeof(double));
  add(trained.model.intercept.data(), static_cast<std::size_t>(errors) * sizeof(double));
  const bool rise = trained.reference == TemperatureReference::rise;
  add(rise ? "rise" : "absolute", 4);
  for (const Feature& feature : trained.features) {
    const double what[] = {static_cast<double>(feature.kind), static_cast<double>(feature.point),
                           static_cast<double>(feature.other), feature.lag_min};
    add(what, sizeof what);
  }
  return result == 0 ? 1 : result;
}

}  // namespace detail

/// The fixed-size (or, on the host, dynamic) controller model that computes what `trained` predicts.
/// Throws Error when a size differs from the type's, or a value cannot be held; nothing is cut or padded. Components
/// are those of the training domain. A type without `Features` takes no model of the method transfer. Sensors above 254
/// have no place in the status word and are refused.
template <class Scalar, int Sensors = dynamic_size, int Errors = dynamic_size, int Components = dynamic_size,
          int Features = none_or_dynamic(Sensors), int Lags = none_or_dynamic(Sensors)>
ControllerModel<Scalar, Sensors, Errors, Components, Features, Lags> narrow_model(
    const TrainedModel& trained, DomainLimit limit = DomainLimit::percent_99) {
  using Model = ControllerModel<Scalar, Sensors, Errors, Components, Features, Lags>;
  constexpr int Inputs = Model::Inputs;
  Model model;
  const Index inputs = trained.model.sensors();
  const char* const named = trained.features.empty() ? "sensors" : "features";
  const Index sensors = trained.features.empty() ? inputs : static_cast<Index>(trained.temperatures.size());
  if (inputs != (trained.features.empty() ? sensors : trained.inputs()))
    throw Error("controller model", std::to_string(inputs) + " coefficients", std::to_string(trained.inputs()));
  require_no_inputs(trained, "controller model");
  if (!trained.features.empty() && trained.reference != TemperatureReference::rise)
    throw Error("controller model", "features of absolute temperatures", "of rises");
  if constexpr (Features == 0) {
    if (!trained.features.empty())
      throw Error("controller model",
                  "a model of the method " + trained.method + ", whose coefficients are of features",
                  "a model on temperatures themselves", "give ControllerModel as many Features and Lags as it has");
  } else {
    detail::fill_features<Scalar, Features, Lags>(model.features, trained);
  }
  if (sensors < 1 || sensors > 254)
    throw Error("controller model", std::to_string(sensors) + " sensors", "1 to 254", "choose fewer points");
  const auto fill_equation = [named](typename Model::Equation& equation, const LinearModel<>& from) {
    detail::fill_columns<Scalar, Errors, Inputs>(equation.coefficients, from.coefficients, "errors", named);
    detail::fill<Scalar, Errors>(equation.intercept_um, from.intercept, "errors");
  };
  model.rise = trained.reference == TemperatureReference::rise;
  fill_equation(model.equation, trained.model);

  const LinearModel<> nothing{Matrix::Zero(inputs, trained.model.errors()), Vector::Zero(trained.model.errors())};
  detail::fit_size<typename Model::Equation, Sensors>(model.substitutes, sensors, "sensors");
  detail::fit_size<bool, Sensors>(model.has_substitute, sensors, "sensors");
  for (auto& substitute : model.substitutes) fill_equation(substitute, nothing);
  detail::fit_size<Row<Scalar, Errors>, Sensors>(model.agreement_um, sensors, "sensors");
  for (auto& agreement : model.agreement_um)
    detail::fill<Scalar, Errors>(agreement, Vector::Zero(trained.model.errors()), "errors");
  for (const SubstituteModel& substitute : trained.substitutes) {
    const auto lost = static_cast<std::size_t>(substitute.lost);
    if (substitute.lost < 0 || substitute.lost >= sensors || substitute.model.coefficients.rows() != inputs)
      throw Error("controller model", "a substitute for sensor " + std::to_string(substitute.lost), "0 to sensors - 1");
    fill_equation(model.substitutes[lost], substitute.model);
    for (auto& row : model.substitutes[lost].coefficients)
      for (std::size_t i = 0; i < row.size(); ++i)
        if (trained.features.empty() ? i == lost : trained.features[i].is_of(substitute.lost)) row[i] = 0;
    if (substitute.agreement_um.size() == trained.model.errors())
      detail::fill<Scalar, Errors>(model.agreement_um[lost], substitute.agreement_um, "errors");
    model.has_substitute[lost] = true;
  }

  const TrainingDomain<>& domain = trained.domain;
  const bool known = domain.mean.size() == inputs;
  const Vector mean = known ? domain.mean : Vector::Zero(inputs);
  const Vector inverse_scale = known ? Vector(domain.scale.cwiseInverse()) : Vector::Ones(inputs);
  detail::fill<Scalar, Inputs>(model.domain.mean, mean, named);
  detail::fill<Scalar, Inputs>(model.domain.inverse_scale, inverse_scale, named);
  detail::fill_columns<Scalar, Components, Inputs>(model.domain.rotations, domain.rotations, "components", named);
  detail::fill_columns<Scalar, Components, Inputs>(model.domain.loadings, domain.loadings, "components", named);
  detail::fill<Scalar, Components>(model.domain.inverse_score_variance, domain.score_variance.cwiseInverse(),
                                   "components");
  const bool wide = limit == DomainLimit::percent_99;
  const auto bounded = [](double value) { return std::isfinite(value) ? value : 0; };  // no limit: not checked
  model.domain.t2_limit = detail::narrowed<Scalar>(bounded(wide ? domain.t2_limit_99 : domain.t2_limit_95), "T2 limit");
  model.domain.spe_limit =
      detail::narrowed<Scalar>(bounded(wide ? domain.spe_limit_99 : domain.spe_limit_95), "SPE limit");
  detail::fill<Scalar, Errors>(model.centre_um, trained.model.predict(mean), "errors");
  model.identity = detail::identity_of(trained);
  return model;
}

}  // namespace thermfit
