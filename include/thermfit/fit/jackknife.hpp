#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "thermfit/fit/linear_fit.hpp"
#include "thermfit/statistics/quantiles.hpp"

namespace thermfit {

/// How far coefficients move when a batch is missing: their uncertainty between batches, which the residuals within
/// a batch do not show.
template <typename Scalar = double>
struct CoefficientSpread {
  LinearModel<Scalar> model;            ///< of all batches
  MatrixX<Scalar> deviation;            ///< points x responses, um/K: jackknife standard errors
  VectorX<Scalar> intercept_deviation;  ///< per response, um
  Index degrees_of_freedom = 0;         ///< batches - 1

  /// Half width of the two-sided interval of every coefficient at `confidence`, e.g. .95: Student's t times deviation.
  MatrixX<Scalar> half_width(double confidence) const {
    return static_cast<Scalar>(t_quantile((1 + confidence) / 2, static_cast<double>(degrees_of_freedom))) * deviation;
  }
  /// Two-sided p-value of each coefficient being zero; 1 where it is zero in every model.
  MatrixX<Scalar> p_values() const {
    return deviation.binaryExpr(model.coefficients, [&](Scalar sd, Scalar b) {
      if (!(sd > 0)) return Scalar(b == 0 ? 1 : 0);
      return static_cast<Scalar>(t_two_sided(static_cast<double>(b / sd), static_cast<double>(degrees_of_freedom)));
    });
  }
};

/// Jackknife over batches (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, ch. 11):
/// `deviation^2 = (K - 1) / K sum_i (b_(i) - mean b_(.))^2`, b_(i) fitted without batch i. `fitter` is called with
/// Moments<Scalar> and returns a LinearFit or LinearModel; a batch may be a single row. Fewer than two batches: Error.
/// Allocates.
template <typename Scalar, class Fitter>
CoefficientSpread<Scalar> jackknife(const std::vector<Moments<Scalar>>& batches, const Fitter& fitter) {
  if (batches.size() < 2) throw Error("batches", std::to_string(batches.size()), "2 or more to leave one out");
  CoefficientSpread<Scalar> result;
  result.model = model_of(fitter(merged(batches)));
  std::vector<LinearModel<Scalar>> models;
  for (const Moments<Scalar>& others : leave_one_out(batches)) models.push_back(model_of(fitter(others)));
  const Scalar count = static_cast<Scalar>(models.size());
  LinearModel<Scalar> mean{MatrixX<Scalar>::Zero(result.model.sensors(), result.model.errors()),
                           VectorX<Scalar>::Zero(result.model.errors())};
  for (const LinearModel<Scalar>& model : models) {
    mean.coefficients += model.coefficients / count;
    mean.intercept += model.intercept / count;
  }
  MatrixX<Scalar> square = MatrixX<Scalar>::Zero(result.model.sensors(), result.model.errors());
  VectorX<Scalar> intercept_square = VectorX<Scalar>::Zero(result.model.errors());
  for (const LinearModel<Scalar>& model : models) {
    square += (model.coefficients - mean.coefficients).cwiseAbs2();
    intercept_square += (model.intercept - mean.intercept).cwiseAbs2();
  }
  result.deviation = (square * ((count - 1) / count)).cwiseSqrt();
  result.intercept_deviation = (intercept_square * ((count - 1) / count)).cwiseSqrt();
  result.degrees_of_freedom = static_cast<Index>(models.size()) - 1;
  return result;
}

}  // namespace thermfit
