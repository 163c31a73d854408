#pragma once

#include <cmath>
#include <vector>

#include "thermfit/fit/impl/latent_path.hpp"
#include "thermfit/fit/impl/singular_values.hpp"

namespace thermfit {

namespace detail {

/// PLS state on moments: a component is taken by deflating covariances (kernel algorithm, de Jong and ter Braak,
/// Journal of Chemometrics 8, 1994).
template <typename Number>
struct PlsOnMoments {
  using Scalar = Number;
  static constexpr bool squared = true;
  MatrixX<Scalar> xx, xy;
  explicit PlsOnMoments(const StandardisedMoments<Scalar>& data)
      : xx(data.xx), xy(data.xy), total(xx.trace()), error_total(data.yy.sum()) {}
  const MatrixX<Scalar>& covariance() const { return xy; }
  Scalar variance(const VectorX<Scalar>& weights) { return weights.dot(loading = xx * weights); }
  void deflate(const VectorX<Scalar>& p, const VectorX<Scalar>& q, Scalar variance) {
    xx.noalias() -= (variance * p) * p.transpose();
    xy.noalias() -= (variance * p) * q.transpose();
  }
  VectorX<Scalar> loading;  // not yet divided by the variance
  Scalar total, error_total;
};

/// PLS state on rows: NIPALS (Wold, Martens, Wold 1983), both blocks deflated.
template <typename Number>
struct PlsOnRows {
  using Scalar = Number;
  static constexpr bool squared = false;
  MatrixX<Scalar> x, y, xy;
  explicit PlsOnRows(const StandardisedRows<Scalar>& data)
      : x(data.x), y(data.y), total(x.squaredNorm()), error_total(y.squaredNorm()) {}
  const MatrixX<Scalar>& covariance() { return xy = x.transpose() * y; }
  Scalar variance(const VectorX<Scalar>& weights) {
    score = x * weights;
    loading = x.transpose() * score;
    return score.squaredNorm();
  }
  void deflate(const VectorX<Scalar>& p, const VectorX<Scalar>& q, Scalar) {
    x.noalias() -= score * p.transpose();
    y.noalias() -= score * q.transpose();
  }
  VectorX<Scalar> score, loading;
  Scalar total, error_total;
};

/// Unit weights of the next latent variable: the leading left singular vector of `covariance` (points x responses).
template <typename Scalar>
VectorX<Scalar> pls_weights(const MatrixX<Scalar>& covariance) {
  VectorX<Scalar> weights = covariance.cols() == 1 ? VectorX<Scalar>(covariance.col(0).normalized())
                                                   : VectorX<Scalar>(SingularValues<Scalar>(covariance).u.col(0));
  weights *= sign_of_largest(weights);
  return weights;
}

/// Latent variables until the rule, or the rank of the data, says stop.
template <class State, typename Scalar = typename State::Scalar>
ScoredLatentVariables<Scalar> extract_pls(State state, const ComponentRule& rule) {
  const Index points = state.covariance().rows(), responses = state.covariance().cols();
  const Scalar tolerance = rank_tolerance<Scalar>(points);
  const Scalar least_variance = (State::squared ? tolerance : tolerance * tolerance) * state.total;
  const Scalar least_covariance = tolerance * state.covariance().norm();
  const Stop stop{rule};
  const Index most = stop.most(points);
  ScoredLatentVariables<Scalar> found;
  found.weights = found.loadings = found.rotations = MatrixX<Scalar>(points, most);
  found.error_loadings = MatrixX<Scalar>(responses, most);
  found.score_variance = VectorX<Scalar>(most);
  VectorX<Scalar> explained(most);
  Index taken = 0;
  for (; taken < most && !stop.enough(explained, taken); ++taken) {
    const MatrixX<Scalar>& covariance = state.covariance();
    if (!(covariance.norm() > least_covariance)) break;
    const VectorX<Scalar> weights = pls_weights(covariance);
    const VectorX<Scalar> error_covariance = covariance.transpose() * weights;
    const Scalar variance = state.variance(weights);
    if (!(variance > least_variance)) break;
    const VectorX<Scalar> p = state.loading / variance, q = error_covariance / variance;
    const Scalar gain = variance * p.squaredNorm() / state.total;
    if (stop.too_little(gain, taken)) break;
    const Scalar condition = std::sqrt(state.total / variance);
    if (State::squared && condition > moments_condition_limit<Scalar>) {
      if (stop.refuses()) Spectrum<Scalar>::refuse(condition);
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
  template <typename Scalar>
  ScoredLatentVariables<Scalar> operator()(const StandardisedMoments<Scalar>& data, const ComponentRule& rule) const {
    return extract_pls(PlsOnMoments<Scalar>(data), rule);
  }
  template <typename Scalar>
  ScoredLatentVariables<Scalar> operator()(const StandardisedRows<Scalar>& data, const ComponentRule& rule) const {
    return extract_pls(PlsOnRows<Scalar>(data), rule);
  }
};

template <typename Scalar>
LinearFit<Scalar> pls_of_rows(const MatrixView<Scalar>& temperatures, const MatrixView<Scalar>& errors,
                              const FitOptions& options) {
  return fit_latent(StandardisedRows<Scalar>(temperatures, errors, options.scaling), options.components, ExtractPls{});
}

}  // namespace detail

/// Partial least squares of all errors together (PLS1 for one, PLS2 for several) from moments.
///
/// Component k has weights w_k, the leading left singular vector of X'Y after deflation, score t_k = X w_k, loadings
/// p_k = X't_k / t't and q_k = Y't_k / t't; rotations R = W (P'W)^-1 give scores from standardised temperatures, and
/// standardised coefficients are R Q' (Wei et al., eq. (5)–(9); the largest weight is positive). Components stop by
/// `options.components`, and before that at the numerical rank, so that duplicated or constant points do no harm: the
/// number used is in the result. Errors: fewer than two rows; a fixed number of components whose variance is past
/// moments_condition_limit; a choice by leaving batches out, which needs several. Allocates.
template <typename Scalar>
LinearFit<Scalar> fit_pls(const Moments<Scalar>& moments, const FitOptions& options = {}) {
  return detail::fit_latent(detail::StandardisedMoments<Scalar>(moments, options.scaling), options.components,
                            detail::ExtractPls{});
}

/// The same row-wise (NIPALS): for condition numbers up to about 1e13 in double, 1e5 in float; a component whose
/// covariance with the errors is rounding is not taken. Temperatures rows x
/// points, errors rows x responses, um. Allocates copies.
template <typename Temperatures, typename Errors, typename Scalar = typename Temperatures::Scalar>
LinearFit<Scalar> fit_pls(const Eigen::MatrixBase<Temperatures>& temperatures, const Eigen::MatrixBase<Errors>& errors,
                          const FitOptions& options = {}) {
  return detail::pls_of_rows<Scalar>(temperatures, errors, options);
}

/// One fit over several batches, from their merged moments; with ComponentRule::leave_one_batch_out the number of
/// components has the least error on batches left out (left_out_error), the smaller on a tie.
template <typename Scalar>
LinearFit<Scalar> fit_pls(const std::vector<Moments<Scalar>>& batches, const FitOptions& options = {}) {
  return detail::fit_latent(batches, options, detail::ExtractPls{});
}

/// Models with 1, 2, … components from one extraction, up to the rank, or to `options.components.count` if not 0.
template <typename Scalar>
std::vector<LinearModel<Scalar>> pls_path(const Moments<Scalar>& moments, const FitOptions& options = {}) {
  return detail::latent_path(moments, options, detail::ExtractPls{});
}

THERMFIT_COMPILED_TEMPLATE(LinearFit<double> fit_pls<double>(const Moments<double>&, const FitOptions&));
THERMFIT_COMPILED_TEMPLATE(LinearFit<double> fit_pls<double>(const std::vector<Moments<double>>&, const FitOptions&));
THERMFIT_COMPILED_TEMPLATE(std::vector<LinearModel<double>> pls_path<double>(const Moments<double>&,
                                                                             const FitOptions&));
namespace detail {
THERMFIT_COMPILED_TEMPLATE(LinearFit<double> pls_of_rows<double>(const MatrixView<double>&, const MatrixView<double>&,
                                                                 const FitOptions&));
}  // namespace detail

}  // namespace thermfit
