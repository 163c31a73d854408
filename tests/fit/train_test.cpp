#include "thermfit/fit/train.hpp"

#include <random>

#include "support/catch.hpp"
#include "thermfit/model/outside_domain.hpp"

using namespace thermfit;

namespace {

/// Two warm sources seen by five sensors, one of which may be dead.
Campaign campaign(bool dead_sensor = false) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  Campaign batches;
  for (int b = 0; b < 4; ++b) {
    Batch batch;
    batch.name = "K" + std::to_string(b + 1);
    batch.temperatures = {{"T1", "T2", "T3", "T4", "T5"}, Matrix(40, 5)};
    batch.errors = {{"Y", "Z"}, Matrix(40, 2)};
    batch.time_s = Vector::LinSpaced(40, 0, 39 * 300);
    for (Index r = 0; r < 40; ++r) {
      const double a = 20 * (1 - std::exp(-static_cast<double>(r) / 10)), c = static_cast<double>(r) / 8;
      for (Index s = 0; s < 5; ++s) {
        const double mix = static_cast<double>(s) / 4;
        batch.temperatures.values(r, s) = 15 + b + a * (1 - mix) + c * mix + .05 * normal(generator);
      }
      if (dead_sensor) batch.temperatures.values(r, 4) = 21.3;
      batch.errors.values(r, 0) = 2 * a - c + .2 * normal(generator);
      batch.errors.values(r, 1) = a + 3 * c + .2 * normal(generator);
    }
    batches.push_back(batch);
  }
  return batches;
}

}  // namespace

TEST_CASE("a trained model is complete and predicts as its fit", "[fit]") {
  const Campaign batches = campaign();
  TrainingPlan plan;
  plan.points = {3, 0, 2};
  plan.options.components = ComponentRule::fixed(2);
  for (const Method method : {Method::pls, Method::mlr, Method::pcr, Method::ridge}) {
    plan.method = method;
    const TrainedModel model = train(batches, plan);
    CAPTURE(model.method);
    CHECK(model.temperatures == std::vector<std::string>{"T4", "T1", "T3"});
    CHECK(model.errors == std::vector<std::string>{"Y", "Z"});
    CHECK(model.method == name(method));
    CHECK(model.batches.size() == 4);
    CHECK(model.batches[2].rows == 40);
    CHECK(model.tool_version == THERMFIT_VERSION);
    CHECK(model.envelope.has_range());
    CHECK(model.envelope.has_rates());
    CHECK(model.condition_number > 1);
    CHECK(model.components == (method == Method::pls || method == Method::pcr ? 2 : 0));
    CHECK(model.degrees_of_freedom >= 160 - 1 - 3);
    CHECK(model.degrees_of_freedom <= 160 - 1 - 2);
    const auto rows = merged(observe(batches));
    const std::vector<Index> points{3, 0, 2};
    const Matrix chosen = rows.temperatures(Eigen::all, points);
    const Vector s = S(residuals(model.model, chosen, rows.errors));
    CHECK((s - model.residual_deviation_um).norm() < 1e-9);
    CHECK(s.maxCoeff() < .5);
    CHECK(model.domain.mean.isApprox(model.temperature_mean));
    CHECK(outside_shares(model.domain, chosen).range == 0);
    CHECK(outside_shares(model.domain, chosen).any < .05);
  }
}

TEST_CASE("rows and moments train the same model", "[fit]") {
  TrainingPlan plan;
  plan.options.components = ComponentRule::fixed(3);
  plan.options.ridge_lambda = .01;
  for (const Method method : {Method::pls, Method::mlr, Method::pcr, Method::ridge}) {
    plan.method = method;
    plan.row_wise = false;
    const TrainedModel moments = train(campaign(), plan);
    plan.row_wise = true;
    const TrainedModel rows = train(campaign(), plan);
    CHECK((moments.model.coefficients - rows.model.coefficients).norm() < 1e-10 * rows.model.coefficients.norm());
    CHECK(moments.condition_number == Approx(rows.condition_number).epsilon(1e-9));
    CHECK(moments.domain.spe_limit_99 == Approx(rows.domain.spe_limit_99).epsilon(1e-8));
  }
}

TEST_CASE("a substitute does without its sensor and is the fit on the others", "[fit]") {
  const Campaign batches = campaign();
  TrainingPlan plan;
  plan.method = Method::mlr;
  const TrainedModel model = train(batches, plan);
  REQUIRE(model.substitutes.size() == 5);
  for (Index lost = 0; lost < 5; ++lost) {
    const SubstituteModel& substitute = model.substitutes[static_cast<std::size_t>(lost)];
    CHECK(substitute.lost == lost);
    CHECK(substitute.model.coefficients.row(lost).norm() == 0);
    std::vector<Index> others;
    for (Index p = 0; p < 5; ++p) {
      if (p != lost) others.push_back(p);
    }
    const auto rows = merged(observe(batches));
    const LinearFit<> direct = fit_mlr(rows.temperatures(Eigen::all, others), rows.errors);
    CHECK((substitute.model.coefficients(others, Eigen::all) - direct.model.coefficients).norm() <
          1e-9 * direct.model.coefficients.norm());
    CHECK((substitute.residual_deviation_um - direct.residual_deviation_um).norm() < 1e-9);
    CHECK((substitute.residual_deviation_um.array() >= model.residual_deviation_um.array()).all());
  }
  plan.points = {1};
  CHECK(train(batches, plan).substitutes.empty());
}

TEST_CASE("a sensor that was dead in training gets no say, and is noticed when it moves", "[fit]") {
  for (const Method method : {Method::pls, Method::mlr, Method::pcr, Method::ridge}) {
    TrainingPlan plan;
    plan.method = method;
    plan.options.components = ComponentRule::fixed(2);
    plan.options.ridge_lambda = .001;
    const TrainedModel model = train(campaign(true), plan);
    CHECK(model.model.coefficients.row(4).norm() == 0);
    CHECK(model.temperature_scale(4) == 1);
    Vector sample = model.domain.mean;
    CHECK_FALSE(outside_domain(model.domain, sample).any());
    sample(4) += 3;
    CHECK(outside_domain(model.domain, sample).spe);
    CHECK(outside_domain(model.domain, sample).range);
  }
}

TEST_CASE("batches with other channels, and no batch, are refused", "[fit]") {
  Campaign batches = campaign();
  batches[2].temperatures.names[1] = "T9";
  CHECK_THROWS_AS(train(batches), Error);
  CHECK_THROWS_AS(train({}), Error);
  TrainingPlan plan;
  plan.points = {7};
  CHECK_THROWS_AS(train(campaign(), plan), Error);
}
