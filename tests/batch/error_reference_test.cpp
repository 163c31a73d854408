#include "thermfit/batch/error_reference.hpp"

#include <random>

#include "support/catch.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/model/predict.hpp"
#include "thermfit/robustness/study.hpp"

using namespace thermfit;

namespace {

constexpr double tau = 12;

/// Two thermometers and an error that follows them, with a zero of the probe for each batch.
Campaign campaign(const std::vector<double>& zeros_um, double noise = .3, unsigned seed = 3) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Campaign batches;
  for (std::size_t b = 0; b < zeros_um.size(); ++b) {
    Batch batch;
    batch.name = "K" + std::to_string(b + 1);
    const Index rows = 50 + 7 * static_cast<Index>(b);
    batch.temperatures = {{"T1", "T2"}, Matrix(rows, 2)};
    batch.errors = {{"Z"}, Matrix(rows, 1)};
    for (Index r = 0; r < rows; ++r) {
      const double time = static_cast<double>(r), size = 1 + .3 * static_cast<double>(b);
      const double a = 8 * size * (1 - std::exp(-time / tau)), c = 3 * std::sin(time / 9 + static_cast<double>(b));
      batch.temperatures.values.row(r) << 20 + a + .02 * normal(generator), 21 + c + .02 * normal(generator);
      batch.errors.values(r, 0) =
          zeros_um[b] + 3 * a + 2 * (c - 3 * std::sin(static_cast<double>(b))) + noise * normal(generator);
    }
    batches.push_back(batch);
  }
  return batches;
}

TrainingPlan plan_for(ErrorReference reference, Method method = Method::mlr) {
  TrainingPlan plan;
  plan.method = method;
  plan.error_reference = reference;
  return plan;
}

const std::vector<double> zeros{0, 450, -1200, 37};

}  // namespace

TEST_CASE("the probe's zero changes no model whose errors count from their start, or about their own intercept",
          "[batch]") {
  for (const ErrorReference reference : {ErrorReference::start, ErrorReference::batch})
    for (const Method method : {Method::mlr, Method::pls, Method::pcr, Method::ridge})
      for (const bool row_wise : {false, true}) {
        if (row_wise && method == Method::ridge) continue;
        CAPTURE(name(reference), name(method), row_wise);
        TrainingPlan plan = plan_for(reference, method);
        plan.row_wise = row_wise;
        const TrainedModel zeroed = train(campaign({0, 0, 0, 0}), plan), with = train(campaign(zeros), plan);
        CHECK(with.model.coefficients.isApprox(zeroed.model.coefficients, 1e-9));
        CHECK(with.model.intercept(0) == Approx(zeroed.model.intercept(0)).margin(1e-9));
        CHECK(with.residual_deviation_um(0) == Approx(zeroed.residual_deviation_um(0)));
        CHECK(with.degrees_of_freedom == zeroed.degrees_of_freedom);
        CHECK(with.domain.t2_limit_99 == zeroed.domain.t2_limit_99);
        CHECK(with.error_reference == reference);
      }
  CHECK(train(campaign(zeros), plan_for(ErrorReference::recorded)).residual_deviation_um(0) > 500);
}

TEST_CASE("own intercepts are least squares with a column of ones for each batch", "[batch]") {
  const Campaign batches = campaign(zeros);
  Index rows = 0;
  for (const Batch& batch : batches) rows += batch.rows();
  const Index K = static_cast<Index>(batches.size());
  Matrix design = Matrix::Zero(rows, 2 + K);
  Vector z(rows);
  Index first = 0;
  for (Index b = 0; b < K; ++b) {
    const Batch& batch = batches[static_cast<std::size_t>(b)];
    design.block(first, 0, batch.rows(), 2) = batch.temperatures.values;
    design.block(first, 2 + b, batch.rows(), 1).setOnes();
    z.segment(first, batch.rows()) = batch.errors.values;
    first += batch.rows();
  }
  const Vector dummies = design.householderQr().solve(z);
  const double square = (design * dummies - z).squaredNorm();
  for (const bool row_wise : {false, true}) {
    TrainingPlan plan = plan_for(ErrorReference::batch);
    plan.row_wise = row_wise;
    const TrainedModel model = train(batches, plan);
    CHECK(model.model.coefficients(0, 0) == Approx(dummies(0)));
    CHECK(model.model.coefficients(1, 0) == Approx(dummies(1)));
    CHECK(model.model.intercept(0) == 0);
    CHECK(model.degrees_of_freedom == rows - K - 2);
    CHECK(model.residual_deviation_um(0) == Approx(std::sqrt(square / static_cast<double>(rows - K))));
    CHECK(model.domain.highest(0) > 8);  // rises, not deviations from a mean
    CHECK(model.domain.lowest(0) < 1);
  }
}

TEST_CASE("measured errors are judged by the reference of the model", "[batch]") {
  for (const ErrorReference reference : {ErrorReference::start, ErrorReference::batch}) {
    const TrainedModel model = train(campaign(zeros), plan_for(reference));
    const Campaign fresh = campaign({-70, 12345}, .3, 11);
    for (const Batch& batch : fresh) {
      const BatchPrediction predicted = predict(model, batch);
      CHECK(predicted.S_um(0) < 1.5);
      CHECK(predicted.errors(0, 0) == Approx(model.model.intercept(0)).margin(1e-9));
      if (reference == ErrorReference::batch) CHECK(std::abs(predicted.residuals.col(0).mean()) < 1e-9);
    }
  }
}

TEST_CASE("an error that begins later than the rises has moved by what is predicted", "[batch]") {
  const TrainedModel model = train(campaign(zeros), plan_for(ErrorReference::start));
  Batch late = campaign({250}, .01, 5)[0];
  late.errors.values.topRows(20).setConstant(std::nan(""));
  const BatchPrediction predicted = predict(model, late);
  CHECK(std::isnan(predicted.residuals(3, 0)));
  CHECK(predicted.S_um(0) < 1.5);
  CHECK(predicted.errors(19, 0) > 15);
}

TEST_CASE("a first reading that is off is no zero", "[batch]") {
  Campaign batches = campaign(zeros);
  const TrainedModel good = train(batches, plan_for(ErrorReference::start));
  for (const double bad : {0., 999.9, 9.9e6}) {
    batches[2].errors.values(0, 0) = bad;
    const ErrorStart start = error_start(batches[2].errors.values.col(0));
    CHECK(start.value_um == Approx(-1200).margin(3));
    CHECK(start.off_um == Approx(std::abs(bad + 1200)).epsilon(.01));
  }
  CHECK(good.model.coefficients.allFinite());
}

TEST_CASE("the start is the first reading there is, and none where there is none", "[batch]") {
  Vector error = Vector::LinSpaced(20, 5, 24);
  CHECK(error_start(error).row == 0);
  CHECK(error_start(error).value_um == 5);
  error.head(3).setConstant(std::nan(""));
  CHECK(error_start(error).row == 3);
  CHECK(error_start(error).value_um == 8);
  error.setConstant(std::nan(""));
  CHECK(error_start(error).row == -1);
}

TEST_CASE("S across batches knows no zero of the probe", "[batch]") {
  StudyOptions options;
  options.points = 2;
  for (const ErrorReference reference : {ErrorReference::start, ErrorReference::batch}) {
    const auto mean_of = [&](const Campaign& batches) {
      const Study<> result = study(observe(batches, TemperatureReference::rise, reference), options);
      return result.methods.front().chosen()->robustness[0].per_model.S_mean;
    };
    CHECK(mean_of(campaign(zeros)) == Approx(mean_of(campaign({0, 0, 0, 0}))).epsilon(1e-6));
  }
}

TEST_CASE("absolute temperatures go with recorded errors only", "[batch]") {
  for (const ErrorReference reference : {ErrorReference::start, ErrorReference::batch})
    CHECK_THROWS_AS(observe(campaign(zeros), TemperatureReference::absolute, reference), Error);
  CHECK_NOTHROW(observe(campaign(zeros), TemperatureReference::absolute));
}

TEST_CASE("moments about own means merge without a term between batches, a degree of freedom each", "[moments]") {
  const Campaign batches = campaign(zeros);
  const std::vector<Observations<>> seen = observe(batches, TemperatureReference::rise, ErrorReference::batch);
  const Moments<> all = merged(moments_of(seen));
  Matrix products = Matrix::Zero(2, 2);
  Index rows = 0;
  for (const Observations<>& batch : seen)
    products += batch.moments.temperature_products(), rows += batch.moments.rows();
  CHECK(all.temperature_products().isApprox(products, 1e-12));
  CHECK(all.temperature_mean().isZero());
  CHECK(all.rows() == rows - 3);
  CHECK(merged(seen).temperatures.rows() == rows);
  Moments<> mixed = observe(batches[0]).moments;
  CHECK_THROWS_AS(mixed.merge(seen[1].moments), Error);
}
