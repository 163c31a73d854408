#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "thermfit/fit/fit.hpp"
#include "thermfit/fit/training_domain.hpp"
#include "thermfit/model/trained_model.hpp"
#include "thermfit/moments/observations.hpp"
#include "thermfit/version.hpp"

namespace thermfit {

/// What to train: the answers of a user who has chosen method and points.
struct TrainingPlan {
  Method method = Method::pls;
  FitOptions options;
  std::vector<Index> points;        ///< temperature columns, in coefficient order; empty: all
  std::string selection = "given";  ///< how they were chosen, for the record
  TemperatureReference reference = TemperatureReference::rise;
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
/// None for a single sensor.
template <class Fitter>
std::vector<SubstituteModel> substitute_models(const Moments& moments, const Fitter& fitter) {
  std::vector<SubstituteModel> substitutes;
  for (Index lost = 0; moments.temperatures() > 1 && lost < moments.temperatures(); ++lost) {
    std::vector<Index> others;
    for (Index p = 0; p < moments.temperatures(); ++p) {
      if (p != lost) others.push_back(p);
    }
    const Moments seen = moments.subset(others);
    SubstituteModel substitute;
    substitute.lost = lost;
    const LinearModel<> model = model_of(fitter(seen));
    substitute.residual_deviation_um = S(residuals(model, seen));
    substitute.model.intercept = model.intercept;
    substitute.model.coefficients = Matrix::Zero(moments.temperatures(), moments.errors());
    substitute.model.coefficients(others, Eigen::all) = model.coefficients;
    substitutes.push_back(std::move(substitute));
  }
  return substitutes;
}

/// The parts of a trained model that follow from a fit and the moments it was made of; names, batches and settings
/// are left to the caller.
inline TrainedModel trained_model(const LinearFit& fit, const Moments& moments) {
  TrainedModel trained;
  trained.components = fit.components;
  trained.ridge_lambda = fit.ridge_lambda;
  trained.model = fit.model;
  trained.standardised_coefficients = fit.standardised_coefficients;
  trained.temperature_mean = fit.channels.temperature_mean;
  trained.temperature_scale = fit.channels.temperature_scale;
  trained.error_mean = fit.channels.error_mean;
  trained.error_scale = fit.channels.error_scale;
  trained.latent = fit.latent;
  trained.residual_deviation_um = fit.residual_deviation_um;
  trained.degrees_of_freedom = std::max<Index>(0, std::lround(fit.degrees_of_freedom));
  trained.condition_number = fit.condition_number;
  trained.domain = training_domain(fit, moments);
  trained.tool_version = THERMFIT_VERSION;
  return trained;
}

/// One model of all batches of a campaign, complete with training domain, substitutes for lost sensors, sensor
/// envelope and provenance. Batches must agree in their channels. Throws Error as the fit does, naming nothing but the
/// data. Allocates.
inline TrainedModel train(const Campaign& campaign, const TrainingPlan& plan = {}) {
  if (campaign.empty()) throw Error("train", "no batch", "1 or more");
  const Batch& first = campaign.front();
  std::vector<Index> points = plan.points;
  for (Index p = 0; plan.points.empty() && p < first.temperatures.count(); ++p) points.push_back(p);
  std::vector<Moments> batches;
  std::vector<Observations> rows;
  for (const Batch& batch : campaign) {
    if (batch.temperatures.names != first.temperatures.names || batch.errors.names != first.errors.names) {
      throw Error("batch " + batch.name, "other channels than batch " + first.name,
                  "the same temperatures and errors in every batch");
    }
    Observations seen = observe(batch, plan.reference);
    batches.push_back(seen.moments.subset(points));
    if (plan.row_wise) rows.push_back(std::move(seen));
  }
  LinearFit fitted;
  if (plan.row_wise) {
    const Observations all = merged(rows);
    fitted = fit(plan.method, all.temperatures(Eigen::all, points), all.errors, plan.options);
  } else {
    fitted = fit(plan.method, batches, plan.options);
  }
  const Moments all = merged(batches);
  TrainedModel trained = trained_model(fitted, all);
  trained.method = name(plan.method);
  trained.selection = plan.selection;
  trained.reference = plan.reference;
  for (const Index point : points) {
    trained.temperatures.push_back(first.temperatures.names[static_cast<std::size_t>(point)]);
  }
  trained.errors = first.errors.names;
  trained.envelope = sensor_envelope(campaign, trained.temperatures);
  const FitOptions same = settled(plan.options, fitted);
  trained.substitutes = substitute_models(all, [&](const Moments& m) { return fit(plan.method, m, same); });
  for (const Batch& batch : campaign) trained.batches.push_back({batch.name, batch.rows(), batch.digest});
  return trained;
}

}  // namespace thermfit
