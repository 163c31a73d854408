#include "thermfit/calibration/batch_numbers.hpp"

#include "support/bench_campaign.hpp"
#include "support/catch.hpp"
#include "thermfit/calibration/calibrate.hpp"
#include "thermfit/calibration/fitted_batches.hpp"
#include "thermfit/calibration/warm_start.hpp"

using namespace thermfit;

namespace {

/// A room that no column holds.
Campaign without_room(Campaign campaign) {
  for (Batch& batch : campaign) {
    batch.temperatures.names.pop_back();
    batch.temperatures.values = Matrix(batch.temperatures.values.leftCols(4));
  }
  return campaign;
}

struct Fitted {
  Calibration calibration;
  MachineRecord seen;
};

Fitted fitted(const ThermalNetwork& machine, const Campaign& campaign) {
  Fitted result;
  result.seen = observations_of(machine, campaign);
  CalibrationOptions once;
  once.starts = 1;
  result.calibration = calibrate(result.seen, with_batch_numbers_that_pay(machine, result.seen, standard_effects()),
                                 standard_effects(), once);
  return result;
}

/// Largest distance of the machine's numbers from the truth, in their stated standard errors.
double furthest(const Calibration& calibration, const ThermalNetwork& truth) {
  double worst = 0;
  for (std::size_t j = 0; j < calibration.fit.parameters.size(); ++j) {
    const Parameter& one = calibration.fit.parameters[j];
    if (!one.of_machine()) continue;
    const double off = calibration.fit.coordinates(static_cast<Index>(j)) - one.coordinate(value_in(truth, one));
    worst = std::max(worst, std::abs(off) / calibration.identified[j].sd);
  }
  return worst;
}

ThermalNetwork plant() {
  ThermalNetwork truth = bench::machine();
  truth.heat_sources[0].power_W *= 1.3;
  truth.nodes[1].capacity_J_per_K *= .8;
  truth.links[0].conductance_W_per_K *= 1.2;
  return truth;
}

}  // namespace

TEST_CASE("a campaign whose beginnings were not logged calibrates to the machine that it is", "[calibration]") {
  const Campaign late = bench::begun_late(bench::campaign(plant(), 4, 11), 25);
  const ThermalNetwork machine = bench::machine();
  REQUIRE(warm_start(machine, excitations_of(machine, late)));
  const Fitted found = fitted(with_fitted_start(machine), late);
  CHECK(furthest(found.calibration, plant()) < 3.5);
  const std::vector<FittedBatch> batches = fitted_batches(found.calibration.fit, found.seen);
  REQUIRE(batches.size() == 4);
  CHECK(batches[0].start_degC.size() == 4);
  CHECK_FALSE(batches[0].room);
}

TEST_CASE("a room that no column holds is found within its uncertainty, and the machine with it", "[calibration]") {
  const Campaign whole = bench::campaign(plant(), 4, 11);
  ThermalNetwork machine = bench::machine();
  machine.ambient = {ThermalNetwork::Ambient::Rule::unmeasured, "", 0};
  const Fitted found = fitted(machine, without_room(whole));
  CHECK(furthest(found.calibration, plant()) < 3.5);
  const std::vector<FittedBatch> batches = fitted_batches(found.calibration.fit, found.seen);
  for (std::size_t b = 0; b < 4; ++b) {
    REQUIRE(batches[b].room);
    const double truth = whole[b].temperatures.values.col(4).mean();
    CHECK(std::abs(batches[b].room_degC.value - truth) < 4 * std::hypot(batches[b].room_degC.standard_error, .02));
    CHECK(batches[b].room_degC.standard_error < .5);
  }
}

TEST_CASE("a machine whose rules leave nothing open has no numbers of single batches", "[calibration]") {
  const MachineRecord seen = observations_of(bench::machine(), bench::campaign(bench::machine(), 2, 3));
  CHECK(with_batch_numbers(bench::machine(), seen).batches.empty());
}
