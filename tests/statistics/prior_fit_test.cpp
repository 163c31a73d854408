#include "thermfit/statistics/prior_fit.hpp"

#include <Eigen/LU>
#include <random>

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("the evidence is the density of the target under the prior and the noise", "[gap]") {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  Matrix regressors(12, 3);
  Vector target(12), sd(3);
  for (double& value : regressors.reshaped()) value = normal(random);
  for (double& value : target) value = normal(random);
  sd << .5, 2, 1;
  const Matrix covariance =
      .09 * Matrix::Identity(12, 12) + regressors * sd.array().square().matrix().asDiagonal() * regressors.transpose();
  const double direct = -.5 * (target.dot(covariance.inverse() * target) + std::log(covariance.determinant()));
  CHECK(log_evidence(cross_products(regressors, target), 12, sd, .3, 1) == Approx(direct));
}

TEST_CASE("a wide prior gives least squares, a tight one gives zero", "[gap]") {
  Matrix regressors(4, 2);
  regressors << 1, 0, 1, 1, 1, 2, 1, 3;
  Vector target(4);
  target << 1, 3, 5, 7;
  const Matrix products = cross_products(regressors, target);
  const PriorFit free = fit_with_prior(products, Vector::Constant(2, 1e6), 1, true);
  CHECK(free.coefficients(0) == Approx(1));
  CHECK(free.coefficients(1) == Approx(2));
  CHECK(free.covariance(1, 1) == Approx(1 / 5.));  // noise^2 / sum (x - mean)^2
  CHECK(fit_with_prior(products, Vector::Constant(2, 1e-6), 1).coefficients.norm() < 1e-8);
}
