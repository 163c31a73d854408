#include "thermfit/gap/next_experiment.hpp"

#include "support/catch.hpp"
#include "support/small_machine.hpp"

using namespace thermfit;

namespace {

NextExperiment plan_for(const ThermalNetwork::AddedEffect& a, const ThermalNetwork::AddedEffect& b) {
  const EffectLibrary library = standard_effects();
  const ThermalNetwork machine = small_machine();
  const MachineRecord seen = observations_of(machine, small_campaign(machine, 3));
  const MapFit fit = map_fit(seen, machine, library);
  FittedRival first{a.effect, machine, .6}, second{b.effect, machine, .4};
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
  CHECK(plan.separates == std::vector<std::string>{"heat-source", "speed-shift"});
}

TEST_CASE("equal machines cannot be separated, and that is said", "[gap]") {
  const ThermalNetwork::AddedEffect same{"heat-source", "head", "constant", {{"power_W", 60}, {"scale", 1}}};
  const NextExperiment plan = plan_for(same, same);
  CHECK(plan.confusion_after == Approx(.4).margin(1e-6));
  CHECK_FALSE(plan.why.empty());
}

TEST_CASE("the menu drives the inputs of the campaign within their range", "[gap]") {
  const ThermalNetwork machine = small_machine();
  const MachineRecord seen = observations_of(machine, small_campaign(machine, 3));
  for (const Schedule& schedule : experiment_menu(machine, seen)) {
    CHECK(schedule.excitation.inputs.maxCoeff() <= 6000);
    CHECK(schedule.hours() > 0);
  }
}
