#pragma once

#include "thermfit/fit/latent_path.hpp"

namespace thermfit {

namespace detail {

/// PLS state on moments: a component is taken by deflating covariances (kernel algorithm, de Jong and ter Braak,
/// Journal of Chemometrics 8, 1994).
struct PlsOnMoments {
  static constexpr bool squared = true;
  Matrix xx, xy;
  explicit PlsOnMoments(const StandardisedMoments& data)
      : xx(data.xx), xy(data.xy), total(xx.trace()), error_total(data.yy.sum()) {}
  const Matrix& covariance() const { return xy; }
  double variance(const Vector& weights) { return weights.dot(loading = xx * weights); }
  void deflate(const Vector& p, const Vector& q, double variance) {
    xx.noalias() -= (variance * p) * p.transpose();
    xy.noalias() -= (variance * p) * q.transpose();
  }
  Vector loading;  // not yet divided by the variance
  double total, error_total;
};

/// PLS state on rows: NIPALS (Wold, Martens, Wold 1983), both blocks deflated.
struct PlsOnRows {
  static constexpr bool squared = false;
  Matrix x, y, xy;
  explicit PlsOnRows(const StandardisedRows& data)
      : x(data.x), y(data.y), total(x.squaredNorm()), error_total(y.squaredNorm()) {}
  const Matrix& covariance() { return xy = x.transpose() * y; }
  double variance(const Vector& weights) {
    score = x * weights;
    loading = x.transpose() * score;
    return score.squaredNorm();
  }
  void deflate(const Vector& p, const Vector& q, double) {
    x.noalias() -= score * p.transpose();
    y.noalias() -= score * q.transpose();
  }
  Vector score, loading;
  double total, error_total;
};

/// Latent variables until the rule, or the rank of the data, says stop.
template <class State>
ScoredLatentVariables extract_pls(State state, const ComponentRule& rule) {
  const Index points = state.covariance().rows(), responses = state.covariance().cols();
  const double tolerance = rank_tolerance(points);
  const double least_variance = (State::squared ? tolerance : tolerance * tolerance) * state.total;
  const double least_covariance = tolerance * state.covariance().norm();
  const Stop stop{rule};
  const Index most = stop.most(points);
  ScoredLatentVariables found;
  found.weights = found.loadings = found.rotations = Matrix(points, most);
  found.error_loadings = Matrix(responses, most);
  found.score_variance = Vector(most);
  Vector explained(most);
  Index taken = 0;
  for (; taken < most && !stop.enough(explained, taken); ++taken) {
    const Matrix& covariance = state.covariance();
    if (!(covariance.norm() > least_covariance)) break;
    Vector weights =
        responses == 1
            ? Vector(covariance.col(0).normalized())
            : Vector(Eigen::JacobiSVD<Matrix>(covariance, Eigen::ComputeThinU | Eigen::ComputeThinV).matrixU().col(0));
    weights *= sign_of_largest(weights);
    const Vector error_covariance = covariance.transpose() * weights;
    const double variance = state.variance(weights);
    if (!(variance > least_variance)) break;
    const Vector p = state.loading / variance, q = error_covariance / variance;
    const double gain = variance * p.squaredNorm() / state.total;
    if (stop.too_little(gain, taken)) break;
    const double condition = std::sqrt(state.total / variance);
    if (State::squared && condition > moments_condition_limit) {
      if (stop.refuses()) Spectrum::refuse(condition);
      break;
    }
    explained(taken) = gain + (taken > 0 ? explained(taken - 1) : 0);
    found.weights.col(taken) = weights;
    found.loadings.col(taken) = p;
    found.error_loadings.col(taken) = q;
    found.score_variance(taken) = variance;
    found.rotations.col(taken) = weights;
    for (Index a = 0; a < taken; ++a) {
      found.rotations.col(taken) -= found.loadings.col(a).dot(weights) * found.rotations.col(a);
    }
    state.deflate(p, q, variance);
  }
  found.weights.conservativeResize(points, taken);
  found.loadings.conservativeResize(points, taken);
  found.rotations.conservativeResize(points, taken);
  found.error_loadings.conservativeResize(responses, taken);
  found.score_variance.conservativeResize(taken);
  complete(found, state.total, state.error_total);
  return found;
}

struct ExtractPls {
  ScoredLatentVariables operator()(const StandardisedMoments& data, const ComponentRule& rule) const {
    return extract_pls(PlsOnMoments(data), rule);
  }
  ScoredLatentVariables operator()(const StandardisedRows& data, const ComponentRule& rule) const {
    return extract_pls(PlsOnRows(data), rule);
  }
};

}  // namespace detail

/// Partial least squares of all errors together (PLS1 for one, PLS2 for several) from moments.
///
/// Component k has weights w_k, the leading left singular vector of X'Y after deflation, score t_k = X w_k, loadings
/// p_k = X't_k / t't and q_k = Y't_k / t't; rotations R = W (P'W)^-1 give scores from standardised temperatures, and
/// standardised coefficients are R Q' (Wei et al., eq. (5)–(9); the largest weight is positive). Components stop by
/// `options.components`, and before that at the numerical rank, so that duplicated or constant points do no harm: the
/// number used is in the result. Errors: fewer than two rows; a fixed number of components whose variance is past
/// moments_condition_limit; a choice by leaving batches out, which needs several.
inline LinearFit fit_pls(const Moments& moments, const FitOptions& options = {}) {
  return detail::fit_latent(StandardisedMoments(moments, options.scaling), options.components, detail::ExtractPls{});
}

/// The same row-wise (NIPALS): for condition numbers up to about 1e13. Temperatures rows x points, errors rows x
/// responses, um.
inline LinearFit fit_pls(const Matrix& temperatures, const Matrix& errors, const FitOptions& options = {}) {
  return detail::fit_latent(StandardisedRows(temperatures, errors, options.scaling), options.components,
                            detail::ExtractPls{});
}

/// One fit over several batches, from their merged moments; with ComponentRule::leave_one_batch_out the number of
/// components has the least error on batches left out (left_out_error), the smaller on a tie.
inline LinearFit fit_pls(const std::vector<Moments>& batches, const FitOptions& options = {}) {
  return detail::fit_latent(batches, options, detail::ExtractPls{});
}

/// Models with 1, 2, … components from one extraction, up to the rank, or to `options.components.count` if not 0.
inline std::vector<LinearModel<>> pls_path(const Moments& moments, const FitOptions& options = {}) {
  return detail::latent_path(moments, options, detail::ExtractPls{});
}

}  // namespace thermfit
