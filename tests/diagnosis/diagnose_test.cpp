#include "thermfit/diagnosis/diagnose.hpp"

#include "support/bench_campaign.hpp"
#include "support/catch.hpp"

using namespace thermfit;

namespace {

Diagnosis diagnosed(const ThermalNetwork& plant, std::size_t batches = 6, DiagnoseOptions options = {}) {
  options.search.threads = 1;
  return diagnose(bench::machine(), bench::campaign(plant, batches, 11), standard_effects(), options);
}

ThermalNetwork with(ThermalNetwork::AddedEffect effect) {
  ThermalNetwork plant = bench::machine();
  plant.effects = {std::move(effect)};
  return plant;
}

/// Heat into the spindle and the head together, and nowhere else.
class HeatIntoBoth : public Effect {
 public:
  std::string name() const override { return "heat-into-both"; }
  Stage stage() const override { return Stage::heat; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting&) const override {
    return {{name(), "spindle+head", "constant", {{"power_W", 0}}}};
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork&,
                                          const ThermalNetwork::AddedEffect& added) const override {
    if (added.location != "spindle+head") throw Error("location", added.location, "spindle+head");
    return {positive_parameter("power_W", "W", 50)};
  }
  void act(ThermalSystem& system, const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    system.heat({{0, 0.5}, {1, 0.5}}, [](const Moment&, const double* p) { return p[0]; });
  }
};

}  // namespace

TEST_CASE("a machine that the simulator matches has no gap to explain") {
  const Diagnosis found = diagnosed(bench::machine());
  CHECK(found.verdict == Verdict::none);
  CHECK(found.effects.empty());
  CHECK(found.gap.rms.calibrated == Approx(0.25).epsilon(0.15));
}

TEST_CASE("parameters that are off are miscalibration, and those that moved are named") {
  ThermalNetwork plant = bench::machine();
  plant.heat_sources[0].power_W *= 1.5;
  plant.links[1].conductance_W_per_K *= 0.7;
  const Diagnosis found = diagnosed(plant);
  CHECK(found.verdict == Verdict::miscalibration);
  REQUIRE_FALSE(found.calibration.empty());
  CHECK(found.calibration[0].parameter == "power of bearing");
  CHECK(found.calibration[0].to == Approx(225).epsilon(0.05));
}

TEST_CASE("parts that start a little off the room are no fault") {
  DiagnoseOptions options;
  options.search.threads = 1;
  const Diagnosis found =
      diagnose(bench::machine(), bench::campaign(bench::machine(), 6, 11, 0.1), standard_effects(), options);
  CHECK(found.effects.empty());
  CHECK((found.verdict == Verdict::none || found.verdict == Verdict::miscalibration));
  CHECK(std::any_of(found.calibration.begin(), found.calibration.end(), [](const CalibrationMove& one) {
    return one.parameter == "share of the first readings in the start" && one.to > 0.5;
  }));
}

TEST_CASE("parts that each start far off the room are starts of their batches: told, fitted, and no effect") {
  DiagnoseOptions options;
  options.search.threads = 1;
  const Diagnosis found =
      diagnose(bench::machine(), bench::campaign(bench::machine(), 6, 11, 2), standard_effects(), options);
  CHECK(found.effects.empty());
  CHECK((found.verdict == Verdict::none || found.verdict == Verdict::miscalibration));
  CHECK(found.gap.rms.calibrated < 0.35);
  CHECK(std::any_of(found.data_problems.begin(), found.data_problems.end(),
                    [](const DataProblem& one) { return one.kind == DataProblem::Kind::warm_start; }));
}

TEST_CASE("an unmodelled heat source is named with its power, and the gap shrinks to the noise on held-out batches") {
  const Diagnosis found = diagnosed(with({"heat-source", "column", "constant", {{"power_W", 100}, {"scale", 1}}}));
  REQUIRE(found.effects.size() == 1);
  const FoundEffect& effect = found.effects[0];
  CHECK(effect.effect == "heat-source");
  CHECK(effect.location == "column");
  CHECK(effect.driver == "constant");
  CHECK(effect.confidence > 0.5);
  REQUIRE_FALSE(effect.parameters.empty());
  CHECK(std::abs(effect.parameters[0].value - 100) < 4 * effect.parameters[0].standard_error);
  CHECK(found.gap.rms.with_effect < 0.32);
  CHECK(found.gap.shrink_percent > 70);
  CHECK(found.gap.shrink_ci95_percent.low <= found.gap.shrink_percent);
  CHECK(found.gap.shrink_ci95_percent.high >= found.gap.shrink_percent);
}

TEST_CASE("a drifting sensor is named though the displacement hardly changes") {
  const Diagnosis found = diagnosed(with({"sensor-drift", "T3", "", {{"rate_K_per_h", 0.4}}}));
  REQUIRE(found.effects.size() == 1);
  CHECK(found.effects[0].effect == "sensor-drift");
  CHECK(found.effects[0].location == "T3");
}

TEST_CASE("an effect that is left out of the catalogue is not named") {
  DiagnoseOptions options;
  options.without = {"speed-shift"};
  const ThermalNetwork plant = with({"speed-shift", "displacement", "spindle_rpm", {{"shift_um", 6}, {"scale", 4000}}});
  CHECK(diagnosed(plant).effects.at(0).effect == "speed-shift");
  for (const FoundEffect& one : diagnosed(plant, 6, options).effects) CHECK(one.effect != "speed-shift");
}

TEST_CASE("the search for the place leaves out places that an effect refuses") {
  EffectLibrary own;
  own.add(std::make_shared<HeatIntoBoth>());
  ThermalNetwork plant = bench::machine();
  plant.effects = {{"heat-into-both", "spindle+head", "constant", {{"power_W", 80}}}};
  const Campaign real = bench::campaign(plant, 5, 11, 0, own);
  const Diagnosis found = diagnose(bench::machine(), real, own);
  REQUIRE(found.effects.size() == 1);
  CHECK(found.effects[0].location == "spindle+head");
}

TEST_CASE("one batch gives figures of the fit itself and says so") {
  const Diagnosis found = diagnosed(with({"heat-source", "column", "constant", {{"power_W", 100}, {"scale", 1}}}), 1);
  CHECK_FALSE(found.gap.held_out);
  CHECK_FALSE(found.weaker_claims.empty());
}

TEST_CASE("the same campaign gives the same diagnosis, whatever the number of threads") {
  const ThermalNetwork plant = with({"sensor-drift", "T3", "", {{"rate_K_per_h", 0.4}}});
  const Campaign real = bench::campaign(plant, 4, 11);
  DiagnoseOptions one, two;
  one.search.threads = 1;
  two.search.threads = 2;
  const Diagnosis a = diagnose(bench::machine(), real, standard_effects(), one);
  const Diagnosis b = diagnose(bench::machine(), real, standard_effects(), two);
  CHECK(a.gap.rms.with_effect == b.gap.rms.with_effect);
  REQUIRE(a.effects.size() == b.effects.size());
  for (std::size_t i = 0; i < a.effects.size(); ++i) CHECK(a.effects[i].confidence == b.effects[i].confidence);
}

TEST_CASE("an unknown effect name and an empty campaign are refused in words") {
  DiagnoseOptions options;
  options.effects = {"gremlins"};
  CHECK_THROWS_AS(diagnosed(bench::machine(), 2, options), Error);
  CHECK_THROWS_AS(diagnose(bench::machine(), {}, standard_effects()), Error);
}
