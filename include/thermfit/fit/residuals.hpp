#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/model/linear_model.hpp"
#include "thermfit/moments/moments.hpp"

namespace thermfit {

/// What a model leaves unexplained of one error over some rows: prediction minus measurement, um.
struct Residuals {
  Index rows = 0;
  double mean = 0;            ///< bias, um
  double centred_square = 0;  ///< sum of squared deviations from that mean, um^2

  double sum_of_squares() const { return centred_square + static_cast<double>(rows) * mean * mean; }

  /// Residual standard deviation of eq. (10): sqrt(sum (prediction - measurement)^2 / (n - 1)); needs two rows.
  double S() const { return std::sqrt(sum_of_squares() / static_cast<double>(rows - 1)); }
  /// Root mean square, divisor n.
  double rmse() const { return std::sqrt(sum_of_squares() / static_cast<double>(rows)); }
  /// Root mean square after the bias is taken off: what is left when the machine is zeroed once.
  double rmse_without_bias() const { return std::sqrt(centred_square / static_cast<double>(rows)); }

  /// Of two sets of rows together.
  void add(const Residuals& other) {
    if (other.rows == 0) return;
    const double total = static_cast<double>(rows + other.rows), step = other.mean - mean;
    const double share = static_cast<double>(other.rows) / total;
    centred_square += other.centred_square + static_cast<double>(rows) * share * step * step;
    mean += share * step;
    rows += other.rows;
  }
};

/// Residuals of `model` per error on the rows that `moments` has seen: with a = (coefficients, -1) the squares are
/// the quadratic form a'Ma, no row is needed. A sum of squares below about 1e-15 of the products it is made of
/// is rounding; the result is never negative. Widths must agree, or Error.
inline std::vector<Residuals> residuals(const LinearModel<>& model, const Moments& moments) {
  if (model.sensors() != moments.temperatures() || model.errors() != moments.errors()) {
    throw Error(
        "model", std::to_string(model.sensors()) + " sensors and " + std::to_string(model.errors()) + " errors",
        std::to_string(moments.temperatures()) + " and " + std::to_string(moments.errors()) + ", as in the data");
  }
  std::vector<Residuals> result;
  for (Index e = 0; e < model.errors(); ++e) {
    const auto b = model.coefficients.col(e);
    const double square = b.dot(moments.temperature_products() * b - 2 * moments.cross_products().col(e)) +
                          moments.error_products()(e, e);
    const double mean = b.dot(moments.temperature_mean()) + model.intercept(e) - moments.error_mean()(e);
    result.push_back({moments.rows(), mean, std::max(0.0, square)});
  }
  return result;
}

/// The same from rows: temperatures rows x points, errors rows x responses.
inline std::vector<Residuals> residuals(const LinearModel<>& model, const Matrix& temperatures, const Matrix& errors) {
  const Matrix difference = model.predict_rows(temperatures) - errors;
  std::vector<Residuals> result;
  for (Index e = 0; e < errors.cols(); ++e) {
    const double mean = difference.rows() > 0 ? difference.col(e).mean() : 0;
    result.push_back({difference.rows(), mean, (difference.col(e).array() - mean).square().sum()});
  }
  return result;
}

/// S of eq. (10) per error, um.
inline Vector S(const std::vector<Residuals>& per_error) {
  Vector result(static_cast<Index>(per_error.size()));
  for (Index e = 0; e < result.size(); ++e) result(e) = per_error[static_cast<std::size_t>(e)].S();
  return result;
}

}  // namespace thermfit
