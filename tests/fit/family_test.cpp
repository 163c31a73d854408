// Least squares, principal components and ridge: one spectrum, three uses.
#include "support/catch.hpp"
#include "support/thermal_rows.hpp"
#include "thermfit/fit/fit.hpp"

using namespace thermfit;

namespace {
double relative(const Matrix& a, const Matrix& b) { return (a - b).norm() / b.norm(); }

FitOptions with_lambda(double lambda) {
  FitOptions options;
  options.ridge_lambda = lambda;
  return options;
}
}  // namespace

TEST_CASE("every method gives the same model from moments and from rows", "[fit]") {
  for (const Index responses : {1, 2}) {
    const ThermalRows data(500, 8, responses, 1);
    const Moments moments(data.temperatures, data.errors);
    for (const Scaling scaling : {Scaling::centre, Scaling::temperatures, Scaling::both}) {
      for (const Method method : {Method::pls, Method::mlr, Method::pcr, Method::ridge}) {
        FitOptions options = with_lambda(.01);
        options.scaling = scaling;
        options.components = ComponentRule::fixed(3);
        const LinearFit<> a = fit(method, moments, options);
        const LinearFit<> b = fit(method, data.temperatures, data.errors, options);
        CAPTURE(name(method), responses, static_cast<int>(scaling));
        CHECK(relative(a.model.coefficients, b.model.coefficients) < 1e-9);
        CHECK(relative(a.model.intercept, b.model.intercept) < 1e-9);
        CHECK(relative(a.residual_deviation_um, b.residual_deviation_um) < 1e-9);
        CHECK(a.condition_number == Approx(b.condition_number).epsilon(1e-8));
        CHECK(a.degrees_of_freedom == Approx(b.degrees_of_freedom).epsilon(1e-8));
        CHECK(a.rank == b.rank);
        CHECK(a.components == b.components);
        if (method == Method::pls || method == Method::pcr) CHECK(relative(a.latent.weights, b.latent.weights) < 1e-8);
      }
    }
  }
}

TEST_CASE("least squares leaves residuals at right angles to the temperatures", "[fit]") {
  const ThermalRows data(100, 5, 2, 2);
  for (const LinearFit<>& fit :
       {fit_mlr(data.temperatures, data.errors), fit_mlr(Moments(data.temperatures, data.errors))}) {
    const Matrix residual = data.errors - fit.model.predict_rows(data.temperatures);
    CHECK((data.temperatures.transpose() * residual).cwiseAbs().maxCoeff() < 1e-7);
    CHECK(residual.colwise().sum().cwiseAbs().maxCoeff() < 1e-9);
    CHECK(fit.rank == 5);
  }
}

TEST_CASE("least squares on dependent points has the lowest rank and the smallest coefficients", "[fit]") {
  const ThermalRows data(60, 2, 1, 3, 1);
  Matrix t(60, 4);
  t << data.temperatures, data.temperatures.col(0), Matrix::Constant(60, 1, 22.4);
  const LinearFit<> alone = fit_mlr(data.temperatures, data.errors);
  for (const LinearFit<>& fit : {fit_mlr(t, data.errors), fit_mlr(Moments(t, data.errors))}) {
    CHECK(fit.rank == 2);
    CHECK(fit.degrees_of_freedom == 57);
    CHECK(fit.model.coefficients(0) == Approx(alone.model.coefficients(0) / 2));  // shared by the twins
    CHECK(fit.model.coefficients(2) == Approx(alone.model.coefficients(0) / 2));
    CHECK(fit.model.coefficients(1) == Approx(alone.model.coefficients(1)));
    CHECK(fit.model.coefficients(3) == 0);
    CHECK(std::isfinite(fit.condition_number));
  }
}

TEST_CASE("the condition number is that of the standardised temperatures", "[fit]") {
  Matrix t(4, 2), e(4, 1);
  t << 1, 1, -1, -1, 1, -1, -1, 1;
  e << 1, 2, 3, 5;
  CHECK(fit_mlr(t, e).condition_number == Approx(1));
  t.col(1) *= 1e6;  // a unit is no collinearity
  CHECK(fit_mlr(t, e).condition_number == Approx(1));
  t.col(1) = 3 * t.col(0) + 1e-3 * t.col(1) / 1e6;
  CHECK(fit_mlr(t, e).condition_number == Approx(6e3).epsilon(.01));
  CHECK(fit_mlr(Moments(t, e)).condition_number == Approx(6e3).epsilon(.01));
}

TEST_CASE("PCR and ridge end in least squares, and ridge in the mean", "[fit]") {
  const ThermalRows data(150, 5, 2, 4, .5);
  const Moments moments(data.temperatures, data.errors);
  const LinearFit<> mlr = fit_mlr(moments);
  FitOptions all;
  all.components = ComponentRule::fixed(5);
  CHECK(relative(fit_pcr(moments, all).model.coefficients, mlr.model.coefficients) < 1e-9);
  CHECK(relative(fit_ridge(moments, with_lambda(0)).model.coefficients, mlr.model.coefficients) < 1e-9);
  const LinearFit<> flat = fit_ridge(moments, with_lambda(1e12));
  CHECK(flat.model.coefficients.norm() < 1e-9 * mlr.model.coefficients.norm());
  CHECK((flat.model.intercept - moments.error_mean()).norm() < 1e-6);
  CHECK(flat.degrees_of_freedom == Approx(149));
}

TEST_CASE("ridge solves its penalised normal equations", "[fit]") {
  const ThermalRows data(80, 6, 1, 5);
  const double lambda = .03;
  const LinearFit<> fit = fit_ridge(data.temperatures, data.errors, with_lambda(lambda));
  const Matrix z = fit.channels.apply(data.temperatures);
  const Matrix y = (data.errors.array() - fit.channels.error_mean(0)) / fit.channels.error_scale(0);
  const Matrix gradient =
      z.transpose() * (y - z * fit.standardised_coefficients) / 79 - lambda * fit.standardised_coefficients;
  CHECK(gradient.cwiseAbs().maxCoeff() < 1e-13);
  double size = 1e300;
  for (const double more : {0.0, .001, .01, .1, 1.0}) {
    const double norm = fit_ridge(data.temperatures, data.errors, with_lambda(more)).standardised_coefficients.norm();
    CHECK(norm < size);
    size = norm;
  }
}

TEST_CASE("the penalty chosen by leaving batches out is the best of the grid", "[fit]") {
  std::vector<Moments<>> batches;
  for (unsigned b = 0; b < 5; ++b) {
    const ThermalRows data(12, 8, 1, 40 + b, 1.5);
    batches.emplace_back(data.temperatures, data.errors);
  }
  const double chosen = fit_ridge(batches).ridge_lambda;
  double best = -1, least = 1e300;
  for (const double lambda : ridge_grid()) {
    double square = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      std::vector<Moments<>> rest = batches;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      square += residuals(fit_ridge(merged(rest), with_lambda(lambda)).model, batches[i])[0].sum_of_squares();
    }
    if (square < least) {
      least = square;
      best = lambda;
    }
  }
  CHECK(chosen == best);
  CHECK(chosen > 0);
  CHECK_THROWS_AS(fit_ridge(merged(batches), FitOptions{}), Error);
  CHECK_THROWS_AS(fit_ridge(merged(batches), with_lambda(-1)), Error);
  CHECK_THROWS_AS(fit_ridge(merged(batches), with_lambda(std::nan(""))), Error);
}

TEST_CASE("the order of the points does not matter", "[fit]") {
  const ThermalRows data(80, 5, 1, 6);
  const Moments moments(data.temperatures, data.errors);
  const std::vector<Index> order{3, 0, 4, 1, 2};
  FitOptions options = with_lambda(.01);
  options.components = ComponentRule::fixed(2);
  for (const Method method : {Method::pls, Method::mlr, Method::pcr, Method::ridge}) {
    const Matrix a = fit(method, moments, options).model.coefficients;
    const Matrix b = fit(method, moments.subset(order), options).model.coefficients;
    CHECK(relative(b, Matrix(a(order, Eigen::all))) < 1e-9);
  }
}
