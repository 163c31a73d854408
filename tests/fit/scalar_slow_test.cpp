#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "support/catch.hpp"
#include "support/vcenter55.hpp"
#include "thermfit/fit/fit.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/model/predict.hpp"
#include "thermfit/select/correlation.hpp"

/// How many digits a fit keeps: double against long double on the same rows, over condition numbers.

using namespace thermfit;

namespace {

/// Standardised temperatures with geometric singular values from 1 to 1 / condition, and errors that are exactly a
/// weighted sum of them, so that only rounding is between double and long double.
struct IllConditioned {
  Matrix temperatures, errors;

  explicit IllConditioned(double condition, unsigned seed, Index rows = 60, Index points = 5)
      : temperatures(rows, points), errors(rows, 1) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    const auto orthonormal = [&](Index size, Index width) -> Matrix {
      Matrix drawn = Matrix::NullaryExpr(size, width, [&] { return normal(generator); });
      drawn.rowwise() -= drawn.colwise().mean();
      return Eigen::HouseholderQR<Matrix>(drawn).householderQ() * Matrix::Identity(size, width);
    };
    Vector sizes(points);
    for (Index p = 0; p < points; ++p) {
      sizes(p) = std::pow(condition, -static_cast<double>(p) / static_cast<double>(points - 1));
    }
    const Matrix mixing = Matrix::NullaryExpr(points, points, [&] { return normal(generator); });
    const Matrix directions = Eigen::HouseholderQR<Matrix>(mixing).householderQ();
    temperatures = 30 * orthonormal(rows, points) * sizes.asDiagonal() * directions.transpose();
    errors = temperatures * Vector::NullaryExpr(points, [&] { return 1 + std::abs(normal(generator)); });
  }

  template <typename Scalar>
  Moments<Scalar> moments() const {
    return Moments(temperatures.cast<Scalar>(), errors.cast<Scalar>());
  }
  template <typename Scalar>
  LinearFit<Scalar> by_rows(Method method, const FitOptions& options) const {
    return fit(method, temperatures.cast<Scalar>(), errors.cast<Scalar>(), options);
  }
  template <typename Scalar>
  LinearFit<Scalar> by_moments(Method method, const FitOptions& options) const {
    return fit(method, moments<Scalar>(), options);
  }
};

/// Relative distance of the standardised coefficients from the reference.
template <typename Scalar>
double loss(const LinearFit<Scalar>& fit, const LinearFit<long double>& reference) {
  const MatrixX<long double> ours = fit.standardised_coefficients.template cast<long double>();
  return static_cast<double>((ours - reference.standardised_coefficients).norm() /
                             reference.standardised_coefficients.norm());
}

/// Rows whose standardised temperatures have a condition number between `least` and `most`.
IllConditioned with_condition(double least, double most) {
  for (unsigned seed = 1;; ++seed) {
    const IllConditioned data(2 * most, seed);
    const auto condition = static_cast<double>(fit_mlr(data.temperatures, data.errors).condition_number);
    if (condition > least && condition < most) return data;
  }
}

FitOptions all_components(Index points) {
  FitOptions options;
  options.components = ComponentRule::fixed(points);
  options.ridge_lambda = 0;
  return options;
}

/// Middle of the losses over seeds: one draw may be lucky.
template <class Draw>
double median_loss(const Draw& draw) {
  std::vector<double> losses;
  for (unsigned seed = 1; seed <= 9; ++seed) losses.push_back(draw(seed));
  std::sort(losses.begin(), losses.end());
  return losses[4];
}

constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace

// Long double is 80-bit on x86: eleven bits more than double. Elsewhere it may be the same, and no reference.
#if defined(__x86_64__)

TEST_CASE("a row-wise fit of double loses the condition number's digits, and no more", "[fit]") {
  for (const Method method : {Method::mlr, Method::pcr, Method::ridge, Method::pls}) {
    for (const double condition : {1e4, 1e6, 1e8, 1e10}) {
      // A component whose covariance with the errors (about 1 / condition^2) is rounding is not taken.
      if (method == Method::pls && condition > 1e6) continue;
      CAPTURE(name(method), condition);
      const FitOptions options = all_components(5);
      const double lost = median_loss([&](unsigned seed) {
        const IllConditioned data(condition, seed);
        const auto reference = data.by_rows<long double>(method, options);
        REQUIRE(reference.condition_number > condition / 30);
        REQUIRE(reference.rank == 5);
        return loss(data.by_rows<double>(method, options), reference) / static_cast<double>(reference.condition_number);
      });
      CHECK(lost < 10 * epsilon);
      CHECK(lost > 1e-3 * epsilon);  // the reference is better than what it judges
    }
  }
}

TEST_CASE("a fit of double from moments loses the digits of the condition number squared", "[fit]") {
  for (const Method method : {Method::mlr, Method::pcr, Method::ridge, Method::pls}) {
    for (const double condition : {1e3, 1e4, 1e5}) {
      CAPTURE(name(method), condition);
      const FitOptions options = all_components(5);
      const double lost = median_loss([&](unsigned seed) {
        const IllConditioned data(condition, seed);
        const auto reference = data.by_rows<long double>(method, options);
        const double squared = std::pow(static_cast<double>(reference.condition_number), 2);
        return loss(data.by_moments<double>(method, options), reference) / squared;
      });
      CHECK(lost < 10 * epsilon);
      CHECK(lost > 1e-3 * epsilon);
    }
  }
}

TEST_CASE("moments kept in long double carry a fit past the condition number at which double refuses", "[fit]") {
  const FitOptions options = all_components(5);
  const IllConditioned data = with_condition(1.2e6, 4e6);  // beyond, double takes the last direction for rounding
  for (const Method method : {Method::mlr, Method::pcr, Method::ridge}) {
    CAPTURE(name(method));
    CHECK_THROWS_AS(data.by_moments<double>(method, options), Error);
    const auto reference = data.by_rows<long double>(method, options);
    const double squared = std::pow(static_cast<double>(reference.condition_number), 2);
    CHECK(loss(data.by_moments<long double>(method, options), reference) <
          10 * static_cast<double>(std::numeric_limits<long double>::epsilon()) * squared);
  }
}

TEST_CASE("a penalty keeps the digits that it leaves of the condition number", "[fit]") {
  FitOptions options;
  options.ridge_lambda = 1e-6;
  const double penalised_squared = 1e6;  // (variance + lambda) / lambda, the variance about 1
  const double lost = median_loss([&](unsigned seed) {
    const IllConditioned data(1e10, seed);
    return loss(data.by_moments<double>(Method::ridge, options), data.by_rows<long double>(Method::ridge, options));
  });
  CHECK(lost < 100 * penalised_squared * epsilon);
  CHECK(lost > 1e-4 * penalised_squared * epsilon);
}

TEST_CASE("S from moments loses the digits of the errors squared over S squared", "[fit]") {
  for (const double left : {1e-1, 1e-3, 1e-5}) {
    CAPTURE(left);
    const double lost = median_loss([&](unsigned seed) {
      IllConditioned data(10, seed);
      std::mt19937_64 generator(seed);
      std::normal_distribution<double> normal;
      data.errors += Matrix::NullaryExpr(60, 1, [&] { return left * normal(generator); });
      const LinearModel<> model = fit_mlr(data.moments<double>()).model;
      const double ours = residuals(model, data.moments<double>())[0].S();
      const long double exact = residuals(model.cast<long double>(), data.temperatures.cast<long double>(),
                                          data.errors.cast<long double>())[0]
                                    .S();
      const double scale = data.moments<double>().error_products()(0, 0) / 59;
      return static_cast<double>(std::abs(ours - exact) / exact) / (1 + scale / std::pow(left, 2));
    });
    CHECK(lost < 20 * epsilon);
    CHECK(lost > 1e-3 * epsilon);
  }
}

#endif

TEST_CASE("every scalar refuses moments at its own condition number, and says which", "[fit]") {
  CHECK(moments_condition_limit<float> == 1e2F);
  CHECK(moments_condition_limit<> == 1e6);
  const FitOptions options = all_components(5);
  const IllConditioned data = with_condition(120, 200);
  for (const Method method : {Method::mlr, Method::pcr, Method::ridge}) {
    CAPTURE(name(method));
    CHECK_NOTHROW(data.by_moments<double>(method, options));
    CHECK_NOTHROW(data.by_rows<float>(method, options));
    try {
      data.by_moments<float>(method, options);
      FAIL("accepted");
    } catch (const Error& error) {
      CHECK(error.allowed() == "1e2 or less for a fit from moments");
    }
  }
}

TEMPLATE_TEST_CASE("every fitter, from moments and from rows, keeps the digits of its scalar on data/vcenter55",
                   "[fit]", float, double) {
  for (const Method method : {Method::pls, Method::mlr, Method::pcr, Method::ridge}) {
    for (const Index components : {1, 2}) {
      FitOptions options = all_components(components);
      if (method == Method::ridge) options.ridge_lambda = .01;
      for (const Batch& batch : vcenter55()) {
        CAPTURE(name(method), components, batch.name);
        const auto ours = observe<TestType>(batch);
        const auto reference = observe<long double>(batch);
        const std::vector<Index> points = ByCorrelation{}(reference, 2);
        const auto exact = fit(method, reference.moments.subset(points), options);
        const auto of_moments = fit(method, ours.moments.subset(points), options);
        const auto of_rows = fit(method, ours.temperatures(Eigen::all, points), ours.errors, options);
        // One component is well conditioned; what a penalty adds to the smallest variance bounds the rest.
        const double condition = method == Method::ridge ? std::sqrt(2 / .01)
                                 : method != Method::mlr && components == 1
                                     ? 1
                                     : static_cast<double>(exact.condition_number);
        const double digit = static_cast<double>(std::numeric_limits<TestType>::epsilon());
        CHECK(loss(of_moments, exact) < 100 * condition * condition * digit);
        CHECK(loss(of_rows, exact) < 100 * condition * digit);
        const auto S = static_cast<double>(exact.residual_deviation_um(0));
        CHECK(static_cast<double>(of_moments.residual_deviation_um(0)) == Approx(S).epsilon(5000 * digit));
        CHECK(static_cast<double>(of_rows.residual_deviation_um(0)) == Approx(S).epsilon(500 * digit));
        const auto domain = training_domain(of_moments, ours.moments.subset(points));
        const auto exact_domain = training_domain(exact, reference.moments.subset(points));
        CHECK(domain.highest.template cast<double>().isApprox(exact_domain.highest.template cast<double>(), digit));
        CHECK(static_cast<double>(domain.t2_limit_99) ==
              Approx(static_cast<double>(exact_domain.t2_limit_99)).epsilon(10 * digit));
        CHECK(static_cast<double>(domain.spe_limit_99) ==
              Approx(static_cast<double>(exact_domain.spe_limit_99)).epsilon(1e5 * digit));
      }
    }
  }
}

TEST_CASE("a model trained in long double is the model trained in double, to double's digits", "[fit]") {
  const Campaign campaign = vcenter55();
  TrainingPlan plan;
  plan.points = {0, 2};
  const TrainedModel ours = train(campaign, plan);
  const TrainedModel reference = train<long double>(campaign, plan);
  CHECK(ours.model.coefficients.isApprox(reference.model.coefficients, 1e-13));
  CHECK(ours.substitutes[0].model.coefficients.isApprox(reference.substitutes[0].model.coefficients, 1e-13));
  CHECK(ours.domain.spe_limit_99 == Approx(reference.domain.spe_limit_99).epsilon(1e-9));
  CHECK(predict(ours, campaign[0]).S_um.isApprox(predict<long double>(ours, campaign[0]).S_um, 1e-13));
  CHECK(ours.components == reference.components);
}
