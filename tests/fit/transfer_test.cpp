#include "thermfit/fit/transfer.hpp"

#include <Eigen/QR>
#include <limits>

#include "support/catch.hpp"
#include "support/transfer_campaign.hpp"
#include "thermfit/features/climate_range.hpp"

using namespace thermfit;

namespace {

std::vector<TransferBatch<>> seen(const Campaign& campaign, const std::vector<double>& lags_min) {
  std::vector<TransferBatch<>> batches;
  for (const Batch& batch : campaign) {
    std::vector<Index> points;
    for (Index p = 0; p < batch.temperatures.count(); ++p) points.push_back(p);
    batches.push_back(transfer_batch(batch, points, lags_min));
  }
  return batches;
}

std::vector<TransferBatch<>> seen(const Campaign& campaign) { return seen(campaign, visible_lags_min(campaign)); }

}  // namespace

TEST_CASE("transfer finds the coefficients, the lag and the climate that errors are made of", "[fit]") {
  const Campaign campaign = TransferMachine{20, .1, 0, 0}.campaign(12);
  CHECK(visible_lags_min(campaign) == std::vector<double>{5, 7, 10, 14, 20, 28, 40});
  TransferOptions options;
  options.intercept = false;
  const TransferFit<> fit = fit_transfer(seen(campaign), 0, options);
  CHECK(fit.penalties.lag_index == 4);
  CHECK(fit.coefficients.rise(0) == Approx(2).margin(.05));
  CHECK(fit.coefficients.lagged(0) == Approx(-3).margin(.05));
  CHECK(fit.coefficients.lagged(1) == Approx(1.5).margin(.05));
  CHECK(fit.coefficients.climate(2) == Approx(.1).margin(.005));
  for (const TransferBatch<>& batch : seen(campaign)) CHECK(residuals(fit, batch, 0).S() < .1);
}

TEST_CASE("transfer solves ridge on the rows of all columns, batches weighted alike", "[fit]") {
  Campaign campaign = TransferMachine{20, .1, .3, 5}.campaign(5, 60);
  campaign[1] = TransferMachine{20, .1, .3, 5}.campaign(1, 200, 4, 9).front();
  const std::vector<TransferBatch<>> batches = seen(campaign, {20});
  TransferOptions options;
  options.rise_penalty = .01, options.lag_penalty = .1, options.climate_penalty = .03;
  options.scale = PenaltyScale::column;
  const TransferFit<> fit = fit_transfer(batches, 0, options);

  Matrix a(440 + 12, 13);
  Vector y = Vector::Zero(a.rows());
  a.setZero();
  Index row = 0;
  double mean = 0;
  for (const TransferBatch<>& batch : batches) mean += batch.climate_degC / 5;
  for (const Batch& batch : campaign) {
    const Matrix rise = model_temperatures(batch, TemperatureReference::rise);
    const double weight = 1 / std::sqrt(static_cast<double>(batch.rows()));
    const double climate = batch.temperatures.values.row(0).mean() - mean;
    auto own = a.middleRows(row, batch.rows());
    own << weight * rise, weight * lagged(rise, batch.time_s, 1200.), weight * climate * rise,
        Vector::Constant(batch.rows(), weight);
    y.segment(row, batch.rows()) = weight * batch.errors.values.col(0);
    row += batch.rows();
  }
  for (Index c = 0; c < 12; ++c)
    a(row + c, c) = std::sqrt((c < 4 ? .01 : c < 8 ? .1 : .03)) * a.col(c).head(row).norm();
  const Vector b = a.householderQr().solve(y);
  CHECK((fit.coefficients.rise - b.head(4)).norm() < 1e-8 * b.norm());
  CHECK((fit.coefficients.lagged - b.segment(4, 4)).norm() < 1e-8 * b.norm());
  CHECK((fit.coefficients.climate - b.segment(8, 4)).norm() < 1e-8 * b.norm());
  CHECK(fit.coefficients.intercept_um == Approx(b(12)));

  const Vector left = a.middleRows(60, 200) * b - y.segment(60, 200);  // the long batch, weighted
  CHECK(residuals(fit, batches[1], 0).sum_of_squares() == Approx(left.squaredNorm() * 200));
  CHECK(residuals(fit, batches[1], 0).mean == Approx(left.mean() * std::sqrt(200.)));
}

TEST_CASE("the order of batches makes no difference", "[fit]") {
  std::vector<TransferBatch<>> batches = seen(TransferMachine{20, .1, .5, 0}.campaign(15, 100));
  const TransferFit<> one = fit_transfer(batches, 0);
  std::rotate(batches.begin(), batches.begin() + 4, batches.end());
  std::swap(batches[2], batches[9]);
  const TransferFit<> other = fit_transfer(batches, 0);
  CHECK(one.penalties.rise == other.penalties.rise);
  CHECK(one.penalties.lag == other.penalties.lag);
  CHECK(one.penalties.climate == other.penalties.climate);
  CHECK(one.penalties.lag_index == other.penalties.lag_index);
  CHECK((one.coefficients.rise - other.coefficients.rise).norm() < 1e-9 * one.coefficients.rise.norm());
}

TEST_CASE("blocks that do not pay vanish", "[fit]") {
  Campaign campaign = TransferMachine{20, 0, .3, 0}.campaign(10);
  for (Batch& batch : campaign)  // nothing but a rise
    batch.errors.values.col(0) =
        3 * (batch.temperatures.values.col(0).array() - batch.temperatures.values(0, 0)).matrix();
  const TransferFit<> fit = fit_transfer(seen(campaign), 0);
  CHECK(fit.coefficients.lagged.norm() < .01);
  CHECK(fit.coefficients.climate.norm() < .001);
  CHECK(fit.coefficients.rise(0) == Approx(3).margin(.01));
}

TEST_CASE("batches that all start alike have no climate", "[fit]") {
  Campaign campaign = TransferMachine{}.campaign(6);
  for (Batch& batch : campaign) batch.temperatures.values.array() += 20 - batch.temperatures.values(0, 0);
  const TransferFit<> fit = fit_transfer(seen(campaign), 0);
  CHECK(std::isinf(fit.penalties.climate));
  CHECK(fit.coefficients.climate.isZero(0));
}

TEST_CASE("batches without a clock have no lag", "[fit]") {
  Campaign campaign = TransferMachine{}.campaign(6);
  campaign[3].time_s.resize(0);
  CHECK(visible_lags_min(campaign).empty());
  const TransferFit<> fit = fit_transfer(seen(campaign), 0);
  CHECK(std::isinf(fit.penalties.lag));
  CHECK(fit.coefficients.lagged.isZero(0));
  CHECK(fit.coefficients.rise.size() == 4);
}

TEST_CASE("a climate beyond training counts as its end", "[fit]") {
  const ClimateRange<> range{5, 25, 16};
  CHECK(range.factor(-10) == -11);
  CHECK(range.factor(20) == 4);
  CHECK(range.factor(40) == 9);
  CHECK(range.beyond_K(40) == 15);
  CHECK(range.beyond_K(20) == 0);
  CHECK(range.beyond_K(0) == 5);
}

TEST_CASE("two errors are chosen for each by itself, one batch is refused", "[fit]") {
  Campaign campaign = TransferMachine{20, .1, .2, 0}.campaign(8);
  const Campaign slow = TransferMachine{40, 0, .2, 0}.campaign(8);
  for (std::size_t b = 0; b < campaign.size(); ++b) {
    campaign[b].errors.values.conservativeResize(Eigen::NoChange, 2);
    campaign[b].errors.values.col(1) = slow[b].errors.values.col(0);
  }
  const std::vector<TransferBatch<>> batches = seen(campaign);
  CHECK(fit_transfer(batches, 0).penalties.lag_index == 4);
  CHECK(fit_transfer(batches, 1).penalties.lag_index == 6);
  const Vector alone = fit_transfer(seen(slow), 0).coefficients.rise;
  CHECK((fit_transfer(batches, 1).coefficients.rise - alone).norm() < 1e-9 * alone.norm());
  CHECK_THROWS_AS(fit_transfer(std::vector<TransferBatch<>>{batches[0]}, 0), Error);
}

TEST_CASE("the clip bounds what a climate can do: beyond training no climate takes a prediction further", "[fit]") {
  Campaign campaign = TransferMachine{20, .1, .3, 0}.campaign(12);
  TransferOptions options;
  options.intercept = false;
  const TransferFit<> fit = fit_transfer(seen(campaign), 0, options);
  REQUIRE(fit.coefficients.climate.norm() > 0);
  Campaign far{campaign[4], campaign[4]};
  const double own = far[0].temperatures.values.row(0).mean();
  far[0].temperatures.values.array() += fit.climate.highest - own;
  far[1].temperatures.values.array() += fit.climate.highest + 30 - own;
  const std::vector<TransferBatch<>> at = seen(far, visible_lags_min(campaign));
  CHECK(residuals(fit, at[1], 0).S() == Approx(residuals(fit, at[0], 0).S()).epsilon(1e-9));
  CHECK(withheld_by_climate_um(fit, at[0]) == Approx(0).margin(1e-9));
  const Matrix rise = model_temperatures(far[1], TemperatureReference::rise);
  CHECK(withheld_by_climate_um(fit, at[1]) ==
        Approx(30 * (rise * fit.coefficients.climate).norm() / std::sqrt(rise.rows())).epsilon(1e-6));
}
