// A probe that is set to zero anew in each batch moves no verdict: told, and its zero left free.
#include "thermfit/diagnosis/sides/compare_datums.hpp"

#include "support/bench_campaign.hpp"
#include "support/catch.hpp"
#include "thermfit/diagnosis/diagnose.hpp"
#include "thermfit/diagnosis/outputs/diagnose_outputs.hpp"

using namespace thermfit;

namespace {

using Kind = DataProblem::Kind;

/// A machine with more power than the simulator's, and its batches with these zeros.
Campaign plant(const std::vector<double>& zeros_um) {
  ThermalNetwork machine = bench::machine();
  machine.heat_sources[0].power_W *= 1.4;
  Campaign campaign = bench::campaign(machine, zeros_um.size(), 3);
  for (std::size_t b = 0; b < campaign.size(); ++b) campaign[b].errors.values.array() += zeros_um[b];
  return campaign;
}

Diagnosis by_network(const Campaign& real, const ThermalNetwork& machine = bench::machine()) {
  DiagnoseOptions options;
  options.search.threads = 1;
  return diagnose(machine, real, standard_effects(), options);
}

Campaign simulated(const Campaign& real) {
  Campaign result = real;
  const ThermalNetwork machine = bench::machine();
  for (Batch& batch : result) {
    const Simulation one = simulate(machine, {excitation_of(machine, batch)}, standard_effects())[0];
    batch.temperatures.values.leftCols(4) = one.channels.leftCols(4);
    batch.errors.values.col(0) = one.channels.col(5);
  }
  return result;
}

std::vector<DataProblem> datums(const Diagnosis& found) {
  std::vector<DataProblem> result;
  for (const DataProblem& one : found.data_problems)
    if (one.kind == Kind::datum) result.push_back(one);
  return result;
}

}  // namespace

TEST_CASE("a probe set to zero anew is told batch by batch, and the verdict is that without it") {
  const std::vector<double> zeros{450, 0, -1200, 0, 90};
  const Campaign clean = plant({0, 0, 0, 0, 0}), moved = plant(zeros);
  const Diagnosis before = by_network(clean), after = by_network(moved);
  REQUIRE(datums(before).empty());
  const std::vector<DataProblem> told = datums(after);
  REQUIRE(told.size() == 1);
  CHECK(told[0].names == std::vector<std::string>{"Z"});
  CHECK(told[0].batches == std::vector<std::string>{"K01", "K03", "K05"});
  CHECK(told[0].figure == Approx(-1200).margin(2));
  CHECK_FALSE(after.unlike_sides);
  CHECK(after.verdict == before.verdict);
  CHECK(after.gap.rms.calibrated < 1.2 * before.gap.rms.calibrated);
  for (const ThermalNetwork::Displacement& output : after.with_effects.displacements) CHECK_FALSE(output.free_datum);

  const Campaign sim = simulated(clean);
  const Diagnosis paired_before = diagnose_outputs(clean, sim, standard_effects()),
                  paired_after = diagnose_outputs(moved, sim, standard_effects());
  CHECK(datums(paired_before).empty());
  REQUIRE(datums(paired_after).size() == 1);
  CHECK(datums(paired_after)[0].batches == told[0].batches);
  CHECK(paired_after.verdict == paired_before.verdict);
}

TEST_CASE("the zero of an absolute probe is part of what is measured") {
  ThermalNetwork machine = bench::machine();
  machine.displacements[0].absolute = true;
  const Campaign moved = plant({450, 0, -1200, 0, 90});
  const MachineRecord seen = observations_of(machine, moved);
  for (const DataProblem& one : compare_sides(sides_of(machine, seen, standard_effects())))
    CHECK(one.kind != Kind::datum);
}

TEST_CASE("a free zero is the mean of both sides, and its slopes are about their mean") {
  ThermalNetwork machine = bench::machine();
  const Campaign real = plant({7, -3});
  const std::vector<Parameter> parameters = calibration_parameters(machine, standard_effects());
  const Simulation own = simulate(machine, {excitation_of(machine, real[0])}, standard_effects(), parameters)[0];
  machine.displacements[0].free_datum = true;
  const Simulation free = simulate(machine, {excitation_of(machine, real[0])}, standard_effects(), parameters)[0];
  const Index z = 5, rows = own.channels.rows();
  const Vector centred = own.channels.col(z).array() - own.channels.col(z).mean();
  CHECK((free.channels.col(z) - centred).norm() < 1e-9);
  const Matrix slopes = own.jacobian.middleRows(z * rows, rows);
  const Matrix about = slopes.rowwise() - slopes.colwise().mean();
  CHECK((free.jacobian.middleRows(z * rows, rows) - about).norm() < 1e-9 * (1 + about.norm()));
}
