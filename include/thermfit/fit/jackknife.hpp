#pragma once

#include <cmath>
#include <vector>

#include "thermfit/fit/linear_fit.hpp"
#include "thermfit/statistics/quantiles.hpp"

namespace thermfit {

/// How far coefficients move when a batch is missing: their uncertainty between batches, which the residuals within
/// a batch do not show.
struct CoefficientSpread {
  LinearModel<> model;           ///< of all batches
  Matrix deviation;              ///< points x responses, um/K: jackknife standard errors
  Vector intercept_deviation;    ///< per response, um
  Index degrees_of_freedom = 0;  ///< batches - 1

  /// Half width of the two-sided interval of every coefficient at `confidence`, e.g. .95: Student's t times deviation.
  Matrix half_width(double confidence) const {
    return t_quantile((1 + confidence) / 2, static_cast<double>(degrees_of_freedom)) * deviation;
  }
  /// Two-sided p-value of each coefficient being zero; 1 where it is zero in every model.
  Matrix p_values() const {
    return deviation.binaryExpr(model.coefficients, [&](double sd, double b) {
      if (!(sd > 0)) return b == 0 ? 1.0 : 0.0;
      return t_two_sided(b / sd, static_cast<double>(degrees_of_freedom));
    });
  }
};

/// Jackknife over batches (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, ch. 11):
/// `deviation^2 = (K - 1) / K sum_i (b_(i) - mean b_(.))^2`, b_(i) fitted without batch i. `fitter` is called with
/// Moments and returns a LinearFit or LinearModel<>; a batch may be a single row. Fewer than two batches: Error.
template <class Fitter>
CoefficientSpread jackknife(const std::vector<Moments>& batches, const Fitter& fitter) {
  if (batches.size() < 2) throw Error("batches", std::to_string(batches.size()), "2 or more to leave one out");
  CoefficientSpread result;
  result.model = model_of(fitter(merged(batches)));
  std::vector<LinearModel<>> models;
  for (const Moments& others : leave_one_out(batches)) models.push_back(model_of(fitter(others)));
  const double count = static_cast<double>(models.size());
  LinearModel<> mean{Matrix::Zero(result.model.sensors(), result.model.errors()), Vector::Zero(result.model.errors())};
  for (const LinearModel<>& model : models) {
    mean.coefficients += model.coefficients / count;
    mean.intercept += model.intercept / count;
  }
  Matrix square = Matrix::Zero(result.model.sensors(), result.model.errors());
  Vector intercept_square = Vector::Zero(result.model.errors());
  for (const LinearModel<>& model : models) {
    square += (model.coefficients - mean.coefficients).cwiseAbs2();
    intercept_square += (model.intercept - mean.intercept).cwiseAbs2();
  }
  result.deviation = (square * ((count - 1) / count)).cwiseSqrt();
  result.intercept_deviation = (intercept_square * ((count - 1) / count)).cwiseSqrt();
  result.degrees_of_freedom = static_cast<Index>(models.size()) - 1;
  return result;
}

}  // namespace thermfit
