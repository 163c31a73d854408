#include "thermfit/calibration/shortcomings.hpp"

#include "support/bench_campaign.hpp"
#include "support/catch.hpp"

using namespace thermfit;

namespace {

std::vector<Shortcoming> of(const ThermalNetwork& machine, const ThermalNetwork& plant) {
  const MachineRecord seen = observations_of(machine, bench::campaign(plant, 4, 7));
  CalibrationOptions once;
  once.starts = 1;
  return shortcomings(calibrate(seen, machine, standard_effects(), once), seen);
}

bool has(const std::vector<Shortcoming>& found, Shortcoming::Kind kind) {
  return std::any_of(found.begin(), found.end(), [&](const Shortcoming& one) { return one.kind == kind; });
}

}  // namespace

TEST_CASE("a calibration that succeeds has no shortcoming", "[calibration]") {
  ThermalNetwork plant = bench::machine();
  plant.heat_sources[0].power_W *= 1.4;
  for (const Shortcoming& one : of(bench::machine(), plant)) CHECK(one.kind == Shortcoming::Kind::not_pinned);
}

TEST_CASE("a machine that cannot be made to fit says which channel is off by how much", "[calibration]") {
  ThermalNetwork plant = bench::machine();
  plant.effects = {{"heat-source", "bed", "constant", {{"power_W", 900}}}};
  const std::vector<Shortcoming> found = of(bench::machine(), plant);
  REQUIRE_FALSE(found.empty());
  CHECK(has(found, Shortcoming::Kind::misfit));
}

TEST_CASE("parameters beyond belief are told, and spoil the machine", "[calibration]") {
  ThermalNetwork plant = bench::machine();
  plant.nodes[1].capacity_J_per_K *= 9;
  const std::vector<Shortcoming> found = of(bench::machine(), plant);
  REQUIRE(has(found, Shortcoming::Kind::beyond_belief));
  const auto first = std::find_if(found.begin(), found.end(), [](const Shortcoming& one) { return one.spoils(); });
  REQUIRE(first != found.end());
  CHECK(std::abs(first->sds) > 4);
}
