#pragma once

/// Linear least squares with a Gaussian prior, from cross-products: coefficients, covariance and evidence.

#include <Eigen/Cholesky>
#include <cmath>

#include "thermfit/types.hpp"

namespace thermfit {

/// (p + 1) x (p + 1): the last row and column belong to the target.
inline Matrix cross_products(const Matrix& regressors, const Vector& target) {
  const Index p = regressors.cols();
  Matrix products(p + 1, p + 1);
  products.topLeftCorner(p, p).noalias() = regressors.transpose() * regressors;
  products.topRightCorner(p, 1).noalias() = regressors.transpose() * target;
  products.bottomLeftCorner(1, p) = products.topRightCorner(p, 1).transpose();
  products(p, p) = target.squaredNorm();
  return products;
}

/// Minimises sum (y - X b)^2 / noise^2 + sum (b / sd)^2.
struct PriorFit {
  Vector coefficients;
  Matrix covariance;  ///< of the coefficients, for residuals of standard deviation `noise`; empty unless asked for
};

inline PriorFit fit_with_prior(const Matrix& products, const Vector& prior_sd, double noise,
                               bool with_covariance = false) {
  const Index p = prior_sd.size();
  Matrix normal = products.topLeftCorner(p, p);
  normal.diagonal().array() += noise * noise / prior_sd.array().square();
  const Eigen::LDLT<Matrix> factor(normal);
  PriorFit fit;
  fit.coefficients = factor.solve(products.topRightCorner(p, 1));
  if (with_covariance) fit.covariance = noise * noise * factor.solve(Matrix::Identity(p, p));
  return fit;
}

/// log p(target) with the coefficients integrated out, N(0, level^2 I + X diag(sd^2) X'), where only `rows` samples
/// count as independent and each weighs 1 / (level spread)^2.
inline double log_evidence(const Matrix& products, double rows, const Vector& prior_sd, double level, double spread) {
  const double noise = level * spread;
  const Index p = prior_sd.size();
  Matrix normal = prior_sd.asDiagonal() * products.topLeftCorner(p, p) * prior_sd.asDiagonal();
  normal = normal / (noise * noise) + Matrix::Identity(p, p);
  const Eigen::LLT<Matrix> factor(normal);
  const Vector score = prior_sd.cwiseProduct(products.topRightCorner(p, 1).col(0)) / (noise * noise);
  const double log_determinant = 2 * factor.matrixLLT().diagonal().array().log().sum();
  return -.5 * (products(p, p) / (noise * noise) - score.dot(factor.solve(score)) + log_determinant) -
         rows * std::log(level);
}

}  // namespace thermfit
