#include <functional>
#include <random>

#include "support/catch.hpp"
#include "support/thermal_rows.hpp"
#include "thermfit/study.hpp"

/// Whatever expression holds the rows, the result is that of a plain matrix.

using namespace thermfit;

namespace {

/// Calls `check(expression, expression)` with temperatures and errors dressed in every way Eigen knows.
template <class Check>
void in_every_dress(const Matrix& temperatures, const Matrix& errors, const Check& check) {
  const Index rows = temperatures.rows(), points = temperatures.cols(), responses = errors.cols();
  SECTION("a block of a larger matrix") {
    Matrix larger = Matrix::Constant(rows + 5, points + responses + 3, 1e300);
    larger.block(3, 1, rows, points) = temperatures;
    larger.block(3, points + 2, rows, responses) = errors;
    check(larger.block(3, 1, rows, points), larger.block(3, points + 2, rows, responses));
  }
  SECTION("row-major matrices") { check(RowMatrix(temperatures), RowMatrix(errors)); }
  SECTION("a map with strides") {
    using Stride = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
    std::vector<double> memory(static_cast<std::size_t>(3 * rows * (points + responses)), 1e300);
    Eigen::Map<Matrix, 0, Stride> t(memory.data(), rows, points, Stride(3 * rows, 3));
    Eigen::Map<Matrix, 0, Stride> e(memory.data() + 3 * rows * points, rows, responses, Stride(3 * rows, 3));
    t = temperatures;
    e = errors;
    check(t, e);
  }
  SECTION("a difference") {  // exact: twice a number less the number
    const Matrix twice_t = 2 * temperatures, twice_e = 2 * errors;
    check(twice_t - temperatures, twice_e - errors);
  }
  SECTION("a transpose") {
    const Matrix t = temperatures.transpose(), e = errors.transpose();
    check(t.transpose(), e.transpose());
  }
  SECTION("a product") {
    check(temperatures * Matrix::Identity(points, points), errors * Matrix::Identity(responses, responses));
  }
}

/// The same as every matrix in the results, in order.
bool same(const LinearFit<>& a, const LinearFit<>& b) {
  return a.model.coefficients == b.model.coefficients && a.model.intercept == b.model.intercept &&
         a.residual_deviation_um == b.residual_deviation_um;
}

}  // namespace

TEST_CASE("moments of any expression are those of the matrix, to the bit", "[fit]") {
  const ThermalRows data(300, 6, 2, 11);
  const Moments plain(data.temperatures, data.errors);
  in_every_dress(data.temperatures, data.errors, [&](const auto& t, const auto& e) {
    const Moments moments(t, e);
    CHECK(moments.temperature_products() == plain.temperature_products());
    CHECK(moments.cross_products() == plain.cross_products());
    CHECK(moments.error_products() == plain.error_products());
    CHECK(moments.temperature_mean() == plain.temperature_mean());
    CHECK(moments.temperature_highest() == plain.temperature_highest());
    CHECK(moments.minus(t.row(0).transpose()).temperature_mean() ==
          plain.minus(data.temperatures.row(0).transpose()).temperature_mean());
    const auto seen = observe(t, e, "K1");
    CHECK(ByCorrelation{}(seen, 3) == ByCorrelation{}(observe(data.temperatures, data.errors), 3));
    CHECK(grey_relational_grades(t, e) == grey_relational_grades(data.temperatures, data.errors));
  });
}

TEST_CASE("row-wise fits of any expression are those of the matrix, to the bit", "[fit]") {
  const ThermalRows data(80, 4, 2, 12);
  FitOptions options;
  options.components = ComponentRule::fixed(3);
  options.ridge_lambda = .01;
  in_every_dress(data.temperatures, data.errors, [&](const auto& t, const auto& e) {
    CHECK(same(fit_pls(t, e, options), fit_pls(data.temperatures, data.errors, options)));
    CHECK(same(fit_pcr(t, e, options), fit_pcr(data.temperatures, data.errors, options)));
    CHECK(same(fit_mlr(t, e), fit_mlr(data.temperatures, data.errors)));
    CHECK(same(fit_ridge(t, e, options), fit_ridge(data.temperatures, data.errors, options)));
    for (const Method method : {Method::pls, Method::mlr, Method::pcr, Method::ridge}) {
      CHECK(same(fit(method, t, e, options), fit(method, data.temperatures, data.errors, options)));
    }
  });
}

TEST_CASE("predictions, scores and residuals of any expression are those of the matrix, to rounding", "[fit]") {
  const ThermalRows data(80, 4, 2, 13);
  const Moments moments(data.temperatures, data.errors);
  const LinearFit<> fit = fit_pls(moments);
  const TrainingDomain<> domain = training_domain(fit, moments);
  const Matrix predicted = fit.model.predict_rows(data.temperatures);
  const Matrix scored = scores(fit, data.temperatures);
  const Vector S_plain = S(residuals(fit.model, data.temperatures, data.errors));
  in_every_dress(data.temperatures, data.errors, [&](const auto& t, const auto& e) {
    CHECK(fit.model.predict_rows(t).isApprox(predicted, 1e-15));
    CHECK(scores(fit, t).isApprox(scored, 1e-14));
    CHECK(S(residuals(fit.model, t, e)).isApprox(S_plain, 1e-14));
    CHECK(fit.channels.apply(t) == fit.channels.apply(data.temperatures));
    CHECK(outside_shares(domain, t).t2 == outside_shares(domain, data.temperatures).t2);
  });
}

TEST_CASE("robustness and the limit of SPE take any expression", "[fit]") {
  Matrix root(4, 4);
  root << 4, 1, 0, 2, 1, 5, 1, 0, 0, 1, 6, 1, 2, 0, 1, 7;
  const Matrix square = root * root.transpose();
  in_every_dress(square, square, [&](const auto& S, const auto& covariance) {
    CHECK(robustness(S).pooled.S_std == robustness(square).pooled.S_std);
    CHECK(spe_limit(.99, covariance, 4, 1, 50) == Approx(spe_limit(.99, square, 4, 1, 50)).epsilon(1e-14));
  });
}
