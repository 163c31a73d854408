#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/fit/fit.hpp"
#include "thermfit/fit/training_domain.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/model/trained_model.hpp"
#include "thermfit/moments/observations.hpp"
#include "thermfit/version.hpp"

namespace thermfit {

/// What to train: the answers of a user who has chosen method and points.
struct TrainingPlan {
  Method method = Method::pls;      ///< which of the four
  FitOptions options;               ///< components, penalty, scaling
  std::vector<Index> points;        ///< temperature columns, in coefficient order; empty: all
  std::string selection = "given";  ///< how they were chosen, for the record
  TemperatureReference reference = TemperatureReference::rise;  ///< what the model's temperatures are measured from
  ErrorReference error_reference = ErrorReference::recorded;    ///< what the errors are measured from
  bool row_wise = false;  ///< QR and NIPALS on all rows instead of moments, for ill-conditioned data
};

/// `options` with what `chosen` (a fit or a trained model) settled on: components and penalty are taken over, not
/// chosen anew, by what is fitted beside it.
template <class Chosen>
FitOptions settled(FitOptions options, const Chosen& chosen) {
  if (chosen.components > 0) options.components = ComponentRule::fixed(chosen.components);
  options.ridge_lambda = chosen.ridge_lambda;
  return options;
}

/// Models that stand in for each lost sensor: `fitter` on the moments of the others, coefficient of the lost one zero.
/// None for a single sensor. Errors are those of the fitter. Allocates.
template <typename Scalar, class Fitter>
std::vector<SubstituteModel> substitute_models(const Moments<Scalar>& moments, const Fitter& fitter) {
  std::vector<SubstituteModel> substitutes;
  for (Index lost = 0; moments.temperatures() > 1 && lost < moments.temperatures(); ++lost) {
    std::vector<Index> others;
    for (Index p = 0; p < moments.temperatures(); ++p) {
      if (p != lost) others.push_back(p);
    }
    const Moments<Scalar> seen = moments.subset(others);
    SubstituteModel substitute;
    substitute.lost = lost;
    const LinearModel<Scalar> model = model_of(fitter(seen));
    substitute.residual_deviation_um = S(residuals(model, seen)).template cast<double>();
    LinearModel<Scalar> of_all{MatrixX<Scalar>::Zero(moments.temperatures(), moments.errors()), model.intercept};
    of_all.coefficients(others, Eigen::all) = model.coefficients;
    substitute.model = of_all.template cast<double>();
    substitutes.push_back(std::move(substitute));
  }
  return substitutes;
}

/// The parts of a trained model that follow from a fit and the moments it was made of, rounded to double; names,
/// batches and settings are left to the caller. Allocates.
template <typename Scalar>
TrainedModel trained_model(const LinearFit<Scalar>& fit, const Moments<Scalar>& moments) {
  const auto kept = [](const auto& numbers) { return numbers.template cast<double>(); };
  TrainedModel trained;
  trained.components = fit.components;
  trained.ridge_lambda = fit.ridge_lambda;
  trained.model = kept(fit.model);
  trained.standardised_coefficients = kept(fit.standardised_coefficients);
  trained.temperature_mean = kept(fit.channels.temperature_mean);
  trained.temperature_scale = kept(fit.channels.temperature_scale);
  trained.error_mean = kept(fit.channels.error_mean);
  trained.error_scale = kept(fit.channels.error_scale);
  trained.latent = kept(fit.latent);
  trained.residual_deviation_um = kept(fit.residual_deviation_um);
  trained.degrees_of_freedom = std::max<Index>(0, std::lround(fit.degrees_of_freedom));
  trained.condition_number = static_cast<double>(fit.condition_number);
  trained.domain = kept(training_domain(fit, moments));
  trained.tool_version = THERMFIT_VERSION;
  return trained;
}

namespace detail {

/// The plan's fit, the moments of the plan's points it is made of, and those of all rows, about no own means.
template <typename Scalar>
struct PlannedFit {
  LinearFit<Scalar> fit;
  Moments<Scalar> fitted, seen;
};

/// A fit on batches about their own means, as a model on rises: without intercept, 0 at rise 0; means and the variance
/// of its scores those of all rows, between batches too.
template <typename Scalar>
void count_from_zero(LinearFit<Scalar>& fit, const Moments<Scalar>& seen) {
  Standardisation<Scalar>& channels = fit.channels;
  fit.model.intercept.setZero();
  channels.temperature_mean = seen.temperature_mean();
  channels.error_mean = fit.model.coefficients.transpose() * channels.temperature_mean;
  if (fit.components == 0) return;
  const MatrixX<Scalar> scores = channels.temperature_scale.cwiseInverse().asDiagonal() * fit.latent.rotations;
  fit.score_variance = (scores.transpose() * seen.temperature_products() * scores).diagonal() /
                       static_cast<Scalar>(std::max<Index>(1, seen.rows() - 1));
}

template <typename Scalar>
PlannedFit<Scalar> fit_plan(const Campaign& campaign, const TrainingPlan& plan, const std::vector<Index>& points) {
  const Batch& first = campaign.front();
  const bool own_means = plan.error_reference == ErrorReference::batch;
  std::vector<Moments<Scalar>> batches;
  std::vector<Observations<Scalar>> rows;
  PlannedFit<Scalar> planned;
  for (const Batch& batch : campaign) {
    if (batch.temperatures.names != first.temperatures.names || batch.errors.names != first.errors.names) {
      throw Error("batch " + batch.name, "other channels than batch " + first.name,
                  "the same temperatures and errors in every batch");
    }
    Observations<Scalar> seen = observe<Scalar>(batch, plan.reference, plan.error_reference);
    batches.push_back(seen.moments.subset(points));
    if (own_means) {
      const Batch again = referenced<Lazy<double, Scalar>>(batch, plan.error_reference);
      planned.seen.merge(observe<Scalar>(again, plan.reference).moments.subset(points));
    }
    if (plan.row_wise) rows.push_back(std::move(seen));
  }
  planned.fitted = merged(batches);
  if (!own_means) planned.seen = planned.fitted;
  if (!plan.row_wise) {
    planned.fit = thermfit::fit(plan.method, batches, plan.options);
  } else {
    const Observations<Scalar> all = merged(rows);
    const MatrixX<Scalar> chosen = all.temperatures(Eigen::all, points);
    planned.fit = thermfit::fit(plan.method, chosen, all.errors, plan.options);
    const Index taken = planned.fit.rows - planned.fitted.rows();  // by own means
    if (taken > 0) {
      planned.fit.degrees_of_freedom -= static_cast<Scalar>(taken);
      planned.fit.residual_deviation_um *=
          std::sqrt(static_cast<Scalar>(planned.fit.rows - 1) / static_cast<Scalar>(planned.fitted.rows() - 1));
    }
  }
  if (own_means) count_from_zero(planned.fit, planned.seen);
  return planned;
}

/// How far the whole model may be from the substitute while no sensor is lost: d' C d of the differences d of their
/// coefficients, C the covariance of the training temperatures.
template <typename Scalar>
Vector agreement(const TrainedModel& trained, const SubstituteModel& substitute, const Moments<Scalar>& moments) {
  const MatrixX<Scalar> covariance =
      moments.temperature_products() / static_cast<Scalar>(std::max<Index>(1, moments.rows() - 1));
  const Vector noise = trained.model.coefficients.row(substitute.lost).transpose().cwiseAbs() *
                       trained.envelope.scatter_K(substitute.lost);
  Vector result(trained.model.errors());
  for (Index j = 0; j < result.size(); ++j) {
    const Vector difference = trained.model.coefficients.col(j) - substitute.model.coefficients.col(j);
    const VectorX<Scalar> d = difference.template cast<Scalar>();
    result(j) = 4 * std::sqrt(std::max(0., static_cast<double>(d.dot(covariance * d)))) + noise(j);
  }
  return result;
}

}  // namespace detail

/// One model of all batches of a campaign, complete with training domain, substitutes for lost sensors, sensor
/// envelope and provenance; computed in Scalar, kept in double. Batches must agree in their channels. Throws Error as
/// the fit does, naming nothing but the data. Allocates.
template <typename Scalar = double>
TrainedModel train(const Campaign& campaign, const TrainingPlan& plan = {}) {
  if (campaign.empty()) throw Error("train", "no batch", "1 or more");
  const Batch& first = campaign.front();
  std::vector<Index> points = plan.points;
  for (Index p = 0; plan.points.empty() && p < first.temperatures.count(); ++p) points.push_back(p);
  const detail::PlannedFit<Scalar> fitted = detail::fit_plan<Scalar>(campaign, plan, points);
  TrainedModel trained = trained_model(fitted.fit, fitted.seen);
  trained.method = name(plan.method);
  trained.selection = plan.selection;
  trained.reference = plan.reference;
  trained.error_reference = plan.error_reference;
  for (const Index point : points) {
    trained.temperatures.push_back(first.temperatures.names[static_cast<std::size_t>(point)]);
  }
  trained.errors = first.errors.names;
  trained.envelope = sensor_envelope<Scalar>(campaign, trained.temperatures);
  const FitOptions same = settled(plan.options, fitted.fit);
  trained.substitutes =
      substitute_models(fitted.fitted, [&](const Moments<Scalar>& m) { return fit(plan.method, m, same); });
  for (SubstituteModel& substitute : trained.substitutes)
    substitute.agreement_um = detail::agreement(trained, substitute, fitted.seen);
  for (const Batch& batch : campaign) trained.batches.push_back({batch.name, batch.rows(), batch.digest});
  return trained;
}

THERMFIT_COMPILED_TEMPLATE(TrainedModel train<double>(const Campaign&, const TrainingPlan&));

}  // namespace thermfit
