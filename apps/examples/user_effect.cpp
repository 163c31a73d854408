// An effect of one's own, added to the catalogue: a shop door that is open for half an hour and lets cold air in.
#include <cstdio>

#include "thermfit/diagnosis/diagnose.hpp"
#include "thermfit/diagnosis/outputs/diagnose_outputs.hpp"
#include "thermfit/effects/catalogue.hpp"
#include "thermfit/network/simulate.hpp"

using namespace thermfit;

class OpenDoor : public Effect {
 public:
  static bool open(double time_s) { return time_s > 1800 && time_s < 3600; }

  std::string name() const override { return "open-door"; }
  Stage stage() const override { return Stage::boundary; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting&) const override {
    return {{name(), "ambient", "time", {{"drop_K", 0}}}};
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    return {linear_parameter("drop_K", "K", 3)};
  }
  // From the law follow its simulation, its sensitivities, its calibration and its diagnosis with a machine.
  void act(ThermalSystem& system, const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    system.ambient_becomes(
        [](const Moment& now, const double* p) { return now.ambient_degC - (open(now.time_s) ? p[0] : 0); });
  }
  // From the trace its diagnosis in the outputs of any other simulator: where heat flows, and when.
  void trace(OutputTraces& traces) const override {
    traces.heat_flow("ambient", "time",
                     [](const PairedBatch& batch, Index k) { return open(batch.time_s(k)) ? 1. : 0.; });
  }
  // What a report says of it, and the experiment it asks for.
  std::string meaning() const override { return "cold air comes in through the shop door"; }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect&, double batch_hours) const override {
    return block_that_shows(ScheduleKind::toggle, "shop door", batch_hours);
  }
};

int main() {
  EffectLibrary effects = standard_effects();
  effects.add(std::make_shared<OpenDoor>());

  ThermalNetwork machine;
  machine.ambient = {ThermalNetwork::Ambient::Rule::constant, "", 20};
  machine.nodes = {{"spindle", 1500, 2}, {"column", 6000, 4}};
  machine.links = {{0, 1, 3}};
  machine.heat_sources = {{"bearing", "spindle_rpm", 4000, 1, 100, {{0, 1.0}}}};
  machine.displacements = {{"Z", true, {{0, 2.0}, {1, -1.0}}}};
  machine.sensors = {{"T1", 0}, {"T2", 1}};
  ThermalNetwork shop = machine;
  shop.effects = {{"open-door", "ambient", "time", {{"drop_K", 6}}}};

  // Four mornings beside the open door, and what the simulator says of them.
  Campaign real, sim;
  for (int morning = 0; morning < 4; ++morning) {
    Batch batch;
    batch.name = "morning-" + std::to_string(morning + 1);
    batch.time_s = Vector::LinSpaced(121, 0, 7200);
    batch.inputs = {{"spindle_rpm"}, Matrix::Constant(121, 1, 1000. * (morning + 1))};
    batch.inputs.values.bottomRows(30).setZero();
    for (const auto& [network, campaign] : {std::pair(&shop, &real), std::pair(&machine, &sim)}) {
      const Matrix channels = simulate(*network, {excitation_of(*network, batch)}, effects).front().channels;
      batch.temperatures = {{"T1", "T2"}, channels.leftCols(2)};
      batch.errors = {{"Z"}, channels.rightCols(1)};
      for (Index k = 0; k < 121 && network == &shop; ++k)  // and readings come in steps
        for (double* value : {&batch.temperatures.values(k, 0), &batch.temperatures.values(k, 1)})
          *value = .05 * std::round(*value / .05);
      campaign->push_back(batch);
    }
  }

  const auto print = [](const char* way, const Diagnosis& diagnosis) {
    for (const FoundEffect& found : diagnosis.effects)
      std::printf("%s: %s (%s at %s), shrink %.0f %%\n", way, found.meaning.c_str(), found.effect.c_str(),
                  found.location.c_str(), diagnosis.gap.shrink_percent);
  };
  print("with the machine", diagnose(machine, real, effects));
  print("from outputs alone", diagnose_outputs(real, sim, effects));
}
