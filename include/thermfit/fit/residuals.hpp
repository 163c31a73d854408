#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/model/linear_model.hpp"
#include "thermfit/moments/moments.hpp"

namespace thermfit {

/// What a model leaves unexplained of one error over some rows: prediction minus measurement, um.
template <typename Scalar = double>
struct Residuals {
  Index rows = 0;             ///< how many there were
  Scalar mean = 0;            ///< bias, um
  Scalar centred_square = 0;  ///< sum of squared deviations from that mean, um^2

  /// About zero, not about the mean, um^2.
  Scalar sum_of_squares() const { return centred_square + static_cast<Scalar>(rows) * mean * mean; }

  /// Residual standard deviation of eq. (10): sqrt(sum (prediction - measurement)^2 / (n - 1)); needs two rows.
  Scalar S() const { return std::sqrt(sum_of_squares() / static_cast<Scalar>(rows - 1)); }
  /// Root mean square, divisor n.
  Scalar rmse() const { return std::sqrt(sum_of_squares() / static_cast<Scalar>(rows)); }
  /// Root mean square after the bias is taken off: what is left when the machine is zeroed once.
  Scalar rmse_without_bias() const { return std::sqrt(centred_square / static_cast<Scalar>(rows)); }

  /// Of two sets of rows together.
  void add(const Residuals& other) {
    if (other.rows == 0) return;
    const Scalar total = static_cast<Scalar>(rows + other.rows), step = other.mean - mean;
    const Scalar share = static_cast<Scalar>(other.rows) / total;
    centred_square += other.centred_square + static_cast<Scalar>(rows) * share * step * step;
    mean += share * step;
    rows += other.rows;
  }
};

/// Residuals of `model` per error on the rows that `moments` has seen: with a = (coefficients, -1) the squares are
/// the quadratic form a'Ma, no row is needed. A sum of squares below about 1e-15 of the products it is made of
/// is rounding; the result is never negative. Widths must agree, or Error. Allocates the result.
template <typename Scalar>
std::vector<Residuals<Scalar>> residuals(const LinearModel<Scalar>& model, const Moments<Scalar>& moments) {
  if (model.sensors() != moments.temperatures() || model.errors() != moments.errors()) {
    throw Error(
        "model", std::to_string(model.sensors()) + " sensors and " + std::to_string(model.errors()) + " errors",
        std::to_string(moments.temperatures()) + " and " + std::to_string(moments.errors()) + ", as in the data");
  }
  std::vector<Residuals<Scalar>> result;
  for (Index e = 0; e < model.errors(); ++e) {
    const auto b = model.coefficients.col(e);
    const Scalar square = b.dot(moments.temperature_products() * b - 2 * moments.cross_products().col(e)) +
                          moments.error_products()(e, e);
    const Scalar mean = b.dot(moments.temperature_mean()) + model.intercept(e) - moments.error_mean()(e);
    result.push_back({moments.rows(), mean, std::max(Scalar(0), square)});
  }
  return result;
}

/// The same from rows: temperatures rows x points, errors rows x responses. Allocates one matrix of that size.
template <typename Scalar, typename Temperatures, typename Errors>
std::vector<Residuals<Scalar>> residuals(const LinearModel<Scalar>& model,
                                         const Eigen::MatrixBase<Temperatures>& temperatures,
                                         const Eigen::MatrixBase<Errors>& errors) {
  const MatrixView<Scalar> rows = temperatures;
  const MatrixX<Scalar> difference = model.predict_rows(rows) - errors;
  std::vector<Residuals<Scalar>> result;
  for (Index e = 0; e < errors.cols(); ++e) {
    const Scalar mean = difference.rows() > 0 ? difference.col(e).mean() : 0;
    result.push_back({difference.rows(), mean, (difference.col(e).array() - mean).square().sum()});
  }
  return result;
}

/// S of eq. (10) per error, um.
template <typename Scalar>
VectorX<Scalar> S(const std::vector<Residuals<Scalar>>& per_error) {
  VectorX<Scalar> result(static_cast<Index>(per_error.size()));
  for (Index e = 0; e < result.size(); ++e) result(e) = per_error[static_cast<std::size_t>(e)].S();
  return result;
}

THERMFIT_COMPILED_TEMPLATE(std::vector<Residuals<double>> residuals<double>(const LinearModel<double>&,
                                                                            const Moments<double>&));

}  // namespace thermfit
