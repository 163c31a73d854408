#include "thermfit/robustness/transfer_left_out.hpp"

#include "support/catch.hpp"
#include "support/numeric_csv.hpp"
#include "support/shared_data.hpp"
#include "support/transfer_campaign.hpp"

using namespace thermfit;

namespace {

std::vector<TransferBatch<>> seen(const Campaign& campaign) {
  std::vector<TransferBatch<>> batches;
  const std::vector<double> lags_min = visible_lags_min(campaign);
  for (const Batch& batch : campaign) {
    std::vector<Index> points;
    for (Index p = 0; p < batch.temperatures.values.cols(); ++p) points.push_back(p);
    batches.push_back(transfer_batch(batch, points, lags_min));
  }
  return batches;
}

/// Batches of a folder, their rows taken as minutes, errors from the first.
Campaign measured(const std::string& stem, int digits, int count, const std::string& first, const std::string& last,
                  const std::string& error) {
  Campaign campaign;
  for (int b = 1; b <= count; ++b) {
    std::string number = std::to_string(b);
    while (static_cast<int>(number.size()) < digits) number.insert(0, "0");
    const NumericCsv csv(stem + number + ".csv");
    Batch batch;
    batch.temperatures.values = csv.columns(first, last);
    batch.errors.values = csv.columns(error, error);
    batch.errors.values.array() -= batch.errors.values(0, 0);
    batch.time_s = Vector::LinSpaced(batch.rows(), 0, 60 * static_cast<double>(batch.rows() - 1));
    campaign.push_back(std::move(batch));
  }
  return campaign;
}

MeanAndStd<> left_out(const Campaign& campaign) {
  TransferOptions options;
  options.intercept = false;
  return transfer_left_out(seen(campaign), 1, options).figure(0);
}

}  // namespace

TEST_CASE("a batch takes no part in the choice of what predicts it", "[robustness]") {
  std::vector<TransferBatch<>> batches = seen(TransferMachine{20, .1, .5, 0}.campaign(7, 100));
  const TransferLeftOut<> before = transfer_left_out(batches, 1);
  batches[3].products[2] *= 1e6;  // nonsense in one batch, also in its climate
  batches[3].products[0] *= 4;
  batches[3].climate_degC = 60;
  const TransferLeftOut<> after = transfer_left_out(batches, 1);
  const auto same = [&](std::size_t out) {
    const TransferFit<>&a = before.fits[out][0], &b = after.fits[out][0];
    return a.coefficients.rise == b.coefficients.rise && a.coefficients.climate == b.coefficients.climate &&
           a.coefficients.lagged == b.coefficients.lagged && a.penalties.lag_index == b.penalties.lag_index &&
           a.penalties.rise == b.penalties.rise && a.climate.highest == b.climate.highest;
  };
  CHECK(same(3));
  CHECK_FALSE(same(0));
}

TEST_CASE("threads change no digit", "[robustness]") {
  const std::vector<TransferBatch<>> batches = seen(TransferMachine{20, .1, .5, 0}.campaign(6, 80));
  const TransferLeftOut<> one = transfer_left_out(batches, 1, {}, 1), four = transfer_left_out(batches, 1, {}, 4);
  for (std::size_t b = 0; b < batches.size(); ++b)
    CHECK(one.residuals[b][0].sum_of_squares() == four.residuals[b][0].sum_of_squares());
}

TEST_CASE("transfer predicts days it has not seen, to the noise of the probe", "[robustness]") {
  const MeanAndStd<> figure = left_out(TransferMachine{20, .1, .3, 0}.campaign(12));
  CHECK(figure.S_mean < .6);
  CHECK(figure.S_mean > .28);
  CHECK_THROWS_AS(transfer_left_out(seen(TransferMachine{}.campaign(2)), 1), Error);
}

TEST_CASE("trained on the cold half, the hot half is worse but bounded, and the other way", "[robustness]") {
  Campaign campaign = TransferMachine{20, .1, .3, 0}.campaign(16);
  std::sort(campaign.begin(), campaign.end(),
            [](const Batch& a, const Batch& b) { return a.temperatures.values(0, 0) < b.temperatures.values(0, 0); });
  const std::vector<TransferBatch<>> batches = seen(campaign);
  for (const bool cold : {true, false}) {
    const auto middle = batches.begin() + 8;
    const std::vector<TransferBatch<>> own(cold ? batches.begin() : middle, cold ? middle : batches.end());
    TransferOptions options;
    options.intercept = false;
    const TransferFit<> fit = fit_transfer(own, 0, options);
    for (std::size_t b = cold ? 8 : 0; b < (cold ? 16u : 8u); ++b) {
      const double beyond =
          batches[b].climate_degC - std::clamp(batches[b].climate_degC, fit.climate.lowest, fit.climate.highest);
      // What the clipped climate leaves: .1 um/K^2 times 12 K at most, times what lies beyond; and 1 um of the fit.
      CHECK(residuals(fit, batches[b], 0).S() < 1 + 1.2 * std::abs(beyond));
    }
  }
}

TEST_CASE("a lathe of eighteen days and a machine of five runs, each predicted by the others", "[robustness]") {
  REQUIRE_SHARED_DATA(folder);
  const MeanAndStd<> lathe =
      left_out(measured(folder + "/real/ace_lathe/day", 2, 18, "Ambient", "Spindle Front", "Dia Disp"));
  CHECK(lathe.S_mean < 4.66);
  CHECK(lathe.S_std < 2.53);
  const MeanAndStd<> machine = left_out(measured(folder + "/real/gooddash/run", 1, 5, "dT00", "dT21", "err"));
  CHECK(machine.S_mean < .75);
  CHECK(machine.S_std < .34);
}
