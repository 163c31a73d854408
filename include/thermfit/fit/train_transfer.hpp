#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/known_inputs.hpp"
#include "thermfit/features/feature_columns.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/fit/transfer.hpp"

namespace thermfit {

/// What to train by the method `transfer`.
struct TransferPlan {
  std::vector<Index> points;                    ///< temperature columns; empty: all
  std::string selection = "all";                ///< how they were chosen, for the record
  std::optional<std::vector<double>> lags_min;  ///< to choose from, of none no lag; not given: visible_lags_min()
  ErrorReference error_reference = ErrorReference::recorded;  ///< what the errors are measured from
  std::vector<std::string> inputs;                            ///< known inputs whose changes and lags it may be made of
  std::vector<std::pair<std::string, std::string>> differences;  ///< of temperatures: the first less the second
  TransferOptions options;  ///< penalties; an intercept only where errors are as recorded, whatever it says
};

/// The batches of a campaign as a plan of the method `transfer` sees them.
template <typename Scalar = double>
struct TransferData {
  std::vector<Index> points;                   ///< temperature columns
  std::vector<double> lags_min;                ///< to choose from
  std::vector<TransferBatch<Scalar>> batches;  ///< in order
  TransferOptions options;                     ///< of the plan, intercept settled
  TransferExtras extras;                       ///< of the plan, differences as positions in `points`
};

/// Every batch of `campaign` in its products. Batches with other channels than the first: Error. Allocates.
template <typename Scalar = double>
TransferData<Scalar> transfer_data(const Campaign& campaign, const TransferPlan& plan = {}) {
  if (campaign.empty()) throw Error("transfer", "no batch", "2 or more");
  const Batch& first = campaign.front();
  TransferData<Scalar> data{
      plan.points, plan.lags_min ? *plan.lags_min : visible_lags_min(campaign), {}, plan.options, {}};
  for (Index p = 0; plan.points.empty() && p < first.temperatures.count(); ++p) data.points.push_back(p);
  data.options.intercept = plan.error_reference == ErrorReference::recorded;
  std::vector<std::string> names;
  for (const Index point : data.points) names.push_back(first.temperatures.names[static_cast<std::size_t>(point)]);
  data.extras.inputs = plan.inputs;
  const auto position = [&](const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw Error("TransferPlan::differences", "'" + name + "', which is no point of the model", "points of the model");
    return static_cast<Index>(found - names.begin());
  };
  for (const auto& [one, other] : plan.differences)
    data.extras.differences.emplace_back(position(one), position(other));
  for (const Batch& batch : campaign) {
    if (batch.temperatures.names != first.temperatures.names || batch.errors.names != first.errors.names)
      throw Error("batch " + batch.name, "other channels than batch " + first.name,
                  "the same temperatures and errors in every batch");
    if (plan.error_reference == ErrorReference::recorded) require_first_readings(batch, names);
    if (!data.lags_min.empty() && !batch.has_time())
      throw Error("batch " + batch.name, "no clock, which lags need", "a clock in every batch, or no lags");
    data.batches.push_back(
        transfer_batch<Scalar>(batch, data.points, data.lags_min, plan.error_reference, data.extras));
  }
  return data;
}

namespace detail {

/// Coefficients of fits, one an error, as those of `features`; what a feature is not in is 0.
template <typename Scalar>
LinearModel<Scalar> on_features(const std::vector<TransferCoefficients<Scalar>>& fits, const std::vector<double>& lags,
                                const std::vector<Feature>& features,
                                const std::vector<std::pair<Index, Index>>& differences) {
  const auto errors = static_cast<Index>(fits.size());
  LinearModel<Scalar> model{MatrixX<Scalar>::Zero(static_cast<Index>(features.size()), errors),
                            VectorX<Scalar>::Zero(errors)};
  for (Index e = 0; e < errors; ++e) {
    const TransferCoefficients<Scalar>& fit = fits[static_cast<std::size_t>(e)];
    model.intercept(e) = fit.intercept_um;
    for (Index f = 0; f < model.coefficients.rows(); ++f) {
      const Feature& feature = features[static_cast<std::size_t>(f)];
      if (feature.kind == FeatureKind::rise) model.coefficients(f, e) = fit.rise(feature.point);
      if (feature.kind == FeatureKind::climate) model.coefficients(f, e) = fit.climate(feature.point);
      const bool own_lag = feature.lag_min == lags[static_cast<std::size_t>(e)];
      if (feature.kind == FeatureKind::lag && own_lag) model.coefficients(f, e) = fit.lagged(feature.point);
      if (feature.kind == FeatureKind::input) model.coefficients(f, e) = fit.input(feature.point);
      if (feature.kind == FeatureKind::input_lag && own_lag) model.coefficients(f, e) = fit.input_lagged(feature.point);
      for (std::size_t d = 0; feature.kind == FeatureKind::difference && d < differences.size(); ++d)
        if (differences[d] == std::make_pair(feature.point, feature.other))
          model.coefficients(f, e) = fit.difference(static_cast<Index>(d));
    }
  }
  return model;
}

/// Which of `differences` are not of the point `lost`.
inline std::vector<Index> without_point(const std::vector<std::pair<Index, Index>>& differences, Index lost) {
  std::vector<Index> kept;
  for (std::size_t d = 0; d < differences.size(); ++d)
    if (differences[d].first != lost && differences[d].second != lost) kept.push_back(static_cast<Index>(d));
  return kept;
}

/// The same batch without its `lost`th point and the differences with it; its climate stays.
template <typename Scalar>
TransferBatch<Scalar> without_point(TransferBatch<Scalar> batch, Index lost,
                                    const std::vector<std::pair<Index, Index>>& differences) {
  const std::vector<Index> others = without_point(differences, lost);
  const Index first = batch.first_difference(), behind = first + batch.differences;
  std::vector<Index> kept;
  for (Index c = 0; c < first; ++c)
    if (c != lost && !(batch.has_lag && c == batch.points + lost)) kept.push_back(c);
  for (const Index d : others) kept.push_back(first + d);
  for (Index c = behind; c < batch.products.front().rows(); ++c) kept.push_back(c);
  for (MatrixX<Scalar>& products : batch.products) {
    MatrixX<Scalar> fewer = products(kept, kept);
    products = std::move(fewer);
  }
  --batch.points;
  batch.differences = static_cast<Index>(others.size());
  return batch;
}

/// Coefficients with a 0 for the point that is not there, and for differences with it.
template <typename Scalar>
TransferCoefficients<Scalar> with_point(const TransferCoefficients<Scalar>& fit, Index lost,
                                        const std::vector<std::pair<Index, Index>>& differences) {
  const auto widened = [&](const VectorX<Scalar>& values) {
    VectorX<Scalar> wide = VectorX<Scalar>::Zero(values.size() + 1);
    wide.head(lost) = values.head(lost);
    wide.tail(values.size() - lost) = values.tail(values.size() - lost);
    return wide;
  };
  VectorX<Scalar> of_differences = VectorX<Scalar>::Zero(static_cast<Index>(differences.size()));
  const std::vector<Index> kept = without_point(differences, lost);
  for (std::size_t d = 0; d < kept.size(); ++d) of_differences(kept[d]) = fit.difference(static_cast<Index>(d));
  return {fit.intercept_um, widened(fit.rise), widened(fit.lagged), widened(fit.climate),
          fit.input,        fit.input_lagged,  of_differences};
}

/// Moments of a model's features in every batch.
template <typename Scalar>
std::vector<Moments<Scalar>> feature_moments(const Campaign& campaign, const TransferPlan& plan,
                                             const std::vector<Index>& points, const std::vector<Feature>& features,
                                             const std::vector<std::string>& inputs,
                                             const ClimateRange<Scalar>& climate) {
  std::vector<Moments<Scalar>> result;
  for (const Batch& batch : campaign) {
    const Batch counted = referenced<Lazy<double, Scalar>>(batch, plan.error_reference);
    const MatrixX<Scalar> rises = model_temperatures<Scalar>(counted, TemperatureReference::rise)(Eigen::all, points);
    const MatrixX<Scalar> columns = feature_columns(
        features, rises, VectorX<Scalar>(lazy<Scalar>(batch.time_s).template cast<Scalar>()),
        climate.factor(static_cast<Scalar>(climate_degC(counted, points))), known_inputs<Scalar>(batch, inputs));
    const MatrixX<Scalar> errors = lazy<Scalar>(counted.errors.values).template cast<Scalar>();
    std::vector<Index> measured;
    for (Index row = 0; row < errors.rows(); ++row)
      if (errors.row(row).allFinite()) measured.push_back(row);
    result.emplace_back(MatrixX<Scalar>(columns(measured, Eigen::all)), MatrixX<Scalar>(errors(measured, Eigen::all)));
  }
  return result;
}

/// S of eq. (10) per error over all batches; with own intercepts about the mean in each, divisor n - K.
template <typename Scalar>
VectorX<Scalar> deviation(const LinearModel<Scalar>& model, const std::vector<Moments<Scalar>>& batches, bool own) {
  VectorX<Scalar> squares = VectorX<Scalar>::Zero(model.errors());
  Scalar rows = 0;
  for (const Moments<Scalar>& batch : batches) {
    const auto left = residuals(model, batch);
    for (Index e = 0; e < squares.size(); ++e) {
      const Residuals<Scalar>& one = left[static_cast<std::size_t>(e)];
      squares(e) += own ? one.centred_square : one.sum_of_squares();
    }
    rows += static_cast<Scalar>(batch.rows());
  }
  const Scalar taken = own ? static_cast<Scalar>(batches.size()) : Scalar(1);
  return (squares / std::max(Scalar(1), rows - taken)).cwiseSqrt();
}

}  // namespace detail

/// One model of all batches by the method `transfer` (fit_transfer), complete as by train(): its coefficients are of
/// features, rises first, then the lagged rises, those times the climate, differences, inputs and lagged inputs that
/// pay for some error. Its training
/// domain is that of the features. `data` is transfer_data() of the same. A substitute for a lost sensor is fitted with
/// the same penalties and lag; degrees of freedom are counted without what the penalties save. Fewer than two batches,
/// and what transfer_data() refuses: Error. Allocates.
template <typename Scalar = double>
TrainedModel train_transfer(const Campaign& campaign, const TransferPlan& plan, const TransferData<Scalar>& data) {
  const Batch& first = campaign.front();
  const auto points = static_cast<Index>(data.points.size());
  std::vector<TransferFit<Scalar>> fits;
  std::vector<TransferCoefficients<Scalar>> coefficients;
  std::vector<TransferRecord> blocks;
  std::vector<double> lags;
  bool with_climate = false, with_lag = false, with_inputs = false, with_input_lag = false, with_differences = false;
  for (Index e = 0; e < first.errors.count(); ++e) {
    fits.push_back(fit_transfer(data.batches, e, data.options));
    const TransferPenalties<Scalar>& chosen = fits.back().penalties;
    coefficients.push_back(fits.back().coefficients);
    const bool lagged = std::isfinite(chosen.lag) || std::isfinite(chosen.input_lag);
    lags.push_back(lagged ? data.lags_min[chosen.lag_index] : 0);
    with_lag = with_lag || std::isfinite(chosen.lag);
    with_inputs = with_inputs || std::isfinite(chosen.input);
    with_input_lag = with_input_lag || std::isfinite(chosen.input_lag);
    with_differences = with_differences || std::isfinite(chosen.difference);
    with_climate = with_climate || std::isfinite(chosen.climate);
    blocks.push_back({static_cast<double>(chosen.rise), static_cast<double>(chosen.lag),
                      static_cast<double>(chosen.climate), lags.back(), static_cast<double>(chosen.input),
                      static_cast<double>(chosen.input_lag), static_cast<double>(chosen.difference)});
  }
  std::vector<Feature> features;
  for (Index p = 0; p < points; ++p) features.push_back({FeatureKind::rise, p});
  std::vector<double> used = lags;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const double lag : used)
    for (Index p = 0; lag > 0 && with_lag && p < points; ++p) features.push_back({FeatureKind::lag, p, -1, lag});
  for (Index p = 0; with_climate && p < points; ++p) features.push_back({FeatureKind::climate, p});
  for (std::size_t d = 0; with_differences && d < data.extras.differences.size(); ++d)
    features.push_back({FeatureKind::difference, data.extras.differences[d].first, data.extras.differences[d].second});
  const auto inputs = static_cast<Index>(data.extras.inputs.size());
  for (Index i = 0; with_inputs && i < inputs; ++i) features.push_back({FeatureKind::input, i});
  for (const double lag : used)
    for (Index i = 0; lag > 0 && with_input_lag && i < inputs; ++i)
      features.push_back({FeatureKind::input_lag, i, -1, lag});
  const std::vector<std::string> known =
      with_inputs || with_input_lag ? data.extras.inputs : std::vector<std::string>();

  const ClimateRange<Scalar>& climate = fits.front().climate;
  const std::vector<Moments<Scalar>> seen =
      detail::feature_moments(campaign, plan, data.points, features, known, climate);
  const Moments<Scalar> all = merged(seen);
  const detail::StandardisedMoments<Scalar> standardised(all, Scaling::both);
  const detail::Spectrum<Scalar> spectrum = detail::spectrum(standardised);
  const bool own = plan.error_reference == ErrorReference::batch;
  LinearFit<Scalar> fit;
  fit.model = detail::on_features(coefficients, lags, features, data.extras.differences);
  fit.channels = standardised.channels;
  fit.standardised_coefficients = fit.channels.temperature_scale.asDiagonal() * fit.model.coefficients *
                                  fit.channels.error_scale.cwiseInverse().asDiagonal();
  fit.rows = all.rows();
  fit.rank = spectrum.rank();
  fit.condition_number = spectrum.condition_number();
  fit.residual_deviation_um = detail::deviation(fit.model, seen, own);
  fit.degrees_of_freedom = static_cast<Scalar>(all.rows() - (own ? static_cast<Index>(seen.size()) : 1) - fit.rank);

  TrainedModel trained = trained_model(fit, all);
  trained.method = "transfer";
  trained.selection = plan.selection;
  trained.error_reference = plan.error_reference;
  trained.features = features;
  trained.known_inputs = known;
  trained.climate = {static_cast<double>(climate.lowest), static_cast<double>(climate.highest),
                     static_cast<double>(climate.mean)};
  trained.blocks = std::move(blocks);
  for (const Index point : data.points)
    trained.temperatures.push_back(first.temperatures.names[static_cast<std::size_t>(point)]);
  trained.errors = first.errors.names;
  trained.envelope = sensor_envelope<Scalar>(campaign, trained.temperatures);
  const MatrixX<Scalar> covariance =
      all.temperature_products() / static_cast<Scalar>(std::max<Index>(1, all.rows() - 1));
  const double most_climate =
      std::max(trained.climate.highest - trained.climate.mean, trained.climate.mean - trained.climate.lowest);
  for (Index lost = 0; points > 1 && lost < points; ++lost) {
    std::vector<TransferBatch<Scalar>> fewer;
    for (const TransferBatch<Scalar>& batch : data.batches)
      fewer.push_back(detail::without_point(batch, lost, data.extras.differences));
    std::vector<const TransferBatch<Scalar>*> rest;
    for (const TransferBatch<Scalar>& batch : fewer) rest.push_back(&batch);
    std::vector<TransferCoefficients<Scalar>> others;
    for (std::size_t e = 0; e < fits.size(); ++e) {
      const TransferPenalties<Scalar>& same = fits[e].penalties;
      const TransferSystem<Scalar> system(rest, same.lag_index, climate.mean);
      others.push_back(
          detail::with_point(system.solve(static_cast<Index>(e), same, climate.mean, data.options.intercept), lost,
                             data.extras.differences));
    }
    const LinearModel<Scalar> model = detail::on_features(others, lags, features, data.extras.differences);
    SubstituteModel substitute;
    substitute.lost = lost;
    substitute.model = model.template cast<double>();
    substitute.residual_deviation_um = detail::deviation(model, seen, own).template cast<double>();
    substitute.agreement_um.resize(model.errors());
    for (Index e = 0; e < model.errors(); ++e) {
      const VectorX<Scalar> d = fit.model.coefficients.col(e) - model.coefficients.col(e);
      double noise = 0;
      for (std::size_t f = 0; f < features.size(); ++f)
        if (features[f].is_of(lost))
          noise += std::abs(trained.model.coefficients(static_cast<Index>(f), e)) * trained.envelope.scatter_K(lost) *
                   (features[f].kind == FeatureKind::climate ? most_climate : 1);
      substitute.agreement_um(e) = 4 * std::sqrt(std::max(0., static_cast<double>(d.dot(covariance * d)))) + noise;
    }
    trained.substitutes.push_back(std::move(substitute));
  }
  for (const Batch& batch : campaign) trained.batches.push_back({batch.name, batch.rows(), batch.digest});
  return trained;
}

/// The same, where transfer_data() of them is needed for nothing else.
template <typename Scalar = double>
TrainedModel train_transfer(const Campaign& campaign, const TransferPlan& plan = {}) {
  return train_transfer<Scalar>(campaign, plan, transfer_data<Scalar>(campaign, plan));
}

THERMFIT_COMPILED_TEMPLATE(TransferData<double> transfer_data<double>(const Campaign&, const TransferPlan&));
THERMFIT_COMPILED_TEMPLATE(TrainedModel train_transfer<double>(const Campaign&, const TransferPlan&,
                                                               const TransferData<double>&));

}  // namespace thermfit
