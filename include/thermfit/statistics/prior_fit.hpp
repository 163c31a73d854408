#pragma once

/// Linear least squares with a Gaussian prior, from cross-products: coefficients, covariance and evidence.

#include <Eigen/Cholesky>
#include <cmath>

#include "thermfit/compiled.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// [X y]'[X y] of n x p regressors X and a target y: (p + 1) x (p + 1), the target last. Allocates the result.
template <typename Scalar = double>
MatrixX<Scalar> cross_products(const Lazy<MatrixX<Scalar>>& regressors, const Lazy<VectorX<Scalar>>& target) {
  const Index p = regressors.cols();
  MatrixX<Scalar> products(p + 1, p + 1);
  products.topLeftCorner(p, p).noalias() = regressors.transpose() * regressors;
  products.topRightCorner(p, 1).noalias() = regressors.transpose() * target;
  products.bottomLeftCorner(1, p) = products.topRightCorner(p, 1).transpose();
  products(p, p) = target.squaredNorm();
  return products;
}

THERMFIT_COMPILED_TEMPLATE(Matrix cross_products<double>(const Matrix&, const Vector&));

/// The b that minimises sum (y - X b)^2 / noise^2 + sum (b / sd)^2.
struct PriorFit {
  Vector coefficients;  ///< b, by regressor
  Matrix covariance;    ///< of the coefficients, for residuals of standard deviation `noise`; empty unless asked for
};

/// Solves (X'X + noise^2 diag(sd)^-2) b = X'y from cross_products() of X and y. `prior_sd` (> 0) by regressor, `noise`
/// in the unit of y. Allocates.
template <typename Scalar = double>
PriorFit fit_with_prior(const Lazy<MatrixX<Scalar>>& products, const Lazy<VectorX<Scalar>>& prior_sd, double noise,
                        bool with_covariance = false) {
  const Index p = prior_sd.size();
  MatrixX<Scalar> normal = products.topLeftCorner(p, p);
  normal.diagonal().array() += noise * noise / prior_sd.array().square();
  const Eigen::LDLT<MatrixX<Scalar>> factor(normal);
  PriorFit fit;
  fit.coefficients = factor.solve(products.topRightCorner(p, 1));
  if (with_covariance) fit.covariance = noise * noise * factor.solve(MatrixX<Scalar>::Identity(p, p));
  return fit;
}

THERMFIT_COMPILED_TEMPLATE(PriorFit fit_with_prior<double>(const Matrix&, const Vector&, double, bool));

/// log p(target) with the coefficients integrated out, N(0, level^2 I + X diag(sd^2) X'), where only `rows` samples
/// count as independent and each weighs 1 / (level spread)^2. In nats, without the constant of 2 pi. Allocates.
template <typename Scalar = double>
double log_evidence(const Lazy<MatrixX<Scalar>>& products, double rows, const Lazy<VectorX<Scalar>>& prior_sd,
                    double level, double spread) {
  const double noise = level * spread;
  const Index p = prior_sd.size();
  MatrixX<Scalar> normal = prior_sd.asDiagonal() * products.topLeftCorner(p, p) * prior_sd.asDiagonal();
  normal = normal / (noise * noise) + MatrixX<Scalar>::Identity(p, p);
  const Eigen::LLT<MatrixX<Scalar>> factor(normal);
  const VectorX<Scalar> score = prior_sd.cwiseProduct(products.topRightCorner(p, 1).col(0)) / (noise * noise);
  const double log_determinant = 2 * factor.matrixLLT().diagonal().array().log().sum();
  return -.5 * (products(p, p) / (noise * noise) - score.dot(factor.solve(score)) + log_determinant) -
         rows * std::log(level);
}

THERMFIT_COMPILED_TEMPLATE(double log_evidence<double>(const Matrix&, double, const Vector&, double, double));

}  // namespace thermfit
