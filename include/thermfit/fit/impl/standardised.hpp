#pragma once

#include <Eigen/QR>
#include <cmath>

#include "thermfit/fit/standardisation.hpp"

namespace thermfit::detail {

/// Covariances (correlations where scaled) of standardised channels: what a fit from moments works on.
/// Rows and columns of constant channels are exactly zero, so that they get coefficient zero.
template <typename Number>
struct StandardisedMoments {
  using Scalar = Number;
  Standardisation<Scalar> channels;
  Index rows = 0;
  MatrixX<Scalar> xx;  ///< points x points
  MatrixX<Scalar> xy;  ///< points x responses
  VectorX<Scalar> yy;  ///< variance per response

  StandardisedMoments(const Moments<Scalar>& moments, Scaling scaling)
      : channels(standardisation(moments, scaling)), rows(moments.rows()) {
    const Scalar divisor = static_cast<Scalar>(rows - 1);
    const auto factor = [&](const VectorX<Scalar>& scale, Index offset) {
      VectorX<Scalar> result = scale.cwiseInverse();
      for (Index c = 0; c < result.size(); ++c) result(c) *= static_cast<Scalar>(moments.constant(offset + c) ? 0 : 1);
      return result;
    };
    const VectorX<Scalar> x = factor(channels.temperature_scale, 0);
    const VectorX<Scalar> y = factor(channels.error_scale, moments.temperatures());
    xx = x.asDiagonal() * (moments.temperature_products() / divisor) * x.asDiagonal();
    xy = x.asDiagonal() * (moments.cross_products() / divisor) * y.asDiagonal();
    yy = y.cwiseAbs2().cwiseProduct(moments.error_products().diagonal()) / divisor;
  }

  Scalar error_variance() const { return yy.sum(); }

  /// S of eq. (10) in um on the rows of the fit, for standardised `coefficients` (points x responses).
  VectorX<Scalar> residual_deviation(const MatrixX<Scalar>& coefficients) const {
    const VectorX<Scalar> variance =
        yy + coefficients.cwiseProduct(xx * coefficients - 2 * xy).colwise().sum().transpose();
    return variance.cwiseMax(0).cwiseSqrt().cwiseProduct(channels.error_scale);
  }
};

/// Standardised rows divided by sqrt(n - 1), so that x'x and x'y are the xx and xy of StandardisedMoments without
/// having been squared: what a row-wise fit works on.
template <typename Number>
struct StandardisedRows {
  using Scalar = Number;
  using Rows = MatrixView<Scalar>;
  Standardisation<Scalar> channels;
  Index rows = 0;
  MatrixX<Scalar> x;  ///< rows x points
  MatrixX<Scalar> y;  ///< rows x responses

  StandardisedRows(const Rows& temperatures, const Rows& errors, Scaling scaling) : rows(temperatures.rows()) {
    const Moments<Scalar> moments(temperatures, errors);
    channels = standardisation(moments, scaling);
    const Scalar root = std::sqrt(static_cast<Scalar>(rows - 1));
    const Index points = temperatures.cols(), width = points + errors.cols();
    MatrixX<Scalar> all(rows, width);
    all.leftCols(points) = channels.apply(temperatures) / root;
    all.rightCols(errors.cols()) = (errors.rowwise() - channels.error_mean.transpose()) *
                                   (channels.error_scale * root).cwiseInverse().asDiagonal();
    for (Index c = 0; c < width; ++c) {
      if (moments.constant(c)) all.col(c).setZero();
    }
    if (rows > width) {
      const MatrixX<Scalar> triangle = Eigen::HouseholderQR<Eigen::Ref<MatrixX<Scalar>>>(all)
                                           .matrixQR()
                                           .topRows(width)
                                           .template triangularView<Eigen::Upper>();
      all = triangle;
    }
    x = all.leftCols(points);
    y = all.rightCols(errors.cols());
  }

  Scalar error_variance() const { return y.squaredNorm(); }

  /// S of eq. (10) in um on the rows of the fit, for standardised `coefficients` (points x responses).
  VectorX<Scalar> residual_deviation(const MatrixX<Scalar>& coefficients) const {
    return (y - x * coefficients).colwise().norm().transpose().cwiseProduct(channels.error_scale);
  }
};

}  // namespace thermfit::detail
