#include "thermfit/diagnosis/planning/next_experiment.hpp"

#include "support/catch.hpp"
#include "support/small_machine.hpp"

using namespace thermfit;

namespace {

NextExperiment plan_for(const ThermalNetwork::AddedEffect& a, const ThermalNetwork::AddedEffect& b) {
  const EffectLibrary library = standard_effects();
  const ThermalNetwork machine = small_machine();
  const MachineRecord seen = observations_of(machine, small_campaign(machine, 3));
  const MapFit fit = map_fit(seen, machine, library);
  FittedRival first{{a.effect, a.location, a.driver, .6}, machine},
      second{{b.effect, b.location, b.driver, .4}, machine};
  first.network.effects = {a};
  second.network.effects = {b};
  return next_experiment({first, second}, seen, fit, fit.noise, library);
}

}  // namespace

TEST_CASE("rivals that differ in their law are separated by a schedule of known hours", "[gap]") {
  const NextExperiment plan =
      plan_for({"heat-source", "head", "constant", {{"power_W", 60}, {"scale", 1}}},
               {"speed-shift", "displacement", "spindle_rpm", {{"shift_um", 6}, {"scale", 6000}}});
  REQUIRE(plan.plan.size() == 1);
  CHECK(plan.plan[0].machine_hours > .5);
  CHECK(plan.confusion_before == Approx(.4));
  CHECK(plan.confusion_after < .05);
  CHECK(plan.expected_confidence == Approx(1 - plan.confusion_after));
  REQUIRE(plan.separates.size() == 2);
  CHECK(plan.separates[0].effect == "heat-source");
  CHECK(plan.separates[1].location == "displacement");
}

TEST_CASE("equal machines cannot be separated, and that is said", "[gap]") {
  const ThermalNetwork::AddedEffect same{"heat-source", "head", "constant", {{"power_W", 60}, {"scale", 1}}};
  const NextExperiment plan = plan_for(same, same);
  CHECK(plan.confusion_after == Approx(.4).margin(1e-6));
  CHECK(plan.remark == NextExperiment::Remark::nothing_separates);
}

TEST_CASE("the menu drives the inputs of the campaign within their range", "[gap]") {
  const ThermalNetwork machine = small_machine();
  const MachineRecord seen = observations_of(machine, small_campaign(machine, 3));
  for (const Schedule& schedule : experiment_menu(machine, seen)) {
    CHECK(schedule.excitation.inputs.maxCoeff() <= 6000);
    CHECK(schedule.block.machine_hours > 0);
  }
}

TEST_CASE("a faulty thermometer takes its fault along when it changes places", "[gap]") {
  const ThermalNetwork machine = small_machine();
  const MachineRecord seen = observations_of(machine, small_campaign(machine, 3));
  const std::vector<Schedule> swaps = sensor_swaps(machine, seen, {"T2"});
  REQUIRE(swaps.size() == 1);
  CHECK(swaps[0].block.subject == "T2");
  CHECK(swaps[0].block.beside == "T1");
  ThermalNetwork faulty = machine;
  faulty.effects = {{"sensor-drift", "T2", "", {{"rate_K_per_h", 0.5}}}};
  const ThermalNetwork after = with_swap(faulty, swaps[0]);
  CHECK(after.effects[0].location == "T1");
  CHECK(with_swap(after, swaps[0]).effects[0].location == "T2");
  CHECK(sensor_swaps(machine, seen, {"displacement", "head"}).empty());
}

TEST_CASE("without a network the plan isolates the effect and its rival", "[gap]") {
  FoundEffect found;
  found.effect = "sensor-drift";
  found.location = "T2";
  CHECK(experiment_by_kind(found, standard_effects(), 6).plan.empty());
  found.alternatives = {{"friction-law", "bearing", "spindle_rpm", .3}};
  const NextExperiment plan = experiment_by_kind(found, standard_effects(), 6);
  REQUIRE(plan.plan.size() == 2);
  CHECK(plan.plan[0].kind == ScheduleKind::sensor_swap);
  CHECK(plan.plan[1].kind == ScheduleKind::speed_stair);
  CHECK(plan.separates.size() == 2);
  CHECK(std::isnan(plan.expected_confidence));
}
