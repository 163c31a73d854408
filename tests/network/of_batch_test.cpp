#include "support/bench_campaign.hpp"
#include "support/catch.hpp"
#include "thermfit/network/simulate.hpp"

using namespace thermfit;

namespace {

/// The bench with two batches that have their own starts and rooms.
ThermalNetwork with_numbers(ThermalNetwork::Initial::Rule rule) {
  ThermalNetwork machine = bench::machine();
  machine.initial.rule = rule;
  for (const char* name : {"K01", "K02"})
    machine.batches.push_back({name, {2, -1, .5, .3}, {1, 1, 1, 1}, {1.5, -.8, .4}, {1, 1, 1}});
  return machine;
}

std::vector<Excitation> of_bench() { return excitations_of(bench::machine(), bench::campaign(bench::machine(), 2, 3)); }

}  // namespace

TEST_CASE("sensitivities to numbers of a batch are those of differences, and none of another batch") {
  const auto rule = GENERATE(ThermalNetwork::Initial::Rule::ambient, ThermalNetwork::Initial::Rule::fitted);
  const ThermalNetwork machine = with_numbers(rule);
  const std::vector<Excitation> batches = excitations_of(machine, bench::campaign(bench::machine(), 2, 3));
  std::vector<Parameter> own;
  for (const Parameter& one : calibration_parameters(machine, standard_effects()))
    if (one.of_batch()) own.push_back(one);
  REQUIRE(own.size() == 14);
  const std::vector<Simulation> at = simulate(machine, batches, standard_effects(), own);
  const Vector values = values_of(machine, own);
  for (std::size_t j = 0; j < own.size(); ++j) {
    Vector moved = values;
    moved(static_cast<Index>(j)) += 1;
    const std::vector<Simulation> there = simulate(with_values(machine, own, moved), batches, standard_effects());
    for (std::size_t b = 0; b < 2; ++b) {
      const Matrix difference = there[b].channels - at[b].channels;
      const Vector slope = at[b].jacobian.col(static_cast<Index>(j));
      CHECK((Eigen::Map<const Vector>(difference.data(), difference.size()) - slope).cwiseAbs().maxCoeff() < 1e-6);
      if (own[j].item != b) CHECK(slope.cwiseAbs().maxCoeff() == 0);
    }
  }
}

TEST_CASE("a room moved by a constant and parts that start with it warm as one") {
  ThermalNetwork machine = bench::machine();
  machine.heat_sources.clear();
  std::vector<Excitation> batches = of_bench();
  batches[0].ambient_degC.setConstant(20);
  batches[0].start_degC.setConstant(20);
  machine.batches.push_back({"K01", {}, {}, {3}, {1}});
  const Simulation one = simulate(machine, {batches[0]}, standard_effects())[0];
  CHECK((one.nodes_degC.array() - 23).abs().maxCoeff() < 1e-9);
}

TEST_CASE("without numbers of its own a batch is simulated as if there were none") {
  ThermalNetwork machine = with_numbers(ThermalNetwork::Initial::Rule::ambient);
  std::vector<Excitation> batches = of_bench();
  for (Excitation& one : batches) one.number = -1;
  const auto with = simulate(machine, batches, standard_effects()),
             without = simulate(bench::machine(), batches, standard_effects());
  CHECK(with[1].channels == without[1].channels);
}

TEST_CASE("parts between thermometers start between them under a fitted start") {
  ThermalNetwork machine = bench::machine();
  machine.initial.rule = ThermalNetwork::Initial::Rule::fitted;
  machine.sensors.erase(machine.sensors.begin() + 1);  // none on the head
  Campaign campaign = bench::campaign(bench::machine(), 1, 3);
  campaign[0].temperatures.values.row(0) << 40, 0, 30, 25, 20;
  const Excitation one = excitation_of(machine, campaign[0]);
  CHECK(one.start_degC(0) == 40);
  CHECK(one.start_degC(2) == 30);
  CHECK(one.start_degC(1) == Approx((9 * 40. + 12 * 30 + 3 * 20) / 24));
  CHECK(one.start_sensors[1].empty());
}

TEST_CASE("a room that nothing measures is refused where a column does, and asked for where none does") {
  ThermalNetwork machine = bench::machine();
  Campaign campaign = bench::campaign(machine, 1, 3);
  machine.ambient = {ThermalNetwork::Ambient::Rule::unmeasured, "", 0};
  CHECK_THROWS_WITH(excitation_of(machine, campaign[0]), Catch::Contains("T5") && Catch::Contains("unmeasured"));
  campaign[0].temperatures.names[4] = "T9";
  CHECK(excitation_of(machine, campaign[0]).ambient_degC(0) == Approx(8).margin(1));
  CHECK_THROWS_WITH(excitation_of(bench::machine(), campaign[0]), Catch::Contains("\"unmeasured\": true"));
}
