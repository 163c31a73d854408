// What is wrong between the sides is told before any effect; planted_slow_test.cpp counts how often.
#include "support/bench_campaign.hpp"
#include "support/catch.hpp"
#include "thermfit/diagnosis/diagnose.hpp"
#include "thermfit/diagnosis/outputs/diagnose_outputs.hpp"

using namespace thermfit;

namespace {

using Kind = DataProblem::Kind;

Diagnosis by_network(const Campaign& real) {
  DiagnoseOptions options;
  options.search.threads = 1;
  return diagnose(bench::machine(), real, standard_effects(), options);
}

void scale(Campaign& campaign, const std::string& name, double factor, double shift = 0) {
  for (Batch& batch : campaign)
    for (Channels* channels : {&batch.temperatures, &batch.errors})
      if (const Index c = channels->find(name); c >= 0)
        channels->values.col(c) = (factor * channels->values.col(c)).array() + shift;
}

const DataProblem* certain(const Diagnosis& found) {
  for (const DataProblem& one : found.data_problems)
    if (one.certain) return &one;
  return nullptr;
}

void exchange(Batch& batch, const std::string& one, const std::string& other) {
  Matrix& values = batch.temperatures.values;
  values.col(batch.temperatures.find(one)).swap(values.col(batch.temperatures.find(other)));
}

}  // namespace

TEST_CASE("sides that are not written down alike are told, and no effect is named on top") {
  const Campaign real = bench::campaign(bench::machine(), 5, 3), sim = [&] {
    Campaign simulated = real;
    const ThermalNetwork machine = bench::machine();
    for (Batch& batch : simulated) {
      const Simulation one = simulate(machine, {excitation_of(machine, batch)}, standard_effects())[0];
      batch.temperatures.values.leftCols(4) = one.channels.leftCols(4);
      batch.errors.values.col(0) = one.channels.col(5);
    }
    return simulated;
  }();
  struct Fault {
    Kind kind;
    std::string unit;
    std::function<void(Campaign&)> into;
  };
  const std::vector<Fault> faults{{Kind::unit, "mm", [](Campaign& c) { scale(c, "Z", 1e-3); }},
                                  {Kind::sign, "", [](Campaign& c) { scale(c, "Z", -1); }},
                                  {Kind::unit, "K", [](Campaign& c) { scale(c, "T2", 1, 273.15); }},
                                  {Kind::unit, "degF", [](Campaign& c) { scale(c, "T2", 1.8, 32); }},
                                  {Kind::unit, "0.1 degC", [](Campaign& c) { scale(c, "T2", 10); }},
                                  {Kind::swapped, "",
                                   [](Campaign& c) {
                                     for (Batch& batch : c) exchange(batch, "T1", "T3");
                                   }},
                                  {Kind::copied, "",
                                   [](Campaign& c) {
                                     for (Batch& batch : c)
                                       batch.temperatures.values.col(0) = batch.temperatures.values.col(2);
                                   }},
                                  {Kind::clock_unit, "", [](Campaign& c) {
                                     for (Batch& batch : c) batch.time_s *= 60;
                                   }}};
  for (const Fault& fault : faults) {
    INFO(static_cast<int>(fault.kind) << " " << fault.unit);
    Campaign faulty = real;
    fault.into(faulty);
    for (const Diagnosis& found : {by_network(faulty), diagnose_outputs(faulty, sim, standard_effects())}) {
      CHECK(found.unlike_sides);
      CHECK(found.effects.empty());
      CHECK(found.verdict == Verdict::unknown);
      REQUIRE(certain(found));
      CHECK(certain(found)->kind == fault.kind);
      CHECK(certain(found)->unit == fault.unit);
    }
  }
}

TEST_CASE("what one side does in some batches only is told with their names") {
  Campaign real = bench::campaign(bench::machine(), 5, 3);
  real[3].errors.values *= 1e-3;
  const Diagnosis found = by_network(real);
  REQUIRE(certain(found));
  CHECK(certain(found)->unit == "mm");
  CHECK(certain(found)->batches == std::vector<std::string>{"K04"});
}

TEST_CASE("cells that are no readings are left out and told, and the diagnosis is that of clean data") {
  ThermalNetwork plant = bench::machine();
  plant.heat_sources[0].power_W *= 1.5;
  const Campaign clean = bench::campaign(plant, 5, 3);
  Campaign faulty = clean;
  faulty[2].temperatures.values(40, 1) = 85;
  faulty[2].temperatures.values(41, 1) = 85;
  faulty[1].temperatures.values(12, 4) = -999.9;  // the room drives everything
  const Diagnosis before = by_network(clean), after = by_network(faulty);
  CHECK_FALSE(after.unlike_sides);
  CHECK(after.verdict == before.verdict);
  CHECK(after.gap.rms.calibrated == Approx(before.gap.rms.calibrated).epsilon(0.02));
  std::vector<std::string> told;
  for (const DataProblem& one : after.data_problems)
    if (one.kind == Kind::left_out) told.push_back(one.batch + " " + one.channel + " " + one.note);
  CHECK(told == std::vector<std::string>{"K02 T5 13", "K03 T2 41-42"});
}

TEST_CASE("two thermometers of one node read alike in the simulation, and that is no copy, whatever fault one has") {
  ThermalNetwork machine = bench::machine();
  machine.sensors[2].node = machine.sensors[0].node;
  Campaign real = bench::campaign(machine, 5, 3);
  for (Batch& batch : real) batch.temperatures.values.col(2) += Vector::LinSpaced(batch.rows(), 0, 9);  // it drifts
  for (const DataProblem& one : compare_machine(machine, real, standard_effects())) CHECK(one.kind != Kind::copied);
}

TEST_CASE("a machine that starts warm has no bad first cell") {
  Campaign real = bench::campaign(bench::machine(), 3, 3);
  for (Batch& batch : real) batch.temperatures.values(0, 0) += 20;
  CHECK(without_bad_cells(real, DataProblem::Side::measured).left_out.empty());
}

TEST_CASE("a machine that lacks what drives it most has no wrong clock for that") {
  ThermalNetwork machine;
  machine.nodes = {{"zone", 1000, 5}};
  machine.sensors = {{"T1", 0}, {"Tamb", ThermalNetwork::ambient_node}};
  machine.ambient = {ThermalNetwork::Ambient::Rule::column, "Tamb", 0};
  machine.initial.rule = ThermalNetwork::Initial::Rule::measured;
  Batch batch;
  batch.name = "room";
  batch.time_s = Vector::LinSpaced(120, 0, 7140);
  batch.temperatures = {{"T1", "Tamb"}, Matrix(120, 2)};
  double degC = 14;
  for (Index k = 0; k < 120; ++k) {  // beside the room a wall that the machine does not know
    const double t = batch.time_s(k), room = 4 * std::sin(t / 1500), wall = 12 + 6 * std::sin(t / 9000 + 1);
    batch.temperatures.values.row(k) << degC, room;
    degC += 0.02 * (5 * (room - degC) + 9 * (wall - degC));
  }
  for (const DataProblem& one : compare_machine(machine, {batch}, standard_effects())) CHECK_FALSE(one.certain);
}
