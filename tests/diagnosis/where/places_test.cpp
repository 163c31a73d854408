#include "thermfit/diagnosis/where/places.hpp"

#include "support/catch.hpp"
#include "support/small_machine.hpp"

using namespace thermfit;

namespace {
std::string strongest_place(const Campaign& campaign) {
  const EffectLibrary library = standard_effects();
  const ThermalNetwork machine = small_machine();
  const MachineRecord seen = observations_of(machine, campaign);
  return disturbed_places(seen, map_fit(seen, machine, library), library)[0].name;
}
}  // namespace

TEST_CASE("heat that nobody modelled is found at its node, without an effect being assumed", "[gap]") {
  ThermalNetwork truth = small_machine();
  truth.effects = {{"heat-source", "column", "constant", {{"power_W", 90}, {"scale", 1}}}};
  CHECK(strongest_place(small_campaign(truth, 4)) == "column");
}

TEST_CASE("a wandering sensor is found at the sensor, a wandering probe at the displacement", "[gap]") {
  Campaign drifting = small_campaign(small_machine(), 4), probing = drifting;
  for (std::size_t b = 0; b < 4; ++b) {
    const Vector wave = (drifting[b].time_s.array() / 3000 + static_cast<double>(b)).sin();
    drifting[b].temperatures.values.col(1) += wave;
    probing[b].errors.values.col(0) += 8 * (wave.array() - wave(0)).matrix();
  }
  CHECK(strongest_place(drifting) == "T2");
  CHECK(strongest_place(probing) == "displacement");
}
