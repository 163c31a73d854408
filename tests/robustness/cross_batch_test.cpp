#include "thermfit/robustness/cross_batch.hpp"

#include "support/catch.hpp"
#include "support/numeric_csv.hpp"
#include "support/shared_data.hpp"
#include "support/thermal_rows.hpp"
#include "thermfit/fit/fit.hpp"
#include "thermfit/robustness/leave_one_batch_out.hpp"
#include "thermfit/select/correlation.hpp"

using namespace thermfit;

namespace {

std::vector<Observations<>> campaign(Index responses = 1, int count = 5) {
  std::vector<Observations<>> batches;
  for (int b = 0; b < count; ++b) {
    const ThermalRows rows(30 + 5 * b, 6, responses, static_cast<unsigned>(b), .4);
    Batch batch;
    batch.name = "K" + std::to_string(b + 1);
    batch.temperatures.values = rows.temperatures;
    batch.errors.values = rows.errors;
    batches.push_back(observe(batch));
  }
  return batches;
}

FitOptions fixed(Index components) {
  FitOptions options;
  options.components = ComponentRule::fixed(components);
  return options;
}

}  // namespace

TEST_CASE("S between batches from moments equals S from rows", "[robustness]") {
  const std::vector<Observations<>> batches = campaign(2);
  const SweepStep<> step =
      cross_batch(batches, ByCorrelation{}, 3, [](const Moments<>& m) { return fit_pls(m, fixed(2)); });
  REQUIRE(step.S.size() == 2);
  for (Index m = 0; m < 5; ++m) {
    const BatchModel<>& model = step.models[static_cast<std::size_t>(m)];
    REQUIRE(model.points.size() == 3);
    for (Index b = 0; b < 5; ++b) {
      const Observations<>& batch = batches[static_cast<std::size_t>(b)];
      const Matrix error = model.fit.model.predict_rows(batch.temperatures(Eigen::all, model.points)) - batch.errors;
      for (Index e = 0; e < 2; ++e) {
        const double S = std::sqrt(error.col(e).squaredNorm() / static_cast<double>(error.rows() - 1));
        CHECK(step.S[static_cast<std::size_t>(e)](m, b) == Approx(S).epsilon(1e-10));
      }
    }
  }
  CHECK((step.models[1].fit.residual_deviation_um - Vector(Eigen::Vector2d(step.S[0](1, 1), step.S[1](1, 1)))).norm() <
        1e-9);
}

TEST_CASE("the study of another implementation comes out, for every model batch and number of points", "[robustness]") {
  REQUIRE_SHARED_DATA(folder);
  std::vector<Observations<>> batches;
  for (int b = 1; b <= 12; ++b) {
    const NumericCsv csv(folder + "/pls_reference/study/batch_0" + (b < 10 ? "0" : "") + std::to_string(b) + ".csv");
    Batch batch;
    batch.temperatures.values = csv.columns("T1", "T10");
    batch.errors.values = csv.columns("Z", "Z");
    batches.push_back(observe(batch, TemperatureReference::absolute));
  }
  for (const auto& [file, components, scaling] :
       {std::tuple<std::string, Index, Scaling>{"study_W1_nc1_sklearn", 1, Scaling::centre},
        {"study_W1_nc2_sklearn", 2, Scaling::centre},
        {"study_W1_nc2_scaled_sklearn", 2, Scaling::both}}) {
    FitOptions options = fixed(components);
    options.scaling = scaling;
    const auto steps = sweep_points(batches, ByCorrelation{}, [&](const Moments<>& m) { return fit_pls(m, options); });
    const NumericCsv reference(folder + "/pls_reference/study/" + file + ".csv");
    REQUIRE(reference.values.rows() == 120);
    double worst = 0;
    for (Index r = 0; r < 120; ++r) {
      const auto model = static_cast<std::size_t>(reference.values(r, 0)) - 1;
      const auto k = static_cast<std::size_t>(reference.values(r, 1)) - 1;
      const MeanAndStd<>& ours = steps[k].robustness[0].models[model];
      // Their S_std divides by n - 1, over the eleven other batches.
      worst = std::max({worst, std::abs(ours.S_mean / reference.values(r, 2) - 1),
                        std::abs(ours.S_std * std::sqrt(11.0 / 10.0) / reference.values(r, 3) - 1)});
    }
    CAPTURE(file, worst);
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("any callable is a fitter, and its error names the batch", "[robustness]") {
  const std::vector<Observations<>> batches = campaign();
  const auto mean_only = [](const Moments<>& m) {
    return LinearModel<>{Matrix::Zero(m.temperatures(), m.errors()), m.error_mean()};
  };
  const auto steps = sweep_points(batches, ByCorrelation{}, mean_only, 2);
  CHECK(steps.size() == 2);
  CHECK(steps[0].S[0](0, 0) == Approx(std::sqrt(batches[0].moments.error_products()(0, 0) /
                                                static_cast<double>(batches[0].moments.rows() - 1))));
  const auto fails = [](const Moments<>& m) -> LinearFit<> {
    if (m.rows() == 40) throw Error("fit", "bad luck");
    return fit_mlr(m);
  };
  CHECK_THROWS_WITH(cross_batch(batches, ByCorrelation{}, 2, fails), Catch::Contains("batch K3: fit: bad luck"));
}

TEST_CASE("batches left out are predicted by the others alone, and every figure follows from the rows",
          "[robustness]") {
  const std::vector<Observations<>> batches = campaign(1, 4);
  const LeftOut<> left_out = leave_one_batch_out(moments_of(batches), [](const Moments<>& m) { return fit_mlr(m); });
  Residuals<> pooled;
  double sum = 0, worst_rmse = 0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    std::vector<Observations<>> rest = batches;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    const Observations<> others = merged(rest);
    const LinearFit<> fit = fit_mlr(others.temperatures, others.errors);
    const Residuals<> rows = residuals(fit.model, batches[i].temperatures, batches[i].errors)[0];
    const Residuals<>& ours = left_out.residuals[i][0];
    CHECK(ours.rmse() == Approx(rows.rmse()).epsilon(1e-9));
    CHECK(ours.S() == Approx(rows.S()).epsilon(1e-9));
    CHECK(ours.rmse_without_bias() == Approx(rows.rmse_without_bias()).epsilon(1e-9));
    CHECK(ours.mean == Approx(rows.mean).margin(1e-9));
    sum += rows.rmse();
    if (rows.rmse() > worst_rmse) {
      worst_rmse = rows.rmse();
      worst = i;
    }
    pooled.add(rows);
  }
  CHECK(left_out.mean(0, &Residuals<>::rmse) == Approx(sum / 4));
  CHECK(left_out.worst(0, &Residuals<>::rmse) == worst);
  CHECK(left_out.pooled(0).rmse() == Approx(pooled.rmse()));
}

TEST_CASE("a fitter that takes several batches chooses its components without the one left out", "[robustness]") {
  const std::vector<Moments<>> batches = moments_of(campaign());
  FitOptions options;
  options.components = ComponentRule::leave_one_batch_out();
  const LeftOut<> nested =
      leave_one_batch_out(batches, [&](const std::vector<Moments<>>& others) { return fit_pls(others, options); });
  for (std::size_t i = 0; i < batches.size(); ++i) {
    std::vector<Moments<>> rest = batches;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    CHECK(nested.fits[i].components == fit_pls(rest, options).components);
  }
  CHECK_THROWS_AS(leave_one_batch_out(std::vector{batches[0]}, [](const Moments<>& m) { return fit_mlr(m); }), Error);
}
