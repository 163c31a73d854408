#include "thermfit/fit/train_transfer.hpp"

#include "support/catch.hpp"
#include "support/transfer_campaign.hpp"
#include "thermfit/batch/climate.hpp"
#include "thermfit/features/feature_columns.hpp"
#include "thermfit/model/predict.hpp"

using namespace thermfit;

TEST_CASE("a trained transfer model predicts what its fit left of each batch", "[fit]") {
  const Campaign campaign = TransferMachine{20, .1, .4, 30}.campaign(9);
  for (const ErrorReference reference : {ErrorReference::recorded, ErrorReference::start, ErrorReference::batch}) {
    TransferPlan plan;
    plan.error_reference = reference;
    const TrainedModel model = train_transfer(campaign, plan);
    CHECK(model.method == "transfer");
    CHECK(model.temperatures.size() == 4);
    CHECK(model.inputs() == model.model.sensors());
    const TransferData<> data = transfer_data(campaign, plan);
    const TransferFit<> fit = fit_transfer(data.batches, 0, data.options);
    double squares = 0, rows = 0;
    for (std::size_t b = 0; b < campaign.size(); ++b) {
      const BatchPrediction prediction = predict(model, campaign[b]);
      CHECK(prediction.S_um(0) == Approx(residuals(fit, data.batches[b], 0).S()).epsilon(1e-6));
      squares += prediction.residuals.squaredNorm(), rows += static_cast<double>(campaign[b].rows());
    }
    const double taken = reference == ErrorReference::batch ? 9 : 1;
    CHECK(model.residual_deviation_um(0) == Approx(std::sqrt(squares / (rows - taken))).epsilon(1e-6));
  }
}

TEST_CASE("own intercepts and errors from the start do not see the probe's zero", "[fit]") {
  for (const ErrorReference reference : {ErrorReference::start, ErrorReference::batch}) {
    TransferPlan plan;
    plan.error_reference = reference;
    const TrainedModel near = train_transfer(TransferMachine{20, .1, .4, 0}.campaign(8), plan);
    const TrainedModel far = train_transfer(TransferMachine{20, .1, .4, 500}.campaign(8), plan);
    CHECK((near.model.coefficients - far.model.coefficients).norm() < 1e-6 * near.model.coefficients.norm());
    CHECK(near.model.intercept(0) == 0);
  }
}

TEST_CASE("a substitute leaves out all that its lost sensor gives", "[fit]") {
  const Campaign campaign = TransferMachine{20, .1, .4, 0}.campaign(8);
  const TrainedModel model = train_transfer(campaign);
  REQUIRE(model.substitutes.size() == 4);
  REQUIRE(model.inputs() == 12);
  for (const SubstituteModel& substitute : model.substitutes) {
    for (std::size_t f = 0; f < model.features.size(); ++f)
      if (model.features[f].point == substitute.lost)
        CHECK(substitute.model.coefficients(static_cast<Index>(f), 0) == 0);
    CHECK(substitute.residual_deviation_um(0) > .95 * model.residual_deviation_um(0));
    CHECK(substitute.agreement_um(0) > 0);
  }
}

TEST_CASE("the training domain is that of the features: a day whose lags are foreign is foreign", "[fit]") {
  const Campaign campaign = TransferMachine{20, .1, .4, 0}.campaign(10);
  const TrainedModel model = train_transfer(campaign);
  CHECK(predict(model, campaign[2]).share_beyond(model.domain, 99) < .05);
  Batch fast = campaign[2];
  fast.time_s *= .02;  // the same rises, before any lag has moved
  CHECK(predict(model, fast).share_beyond(model.domain, 99) > .2);
}

TEST_CASE("a model with lags refuses a batch without a clock", "[fit]") {
  const Campaign campaign = TransferMachine{20, .1, .4, 0}.campaign(8);
  const TrainedModel model = train_transfer(campaign);
  Batch batch = campaign[0];
  batch.time_s.resize(0);
  CHECK_THROWS_WITH(predict(model, batch), Catch::Contains("no clock"));
  TransferPlan none;
  none.lags_min = std::vector<double>{};
  CHECK(train_transfer(campaign, none).inputs() == 8);
  CHECK(predict(train_transfer(campaign, none), batch).errors.rows() == batch.rows());
}

TEST_CASE("rows without a measured error move the lags, not the fit", "[fit]") {
  Campaign campaign = TransferMachine{20, .1, 0, 0}.campaign(8);
  const TrainedModel whole = train_transfer(campaign);
  for (Batch& batch : campaign)
    for (Index row = 1; row < batch.rows(); row += 2) batch.errors.values(row, 0) = std::nan("");
  const TrainedModel half = train_transfer(campaign);
  CHECK((half.model.coefficients - whole.model.coefficients).norm() < .02 * whole.model.coefficients.norm());
}

TEST_CASE("features are what their names say", "[features]") {
  const Matrix rises = (Matrix(3, 2) << 0, 0, 2, 1, 4, -1).finished();
  const Vector time_s = (Vector(3) << 0, 60, 180).finished();
  const std::vector<Feature> features{{FeatureKind::rise, 1},
                                      {FeatureKind::lag, 0, -1, 10},
                                      {FeatureKind::climate, 1},
                                      {FeatureKind::difference, 0, 1}};
  const Matrix columns = feature_columns(features, rises, time_s, -3.);
  CHECK(columns.col(0) == rises.col(1));
  CHECK(columns.col(1) == lagged(rises.col(0), time_s, 600.));
  CHECK(columns.col(2) == -3 * rises.col(1));
  CHECK(columns.col(3) == rises.col(0) - rises.col(1));
}

TEST_CASE("the climate is the mean of the points where rises count from", "[batch]") {
  Batch batch;
  batch.temperatures.values = (Matrix(2, 3) << 10, 20, 99, 11, 21, 99).finished();
  CHECK(climate_degC(batch, {0, 1}) == 15);
  batch.first_degC = (Vector(3) << 8, 20, 99).finished();
  CHECK(climate_degC(batch, {0, 1}) == 14);
  CHECK(climate_degC(Batch(), {}) == 0);
}

TEST_CASE("a batch whose error was never measured changes nothing", "[fit]") {
  Campaign campaign = TransferMachine{20, .1, .3, 5}.campaign(7);
  const TrainedModel without = train_transfer(campaign);
  Batch blind = campaign[2];
  blind.errors.values.setConstant(std::nan(""));
  campaign.insert(campaign.begin() + 3, blind);
  const TransferData<> data = transfer_data(campaign);
  CHECK(data.batches[3].rows == 0);
  TransferOptions options = data.options;
  options.climate_penalty = HUGE_VAL;
  options.rise_penalty = options.lag_penalty = .01;
  options.scale = PenaltyScale::block;
  std::vector<TransferBatch<>> seen = data.batches;
  const TransferFit<> with = fit_transfer(seen, 0, options);
  seen.erase(seen.begin() + 3);
  const TransferFit<> less = fit_transfer(seen, 0, options);
  CHECK(with.coefficients.intercept_um == Approx(less.coefficients.intercept_um).epsilon(1e-12));
}

TEST_CASE("a rise without a first reading is refused by name, an unknown clock too", "[fit]") {
  Campaign campaign = TransferMachine{20, .1, .3, 5}.campaign(4);
  campaign[1].first_degC = Vector::Constant(4, 20);
  campaign[1].first_degC(2) = std::nan("");
  CHECK_THROWS_WITH(train_transfer(campaign), Catch::Contains("T3") && Catch::Contains("first row"));
  campaign[1].first_degC.resize(0);
  campaign[1].time_s.resize(0);
  TransferPlan plan;
  plan.lags_min = std::vector<double>{10};
  CHECK_THROWS_WITH(train_transfer(campaign, plan), Catch::Contains("no clock"));
  campaign[1].temperatures.names[0] = "other";
  CHECK_THROWS_WITH(train_transfer(campaign), Catch::Contains("other channels"));
  CHECK_THROWS_AS(train_transfer(Campaign{}), Error);
}

TEST_CASE("a batch beyond the climates of training is predicted as at their end, and what that withholds is known",
          "[model]") {
  Campaign campaign = TransferMachine{20, .1, .4, 0}.campaign(10);
  const TrainedModel model = train_transfer(campaign);
  CHECK(beyond_climate_um(model, campaign[2]) == Vector::Zero(1));
  Batch end = campaign[2];
  end.temperatures.values.array() += model.climate.highest - model_climate_degC(model, end);
  Batch far = end;
  far.temperatures.values.array() += 25;
  const Matrix clipped = predict(model, far).errors;
  CHECK((clipped - predict(model, end).errors).norm() < 1e-9 * clipped.norm());
  TrainedModel wider = model;  // as if the climate went on
  wider.climate.highest += 100;
  const Vector more = predict(wider, far).errors.col(0) - clipped.col(0);
  CHECK(beyond_climate_um(model, far)(0) == Approx(more.cwiseAbs().maxCoeff()).epsilon(1e-9));
  CHECK(beyond_climate_um(model, far)(0) > 1);
}

namespace {

/// Days whose error also follows a spindle that is on and off: 2 um per 1000 rpm at once, and 4 through 20 min.
Campaign with_spindle(std::size_t days) {
  Campaign campaign = TransferMachine{20, .1, .2, 0}.campaign(days);
  for (std::size_t b = 0; b < days; ++b) {
    Batch& batch = campaign[b];
    Matrix rpm(batch.rows(), 2);
    for (Index row = 0; row < batch.rows(); ++row) {
      rpm(row, 0) = (row / static_cast<Index>(15 + 7 * b)) % 2 == 0 ? 500. * static_cast<double>(1 + b % 4) : 0;
      rpm(row, 1) = static_cast<double>((17 * row + 5 * static_cast<Index>(b)) % 11);  // nothing follows it
    }
    batch.inputs = {{"rpm", "door"}, rpm};
    const Vector change = rpm.col(0).array() - rpm(0, 0);
    batch.errors.values.col(0) += .002 * change + .004 * lagged(rpm.col(0), batch.time_s, 1200.);
  }
  return campaign;
}

Index feature(const TrainedModel& model, const std::string& name) {
  for (Index f = 0; f < model.inputs(); ++f)
    if (model.input_name(f) == name) return f;
  return -1;
}

}  // namespace

TEST_CASE("known inputs and their lags are found in um per unit", "[fit]") {
  const Campaign campaign = with_spindle(10);
  TransferPlan plan;
  plan.error_reference = ErrorReference::start;
  const TrainedModel without = train_transfer(campaign, plan);
  CHECK(without.known_inputs.empty());
  plan.inputs = {"rpm"};
  const TrainedModel model = train_transfer(campaign, plan);
  REQUIRE(model.known_inputs == plan.inputs);
  REQUIRE(feature(model, "rpm") >= 0);
  REQUIRE(feature(model, "rpm lag 20 min") >= 0);
  CHECK(model.model.coefficients(feature(model, "rpm"), 0) == Approx(.002).epsilon(.1));
  CHECK(model.model.coefficients(feature(model, "rpm lag 20 min"), 0) == Approx(.004).epsilon(.1));
  const TransferData<> data = transfer_data(campaign, plan);
  const TransferFit<> fit = fit_transfer(data.batches, 0, data.options);
  for (std::size_t b = 0; b < campaign.size(); ++b) {
    const double own = predict(model, campaign[b]).S_um(0);
    CHECK(own == Approx(residuals(fit, data.batches[b], 0).S()).epsilon(1e-6));
    CHECK(own < .5 * predict(without, campaign[b]).S_um(0));
  }
}

TEST_CASE("in which unit an input is makes no difference", "[fit]") {
  Campaign campaign = with_spindle(8);
  TransferPlan plan;
  plan.inputs = {"rpm", "door"};
  const TrainedModel per_rpm = train_transfer(campaign, plan);
  for (Batch& batch : campaign) batch.inputs.values.col(0) /= 1000;
  const TrainedModel per_krpm = train_transfer(campaign, plan);
  const Matrix one = predict(per_krpm, campaign[3]).errors;
  for (Batch& batch : campaign) batch.inputs.values.col(0) *= 1000;
  CHECK((predict(per_rpm, campaign[3]).errors - one).norm() < 1e-6 * one.norm());
}

TEST_CASE("inputs and differences that do not pay vanish, and with them the need for their columns", "[fit]") {
  Campaign campaign = with_spindle(10);
  for (Batch& batch : campaign)  // nothing but a rise
    batch.errors.values.col(0) =
        3 * (batch.temperatures.values.col(0).array() - batch.temperatures.values(0, 0)).matrix();
  TransferPlan plan;
  plan.inputs = {"door"};
  plan.differences = {{"T2", "T4"}};
  const TrainedModel model = train_transfer(campaign, plan);
  for (Index f = 4; f < model.inputs(); ++f) CHECK(std::abs(model.model.coefficients(f, 0)) < .01);
}

TEST_CASE("a difference of two points is a feature of both, and goes with either", "[fit]") {
  Campaign campaign = TransferMachine{20, .1, .2, 0}.campaign(9);
  TransferPlan plan;
  plan.differences = {{"T1", "T2"}};
  plan.options.rise_penalty = 10;  // so that the difference pays
  plan.options.difference_penalty = .001;
  const TrainedModel model = train_transfer(campaign, plan);
  const Index f = feature(model, "T1 - T2");
  REQUIRE(f >= 0);
  CHECK(model.model.coefficients(f, 0) != 0);
  for (const SubstituteModel& substitute : model.substitutes)
    CHECK((substitute.model.coefficients(f, 0) == 0) == (substitute.lost < 2));
  const TransferData<> data = transfer_data(campaign, plan);
  const TransferFit<> fit = fit_transfer(data.batches, 0, data.options);
  CHECK(predict(model, campaign[5]).S_um(0) == Approx(residuals(fit, data.batches[5], 0).S()).epsilon(1e-6));
  plan.differences = {{"T1", "T9"}};
  CHECK_THROWS_WITH(train_transfer(campaign, plan), Catch::Contains("T9"));
}

TEST_CASE("a known input that is not there, or lacks a number, is refused by name", "[fit]") {
  Campaign campaign = with_spindle(6);
  TransferPlan plan;
  plan.inputs = {"rpm"};
  const TrainedModel model = train_transfer(campaign, plan);
  REQUIRE(!model.known_inputs.empty());
  CHECK_THROWS_WITH(require_no_inputs(model, "model.json"),
                    Catch::Contains("model.json: transfer.features") && Catch::Contains("rpm"));
  Batch blind = campaign[2];
  blind.inputs = {};
  CHECK_THROWS_WITH(predict(model, blind), Catch::Contains("no known input 'rpm'"));
  campaign[2].inputs.values(7, 0) = std::nan("");
  CHECK_THROWS_WITH(train_transfer(campaign, plan), Catch::Contains("'rpm' in row 8"));
  plan.inputs = {"feed"};
  CHECK_THROWS_WITH(train_transfer(campaign, plan), Catch::Contains("'feed'") && Catch::Contains("door"));
}

TEST_CASE("without a clock inputs have no lag, and still their changes", "[fit]") {
  Campaign campaign = with_spindle(8);
  campaign[3].time_s.resize(0);
  TransferPlan plan;
  plan.inputs = {"rpm"};
  const TrainedModel model = train_transfer(campaign, plan);
  CHECK(feature(model, "rpm") >= 0);
  for (const Feature& one : model.features) CHECK(one.kind != FeatureKind::input_lag);
  CHECK(predict(model, campaign[3]).errors.allFinite());
}
