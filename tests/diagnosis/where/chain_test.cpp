#include "thermfit/diagnosis/where/chain.hpp"

#include "support/catch.hpp"
#include "support/small_machine.hpp"

using namespace thermfit;

TEST_CASE("the displacement gap splits exactly into temperatures and expansion", "[gap]") {
  const ThermalNetwork machine = small_machine();
  Campaign campaign = small_campaign(machine, 1);
  const std::vector<Simulation> simulated =
      simulate(machine, {excitation_of(machine, campaign[0])}, standard_effects());
  for (int c = 0; c < 3; ++c) campaign[0].temperatures.values.col(c) = simulated[0].channels.col(c);
  const Vector hours = campaign[0].time_s / 3600;
  campaign[0].temperatures.values.col(1) += .5 * hours;                                 // the head is warmer: 2 um/K
  campaign[0].errors.values.col(0) = simulated[0].channels.col(4) + hours + 3 * hours;  // 1 um/h of it, and 3 more
  const ChainSplit split = chain_split(machine, campaign, simulated);
  REQUIRE(split.known);
  const double unit = std::sqrt(hours.squaredNorm() / 121);
  CHECK(split.total_um == Approx(4 * unit));
  CHECK(split.temperature_um == Approx(unit));
  CHECK(split.expansion_um == Approx(3 * unit));
  CHECK(split.um_per_K_sensed == Approx(1));
}

TEST_CASE("without a displacement or with too few sensed nodes the split is not claimed", "[gap]") {
  ThermalNetwork machine = small_machine();
  const Campaign campaign = small_campaign(machine, 1);
  const std::vector<Simulation> simulated =
      simulate(machine, {excitation_of(machine, campaign[0])}, standard_effects());
  ThermalNetwork blind = machine;
  blind.sensors.resize(1);
  blind.sensors[0].column = "T9";
  CHECK_FALSE(chain_split(blind, campaign, simulated).known);
  machine.displacements.clear();
  CHECK_FALSE(chain_split(machine, campaign, simulated).known);
}
