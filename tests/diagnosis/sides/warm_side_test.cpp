#include "thermfit/diagnosis/sides/warm_side.hpp"

#include "support/bench_campaign.hpp"
#include "support/catch.hpp"
#include "thermfit/diagnosis/diagnose.hpp"

using namespace thermfit;

namespace {

Diagnosis of(const ThermalNetwork& plant, Index rows_not_logged) {
  return diagnose(bench::machine(), bench::begun_late(bench::campaign(plant, 5, 21), rows_not_logged),
                  standard_effects());
}

bool told(const Diagnosis& found) {
  return std::any_of(found.data_problems.begin(), found.data_problems.end(), [](const DataProblem& one) {
    return one.kind == DataProblem::Kind::warm_start && one.rule == starts_were_fitted;
  });
}

}  // namespace

TEST_CASE("a right machine whose batches start warm has no effect, and is told how they start", "[diagnosis]") {
  const Diagnosis found = of(bench::machine(), 25);
  CHECK(found.effects.empty());
  CHECK((found.verdict == Verdict::none || found.verdict == Verdict::miscalibration));
  CHECK(told(found));
  CHECK(found.fitted_batches.size() == 5);
}

TEST_CASE("a machine file that says how its parts start is not asked again") {
  const Campaign late = bench::begun_late(bench::campaign(bench::machine(), 2, 21), 25);
  ThermalNetwork machine = bench::machine();
  CHECK(warm_start_problem(machine, excitations_of(machine, late)).size() == 1);
  for (const auto rule : {ThermalNetwork::Initial::Rule::measured, ThermalNetwork::Initial::Rule::fitted}) {
    machine.initial.rule = rule;
    CHECK(warm_start_problem(machine, excitations_of(machine, late)).empty());
  }
}
