#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/fit/impl/spectrum.hpp"
#include "thermfit/fit/left_out.hpp"

namespace thermfit::detail {

/// Whether to take one more latent variable, for PLS and PCR alike.
struct Stop {
  ComponentRule rule;
  template <typename Scalar>
  bool enough(const VectorX<Scalar>& explained, Index taken) const {
    return rule.kind == ComponentRule::Kind::explained && taken > 0 && explained(taken - 1) > rule.enough;
  }
  template <typename Scalar>
  bool too_little(Scalar gain, Index taken) const {
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
template <typename Scalar>
Scalar sign_of_largest(const VectorX<Scalar>& weights) {
  const Scalar alike = 1 - std::max(Scalar(1e-9), 16 * std::numeric_limits<Scalar>::epsilon());
  const Scalar largest = weights.cwiseAbs().maxCoeff();
  for (const Scalar weight : weights) {
    if (std::abs(weight) >= alike * largest) return weight < 0 ? -1 : 1;
  }
  return 1;
}

template <typename Scalar>
struct ScoredLatentVariables : LatentVariables<Scalar> {
  VectorX<Scalar> score_variance;  // per component, divisor rows - 1
};

template <typename Scalar>
MatrixX<Scalar> coefficients(const ScoredLatentVariables<Scalar>& latent, Index components) {
  return latent.rotations.leftCols(components) * latent.error_loadings.leftCols(components).transpose();
}

/// Variable importance in projection (Wold, Johansson, Cocchi 1993): per point
/// `sqrt(points sum_a SS_a (w_a / |w_a|)^2 / sum_a SS_a)`, SS_a the error variance component a explains.
template <typename Scalar>
VectorX<Scalar> vip(const ScoredLatentVariables<Scalar>& latent) {
  const VectorX<Scalar> explained =
      latent.score_variance.cwiseProduct(latent.error_loadings.colwise().squaredNorm().transpose());
  if (!(explained.sum() > 0)) return VectorX<Scalar>::Zero(latent.weights.rows());
  const Scalar points = static_cast<Scalar>(latent.weights.rows());
  return (latent.weights.cwiseAbs2() * explained * (points / explained.sum())).cwiseSqrt();
}

/// Cumulative explained shares from score variances and loadings, then VIP.
template <typename Scalar>
void complete(ScoredLatentVariables<Scalar>& latent, Scalar temperature_variance, Scalar error_variance) {
  const Index components = latent.score_variance.size();
  latent.explained_temperature_variance.resize(components);
  latent.explained_error_variance.resize(components);
  Scalar x = 0, y = 0;
  for (Index a = 0; a < components; ++a) {
    x += latent.score_variance(a) * latent.loadings.col(a).squaredNorm();
    y += latent.score_variance(a) * latent.error_loadings.col(a).squaredNorm();
    latent.explained_temperature_variance(a) = temperature_variance > 0 ? x / temperature_variance : 0;
    latent.explained_error_variance(a) = error_variance > 0 ? y / error_variance : 0;
  }
  latent.vip = vip(latent);
}

/// One fit, from moments or rows; `extract(data, rule)` gives the latent variables.
template <class Standardised, class Extract, typename Scalar = typename Standardised::Scalar>
LinearFit<Scalar> fit_latent(const Standardised& data, const ComponentRule& rule, Extract&& extract) {
  if (rule.kind == ComponentRule::Kind::leave_one_batch_out) {
    throw Error("components", "a choice by leaving batches out, with one set of rows", "several batches",
                "give a number of components, or the moments of each batch");
  }
  if (rule.kind == ComponentRule::Kind::fixed && rule.count < 1) {
    throw Error("components", std::to_string(rule.count), "1 or more");
  }
  ScoredLatentVariables<Scalar> latent = extract(data, rule);
  const Index components = latent.score_variance.size();
  LinearFit<Scalar> fit =
      linear_fit(data, coefficients(latent, components), spectrum(data), static_cast<Scalar>(components));
  fit.components = components;
  fit.score_variance = std::move(latent.score_variance);
  fit.latent = std::move(latent);
  return fit;
}

/// Models with 1, 2, … components; the mean alone where not even one component can be taken.
template <typename Scalar, class Extract>
std::vector<LinearModel<Scalar>> latent_path(const Moments<Scalar>& moments, const FitOptions& options,
                                             Extract&& extract) {
  const StandardisedMoments<Scalar> data(moments, options.scaling);
  const ScoredLatentVariables<Scalar> latent =
      extract(data, ComponentRule::leave_one_batch_out(options.components.count));
  std::vector<LinearModel<Scalar>> models;
  for (Index a = 1; a <= latent.score_variance.size(); ++a) {
    models.push_back(data.channels.undo(coefficients(latent, a)));
  }
  if (models.empty()) models.push_back(data.channels.undo(MatrixX<Scalar>::Zero(data.xx.rows(), data.xy.cols())));
  return models;
}

/// One fit over several batches, choosing the number of components by them where the options say so.
template <typename Scalar, class Extract>
LinearFit<Scalar> fit_latent(const std::vector<Moments<Scalar>>& batches, const FitOptions& options,
                             Extract&& extract) {
  ComponentRule rule = options.components;
  if (rule.kind == ComponentRule::Kind::leave_one_batch_out) {
    Index best = 0;
    left_out_error(batches, [&](const Moments<Scalar>& others) {
      return latent_path(others, options, extract);
    }).minCoeff(&best);
    rule = ComponentRule::fixed(best + 1);
  }
  return fit_latent(StandardisedMoments<Scalar>(merged(batches), options.scaling), rule, extract);
}

}  // namespace thermfit::detail
