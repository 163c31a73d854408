#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/moments/observations.hpp"

namespace thermfit {

/// Correlation coefficients of eq. (1), points x responses, sign kept; NaN where there is none: a channel is constant,
/// or two rows or fewer say nothing, since two always agree. Allocates the result.
template <typename Scalar>
MatrixX<Scalar> correlations(const Moments<Scalar>& moments) {
  MatrixX<Scalar> r = MatrixX<Scalar>::Constant(moments.temperatures(), moments.errors(), Scalar(std::nan("")));
  if (moments.rows() < 3) return r;
  for (Index p = 0; p < r.rows(); ++p) {
    for (Index e = 0; e < r.cols(); ++e) {
      if (moments.constant(p) || moments.constant(moments.temperatures() + e)) continue;
      const Scalar scale = std::sqrt(moments.temperature_products()(p, p)) * std::sqrt(moments.error_products()(e, e));
      if (scale > 0) r(p, e) = std::clamp(moments.cross_products()(p, e) / scale, Scalar(-1), Scalar(1));
    }
  }
  return r;
}

/// One temperature point in a ranking.
template <typename Scalar = double>
struct RankedPoint {
  Index point = 0;        ///< column of the temperatures
  Scalar score = 0;       ///< what it is ranked by, larger is better
  bool constant = false;  ///< does not vary: carries no information, always last
};

/// Points by the size of their correlation with error `response`, or, if that is negative, by the root mean square of
/// their correlations with all errors; one that there is not counts 0. Constant points come last; equal ones keep the
/// order of the columns. A response there is not: Error. Allocates.
template <typename Scalar>
std::vector<RankedPoint<Scalar>> correlation_ranking(const Moments<Scalar>& moments, Index response = -1) {
  if (response >= moments.errors()) {
    throw Error("response", std::to_string(response), "0 to " + std::to_string(moments.errors() - 1));
  }
  MatrixX<Scalar> r = correlations(moments);
  r = r.array().isNaN().select(Scalar(0), r);
  std::vector<RankedPoint<Scalar>> ranking;
  for (Index p = 0; p < r.rows(); ++p) {
    const Scalar score = response >= 0   ? std::abs(r(p, response))
                         : r.cols() == 1 ? std::abs(r(p, 0))
                                         : r.row(p).norm() / std::sqrt(static_cast<Scalar>(r.cols()));
    ranking.push_back({p, score, moments.constant(p)});
  }
  std::stable_sort(ranking.begin(), ranking.end(), [](const RankedPoint<Scalar>& a, const RankedPoint<Scalar>& b) {
    return a.constant != b.constant ? b.constant : a.score > b.score;
  });
  return ranking;
}

/// The paper's rule, eq. (4): the k points with the largest correlation. See select/rule.hpp.
struct ByCorrelation {
  Index response = -1;  ///< error it looks at; negative: all

  /// The best `count` points of `batch`, or fewer where there are no more. Allocates.
  template <typename Scalar>
  std::vector<Index> operator()(const Observations<Scalar>& batch, Index count) const {
    std::vector<Index> points;
    for (const RankedPoint<Scalar>& ranked : correlation_ranking(batch.moments, response)) {
      if (static_cast<Index>(points.size()) < count) points.push_back(ranked.point);
    }
    return points;
  }
};

THERMFIT_COMPILED_TEMPLATE(std::vector<RankedPoint<double>> correlation_ranking<double>(const Moments<double>&, Index));

}  // namespace thermfit
