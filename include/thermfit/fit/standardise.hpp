#pragma once

#include <Eigen/QR>
#include <cmath>

#include "thermfit/fit/options.hpp"
#include "thermfit/model/linear_model.hpp"
#include "thermfit/moments/moments.hpp"

namespace thermfit {

/// z = (value - mean) / scale per channel. Scale is 1 where nothing is scaled and for constant channels.
struct Standardisation {
  Vector temperature_mean, temperature_scale, error_mean, error_scale;

  /// The model in um and K of standardised coefficients (points x responses):
  /// `coefficient_ij = b_ij error_scale_j / temperature_scale_i`, intercepts so that the means agree.
  LinearModel<> undo(const Matrix& coefficients) const {
    LinearModel<> model;
    model.coefficients = temperature_scale.cwiseInverse().asDiagonal() * coefficients * error_scale.asDiagonal();
    model.intercept = error_mean - model.coefficients.transpose() * temperature_mean;
    return model;
  }

  /// rows x points to standardised rows x points.
  Matrix apply(const Matrix& temperatures) const {
    return (temperatures.rowwise() - temperature_mean.transpose()) * temperature_scale.cwiseInverse().asDiagonal();
  }
};

/// Means and scales of `moments`. Fewer than two rows, no temperature or no error: Error.
inline Standardisation standardisation(const Moments& moments, Scaling scaling) {
  if (moments.rows() < 2 || moments.temperatures() == 0 || moments.errors() == 0) {
    throw Error("fit",
                std::to_string(moments.rows()) + " rows of " + std::to_string(moments.temperatures()) +
                    " temperatures and " + std::to_string(moments.errors()) + " errors",
                "2 rows or more, 1 temperature or more, 1 error or more");
  }
  const auto deviation = [&](const auto& products, Index offset, bool wanted) {
    Vector scale = Vector::Ones(products.rows());
    for (Index c = 0; wanted && c < scale.size(); ++c) {
      const double variance = products(c, c) / static_cast<double>(moments.rows() - 1);
      if (!moments.constant(offset + c) && variance > 0) scale(c) = std::sqrt(variance);
    }
    return scale;
  };
  return {moments.temperature_mean(), deviation(moments.temperature_products(), 0, scaling != Scaling::centre),
          moments.error_mean(), deviation(moments.error_products(), moments.temperatures(), scaling == Scaling::both)};
}

/// Covariances (correlations where scaled) of standardised channels: what a fit from moments works on.
/// Rows and columns of constant channels are exactly zero, so that they get coefficient zero.
struct StandardisedMoments {
  Standardisation channels;
  Index rows = 0;
  Matrix xx;  ///< points x points
  Matrix xy;  ///< points x responses
  Vector yy;  ///< variance per response

  StandardisedMoments(const Moments& moments, Scaling scaling)
      : channels(standardisation(moments, scaling)), rows(moments.rows()) {
    const double divisor = static_cast<double>(rows - 1);
    const auto factor = [&](const Vector& scale, Index offset) {
      Vector result = scale.cwiseInverse();
      for (Index c = 0; c < result.size(); ++c) result(c) *= moments.constant(offset + c) ? 0 : 1;
      return result;
    };
    const Vector x = factor(channels.temperature_scale, 0);
    const Vector y = factor(channels.error_scale, moments.temperatures());
    xx = x.asDiagonal() * (moments.temperature_products() / divisor) * x.asDiagonal();
    xy = x.asDiagonal() * (moments.cross_products() / divisor) * y.asDiagonal();
    yy = y.cwiseAbs2().cwiseProduct(moments.error_products().diagonal()) / divisor;
  }

  double error_variance() const { return yy.sum(); }

  /// S of eq. (10) in um on the rows of the fit, for standardised `coefficients` (points x responses).
  Vector residual_deviation(const Matrix& coefficients) const {
    const Vector variance = yy + coefficients.cwiseProduct(xx * coefficients - 2 * xy).colwise().sum().transpose();
    return variance.cwiseMax(0).cwiseSqrt().cwiseProduct(channels.error_scale);
  }
};

/// Standardised rows divided by sqrt(n - 1), so that x'x and x'y are the xx and xy of StandardisedMoments without
/// having been squared: what a row-wise fit works on.
struct StandardisedRows {
  Standardisation channels;
  Index rows = 0;
  Matrix x;  ///< rows x points
  Matrix y;  ///< rows x responses

  StandardisedRows(const Matrix& temperatures, const Matrix& errors, Scaling scaling) : rows(temperatures.rows()) {
    const Moments moments(temperatures, errors);
    channels = standardisation(moments, scaling);
    const double root = std::sqrt(static_cast<double>(rows - 1));
    const Index points = temperatures.cols(), width = points + errors.cols();
    Matrix all(rows, width);
    all.leftCols(points) = channels.apply(temperatures) / root;
    all.rightCols(errors.cols()) = (errors.rowwise() - channels.error_mean.transpose()) *
                                   (channels.error_scale * root).cwiseInverse().asDiagonal();
    for (Index c = 0; c < width; ++c) {
      if (moments.constant(c)) all.col(c).setZero();
    }
    if (rows > width) {
      const Matrix triangle = Eigen::HouseholderQR<Eigen::Ref<Matrix>>(all)
                                  .matrixQR()
                                  .topRows(width)
                                  .template triangularView<Eigen::Upper>();
      all = triangle;
    }
    x = all.leftCols(points);
    y = all.rightCols(errors.cols());
  }

  double error_variance() const { return y.squaredNorm(); }

  /// S of eq. (10) in um on the rows of the fit, for standardised `coefficients` (points x responses).
  Vector residual_deviation(const Matrix& coefficients) const {
    return (y - x * coefficients).colwise().norm().transpose().cwiseProduct(channels.error_scale);
  }
};

}  // namespace thermfit
