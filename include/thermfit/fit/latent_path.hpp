#pragma once

#include <cmath>

#include "thermfit/fit/left_out.hpp"
#include "thermfit/fit/spectrum.hpp"

namespace thermfit::detail {

/// Whether to take one more latent variable, for PLS and PCR alike.
struct Stop {
  ComponentRule rule;
  bool enough(const Vector& explained, Index taken) const {
    return rule.kind == ComponentRule::Kind::explained && taken > 0 && explained(taken - 1) > rule.enough;
  }
  bool too_little(double gain, Index taken) const {
    return rule.kind == ComponentRule::Kind::explained && taken > 0 && gain < rule.least_gain;
  }
  /// Only a number asked for outright is worth an error; otherwise fewer components are the answer.
  bool refuses() const { return rule.kind == ComponentRule::Kind::fixed; }
  Index most(Index available) const {
    if (rule.kind == ComponentRule::Kind::explained || rule.count == 0) return available;
    return std::min(available, rule.count);
  }
};

/// Sign by which the largest entry becomes positive; among equal ones (to rounding) the first decides.
inline double sign_of_largest(const Vector& weights) {
  const double largest = weights.cwiseAbs().maxCoeff();
  for (const double weight : weights) {
    if (std::abs(weight) >= (1 - 1e-9) * largest) return weight < 0 ? -1 : 1;
  }
  return 1;
}

struct ScoredLatentVariables : LatentVariables {
  Vector score_variance;  // per component, divisor rows - 1
};

inline Matrix coefficients(const ScoredLatentVariables& latent, Index components) {
  return latent.rotations.leftCols(components) * latent.error_loadings.leftCols(components).transpose();
}

/// Variable importance in projection (Wold, Johansson, Cocchi 1993): per point
/// `sqrt(points sum_a SS_a (w_a / |w_a|)^2 / sum_a SS_a)`, SS_a the error variance component a explains.
inline Vector vip(const ScoredLatentVariables& latent) {
  const Vector explained =
      latent.score_variance.cwiseProduct(latent.error_loadings.colwise().squaredNorm().transpose());
  if (!(explained.sum() > 0)) return Vector::Zero(latent.weights.rows());
  const double points = static_cast<double>(latent.weights.rows());
  return (latent.weights.cwiseAbs2() * explained * (points / explained.sum())).cwiseSqrt();
}

/// Cumulative explained shares from score variances and loadings, then VIP.
inline void complete(ScoredLatentVariables& latent, double temperature_variance, double error_variance) {
  const Index components = latent.score_variance.size();
  latent.explained_temperature_variance.resize(components);
  latent.explained_error_variance.resize(components);
  double x = 0, y = 0;
  for (Index a = 0; a < components; ++a) {
    x += latent.score_variance(a) * latent.loadings.col(a).squaredNorm();
    y += latent.score_variance(a) * latent.error_loadings.col(a).squaredNorm();
    latent.explained_temperature_variance(a) = temperature_variance > 0 ? x / temperature_variance : 0;
    latent.explained_error_variance(a) = error_variance > 0 ? y / error_variance : 0;
  }
  latent.vip = vip(latent);
}

/// One fit, from moments or rows; `extract(data, rule)` gives the latent variables.
template <class Standardised, class Extract>
LinearFit fit_latent(const Standardised& data, const ComponentRule& rule, Extract&& extract) {
  if (rule.kind == ComponentRule::Kind::leave_one_batch_out) {
    throw Error("components", "a choice by leaving batches out, with one set of rows", "several batches",
                "give a number of components, or the moments of each batch");
  }
  if (rule.kind == ComponentRule::Kind::fixed && rule.count < 1) {
    throw Error("components", std::to_string(rule.count), "1 or more");
  }
  ScoredLatentVariables latent = extract(data, rule);
  const Index components = latent.score_variance.size();
  LinearFit fit = linear_fit(data, coefficients(latent, components), spectrum(data), static_cast<double>(components));
  fit.components = components;
  fit.score_variance = std::move(latent.score_variance);
  fit.latent = std::move(latent);
  return fit;
}

/// Models with 1, 2, … components; the mean alone where not even one component can be taken.
template <class Extract>
std::vector<LinearModel<>> latent_path(const Moments& moments, const FitOptions& options, Extract&& extract) {
  const StandardisedMoments data(moments, options.scaling);
  const ScoredLatentVariables latent = extract(data, ComponentRule::leave_one_batch_out(options.components.count));
  std::vector<LinearModel<>> models;
  for (Index a = 1; a <= latent.score_variance.size(); ++a) {
    models.push_back(data.channels.undo(coefficients(latent, a)));
  }
  if (models.empty()) models.push_back(data.channels.undo(Matrix::Zero(data.xx.rows(), data.xy.cols())));
  return models;
}

/// One fit over several batches, choosing the number of components by them where the options say so.
template <class Extract>
LinearFit fit_latent(const std::vector<Moments>& batches, const FitOptions& options, Extract&& extract) {
  ComponentRule rule = options.components;
  if (rule.kind == ComponentRule::Kind::leave_one_batch_out) {
    Index best = 0;
    left_out_error(batches, [&](const Moments& others) {
      return latent_path(others, options, extract);
    }).minCoeff(&best);
    rule = ComponentRule::fixed(best + 1);
  }
  return fit_latent(StandardisedMoments(merged(batches), options.scaling), rule, extract);
}

}  // namespace thermfit::detail
