#include "thermfit/fit/pls.hpp"

#include <Eigen/Cholesky>

#include "support/catch.hpp"
#include "support/thermal_rows.hpp"
#include "thermfit/fit/mlr.hpp"
#include "thermfit/number.hpp"

using namespace thermfit;

namespace {

FitOptions fixed(Index components, Scaling scaling = Scaling::both) {
  FitOptions options;
  options.scaling = scaling;
  options.components = ComponentRule::fixed(components);
  return options;
}

/// Rows whose means, deviations and correlations (columns: T…, then errors) are exactly those given.
Matrix rows_with(const Matrix& correlation, const Vector& mean, const Vector& deviation) {
  const Index n = 40, width = correlation.rows();
  const ThermalRows noise(n, width, 1, 9, 5);
  const Matrix centred = noise.temperatures.rowwise() - noise.temperatures.colwise().mean();
  const Matrix orthonormal = Eigen::HouseholderQR<Matrix>(centred).householderQ() * Matrix::Identity(n, width);
  const Matrix root = correlation.llt().matrixL();
  const Matrix standard = orthonormal * root.transpose() * std::sqrt(static_cast<double>(n - 1));
  return (standard * deviation.asDiagonal()).rowwise() + mean.transpose();
}

double relative(const Matrix& a, const Matrix& b) { return (a - b).norm() / b.norm(); }

}  // namespace

TEST_CASE("the worked example of the paper, eq. (11), comes out to its printed digits", "[fit]") {
  // Published for K1: weights .701 and .713, loading .6637, 99.88 % of X: together they fix the correlations below.
  // Deviations and means are those that turn the published standardised model into the published raw one.
  Matrix correlation(3, 3);
  correlation << 1, .9976, .9295, .9976, 1, .9454, .9295, .9454, 1;
  Vector mean(3), deviation(3);
  deviation << 12.46 / (1.773 / .46531), 12.46 / (1.811 / .47327), 12.46;
  mean << .5, .6, 6.258 + 1.773 * .5 + 1.811 * .6;
  const Matrix all = rows_with(correlation, mean, deviation);
  for (const LinearFit<>& fit :
       {fit_pls(all.leftCols(2), all.rightCols(1)), fit_pls(Moments(all.leftCols(2), all.rightCols(1)))}) {
    CHECK(fit.components == 1);  // the paper's own rule
    CHECK(fixed_text(fit.latent.weights(0, 0), 3) == "0.701");
    CHECK(fixed_text(fit.latent.weights(1, 0), 3) == "0.713");
    CHECK(fixed_text(fit.latent.error_loadings(0, 0), 4) == "0.6637");
    CHECK(fixed_text(100 * fit.latent.explained_temperature_variance(0), 2) == "99.88");
    CHECK(fixed_text(fit.standardised_coefficients(0, 0), 3) == "0.465");
    CHECK(fixed_text(fit.standardised_coefficients(1, 0), 3) == "0.473");
    CHECK(fixed_text(fit.model.intercept(0), 3) == "6.258");
    CHECK(fixed_text(fit.model.coefficients(0, 0), 3) == "1.773");
    CHECK(fixed_text(fit.model.coefficients(1, 0), 3) == "1.811");
  }
}

TEST_CASE("PLS with all components equals least squares, for one error and for several", "[fit]") {
  for (const Index responses : {1, 3}) {
    const ThermalRows data(200, 6, responses, 1);
    const Moments moments(data.temperatures, data.errors);
    const LinearFit<> mlr = fit_mlr(data.temperatures, data.errors);
    for (const Scaling scaling : {Scaling::centre, Scaling::temperatures, Scaling::both}) {
      CHECK(relative(fit_pls(data.temperatures, data.errors, fixed(6, scaling)).model.coefficients,
                     mlr.model.coefficients) < 1e-10);
      CHECK(relative(fit_pls(moments, fixed(6, scaling)).model.coefficients, mlr.model.coefficients) < 1e-9);
    }
  }
}

TEST_CASE("weights are orthonormal, scores uncorrelated, and rotations give the scores", "[fit]") {
  const ThermalRows data(100, 7, 2, 2, 1);
  const LinearFit<> fit = fit_pls(data.temperatures, data.errors, fixed(5));
  REQUIRE(fit.components == 5);
  CHECK(relative(fit.latent.weights.transpose() * fit.latent.weights, Matrix::Identity(5, 5)) < 1e-12);
  const Matrix t = scores(fit, data.temperatures);
  const Matrix covariance = t.transpose() * t / 99;
  CHECK((covariance - Matrix(fit.score_variance.asDiagonal())).norm() < 1e-12 * covariance.norm());
  CHECK(relative(fit.latent.loadings.transpose() * fit.latent.rotations, Matrix::Identity(5, 5)) < 1e-12);
  for (Index a = 0; a < 5; ++a) {
    Index largest = 0;
    fit.latent.weights.col(a).cwiseAbs().maxCoeff(&largest);
    CHECK(fit.latent.weights(largest, a) > 0);
  }
}

TEST_CASE("explained variance is cumulative and is that of the residuals, squared VIP averages to one", "[fit]") {
  const ThermalRows data(100, 7, 2, 3, 1);
  const LinearFit<> fit = fit_pls(data.temperatures, data.errors, fixed(4));
  const Matrix z = fit.channels.apply(data.temperatures);
  const Matrix left = z - scores(fit, data.temperatures) * fit.latent.loadings.transpose();
  CHECK(fit.latent.explained_temperature_variance(3) == Approx(1 - left.squaredNorm() / z.squaredNorm()));
  const double unexplained =
      fit.residual_deviation_um.cwiseQuotient(fit.channels.error_scale).squaredNorm() / 2;  // mean over errors
  CHECK(fit.latent.explained_error_variance(3) == Approx(1 - unexplained));
  CHECK(fit.latent.vip.squaredNorm() / 7 == Approx(1));
}

TEST_CASE("the paper's rule stops past 90 % and below a gain of 5 %", "[fit]") {
  Matrix correlation = Matrix::Identity(4, 4);
  const Vector mean = Vector::Zero(4), deviation = Vector::Ones(4);
  correlation.row(3) << .8, .4, .2, 1;  // three independent points: a third of the variance each
  correlation.col(3) = correlation.row(3).transpose();
  const Matrix independent = rows_with(correlation, mean, deviation);
  // One component is the whole of least squares on independent points; there is no covariance left for a second.
  CHECK(fit_pls(independent.leftCols(3), independent.rightCols(1)).components == 1);
  const ThermalRows data(300, 8, 1, 4, 2);
  const LinearFit<> all = fit_pls(data.temperatures, data.errors, fixed(8));
  const LinearFit<> paper = fit_pls(data.temperatures, data.errors);
  const Vector& explained = all.latent.explained_temperature_variance;
  const Index a = paper.components;
  REQUIRE(a >= 1);
  REQUIRE(a < 8);
  CHECK((explained(a - 1) > .9 || explained(a) - explained(a - 1) < .05));
  if (a > 1) {
    CHECK(explained(a - 2) <= .9);
    CHECK(explained(a - 1) - explained(a - 2) >= .05);
  }
}

TEST_CASE("duplicated, constant and dependent points stop the components at the rank", "[fit]") {
  const ThermalRows data(80, 3, 1, 5, 1);
  Matrix redundant(80, 8);
  redundant << data.temperatures, data.temperatures, Matrix::Constant(80, 1, 20.7),
      data.temperatures.col(0) + data.temperatures.col(1);
  const LinearFit<> alone = fit_mlr(data.temperatures, data.errors);
  const Moments moments(redundant, data.errors);
  for (const LinearFit<>& fit : {fit_pls(redundant, data.errors, fixed(8)), fit_pls(moments, fixed(8))}) {
    CHECK(fit.components == 3);
    CHECK(fit.rank == 3);
    CHECK(fit.model.coefficients.cwiseAbs().maxCoeff() < 100);
    CHECK(fit.model.coefficients(6, 0) == 0);
    CHECK(fit.residual_deviation_um(0) == Approx(alone.residual_deviation_um(0)).epsilon(1e-8));
  }
}

TEST_CASE("near duplicates give no huge coefficients from moments, and are resolved from rows", "[fit]") {
  const ThermalRows data(80, 3, 1, 6, 1);
  const ThermalRows noise(80, 3, 1, 7, 1);
  Matrix close(80, 6);
  close << data.temperatures, data.temperatures + 1e-9 * (noise.temperatures.array() - 20).matrix();
  const LinearFit<> moments = fit_pls(Moments(close, data.errors), fixed(6));
  CHECK(moments.components == 3);
  CHECK(moments.model.coefficients.cwiseAbs().maxCoeff() < 100);
  const LinearFit<> rows = fit_pls(close, data.errors, fixed(6));
  CHECK(rows.components == 6);
  CHECK(rows.condition_number > 1e8);
  CHECK(rows.residual_deviation_um(0) < moments.residual_deviation_um(0));
}

TEST_CASE("a condition moments cannot resolve is refused and points to rows", "[fit]") {
  const ThermalRows data(80, 3, 1, 6, 1);
  const ThermalRows noise(80, 3, 1, 7, 1);
  Matrix close(80, 6);
  close << data.temperatures, data.temperatures + 1.5e-6 * (noise.temperatures.array() - 20).matrix();
  const Moments moments(close, data.errors);
  CHECK_THROWS_WITH(fit_pls(moments, fixed(6)), Catch::Contains("fit from rows"));
  CHECK_THROWS_WITH(fit_mlr(moments), Catch::Contains("fit from rows"));
  CHECK_NOTHROW(fit_pls(moments));  // one component does not come near it
  CHECK_NOTHROW(fit_mlr(close, data.errors));
  CHECK(pls_path(moments).size() == 3);  // choosing stops where it cannot see
}

TEST_CASE("nothing to explain gives the mean and no component", "[fit]") {
  const ThermalRows data(30, 3, 1, 8);
  const LinearFit<> flat = fit_pls(data.temperatures, Matrix::Constant(30, 1, 4.5), fixed(2));
  CHECK(flat.components == 0);
  CHECK(flat.model.coefficients.norm() == 0);
  CHECK(flat.model.intercept(0) == Approx(4.5));
  CHECK(flat.residual_deviation_um(0) < 1e-12);
  const LinearFit<> still = fit_pls(Moments(Matrix::Constant(30, 3, 20.1), data.errors), fixed(2));
  CHECK(still.components == 0);
  CHECK(still.rank == 0);
  CHECK(still.model.intercept(0) == Approx(data.errors.mean()));
}

TEST_CASE("wrong input to a fit is an Error", "[fit]") {
  const ThermalRows data(30, 3, 1, 8);
  const Moments moments(data.temperatures, data.errors);
  CHECK_THROWS_AS(fit_pls(moments, fixed(0)), Error);
  CHECK_THROWS_AS(fit_pls(Moments(data.temperatures.topRows(1), data.errors.topRows(1))), Error);
  CHECK_THROWS_AS(fit_pls(Moments(3, 1)), Error);
  CHECK_THROWS_AS(fit_pls(data.temperatures, data.errors.topRows(29)), Error);
  FitOptions options;
  options.components = ComponentRule::leave_one_batch_out();
  CHECK_THROWS_AS(fit_pls(moments, options), Error);
  CHECK_THROWS_AS(fit_pls(std::vector<Moments<>>{moments}, options), Error);
  Matrix holes = data.temperatures;
  holes(17, 1) = std::nan("");
  CHECK_THROWS_WITH(fit_pls(holes, data.errors), Catch::Contains("row 17, temperature 1"));
  CHECK(fit_pls(moments, fixed(99)).components == 3);
}

TEST_CASE("leaving one batch out chooses the components that predict unseen batches best", "[fit]") {
  std::vector<Moments<>> batches;
  for (unsigned b = 0; b < 6; ++b) {
    const ThermalRows data(40, 8, 1, 20 + b, .5);
    batches.emplace_back(data.temperatures, data.errors);
  }
  FitOptions options;
  options.components = ComponentRule::leave_one_batch_out();
  const Index chosen = fit_pls(batches, options).components;
  Vector square = Vector::Zero(8);
  for (std::size_t i = 0; i < 6; ++i) {
    std::vector<Moments<>> rest = batches;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    for (Index a = 1; a <= 8; ++a) {
      square(a - 1) += residuals(fit_pls(merged(rest), fixed(a)).model, batches[i])[0].sum_of_squares();
    }
  }
  Index best = 0;
  square.minCoeff(&best);
  CHECK(chosen == best + 1);
  options.components = ComponentRule::leave_one_batch_out(1);
  CHECK(fit_pls(batches, options).components == 1);
}
