// An effect of one's own, added to the catalogue: a shop door that opens at a known time and lets cold air in.
#include <cstdio>

#include "thermfit/effects/catalogue.hpp"
#include "thermfit/network/simulate.hpp"

using namespace thermfit;

// From the effect's law follow its simulation, its sensitivities, its calibration and its diagnosis.
class OpenDoor : public Effect {
 public:
  std::string name() const override { return "open-door"; }
  Stage stage() const override { return Stage::boundary; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting&) const override {
    return {{name(), "ambient", "time", {{"drop_K", 2}}}};
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    return {linear_parameter("drop_K", "K", 3)};
  }
  void act(ThermalSystem& system, const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    system.ambient_becomes(
        [](const Moment& now, const double* p) { return now.ambient_degC - (now.time_s > 1800 ? p[0] : 0); });
  }
};

int main() {
  ThermalNetwork machine;
  machine.ambient = {ThermalNetwork::Ambient::Rule::constant, "", 20};
  machine.nodes = {{"column", 3000, 2.0}};
  machine.displacements = {{"Z", true, {{0, 4.0}}}};
  machine.effects = {{"open-door", "ambient", "time", {{"drop_K", 5}}}};

  Batch batch;
  batch.name = "morning";
  batch.time_s = Vector::LinSpaced(7, 0, 3600);

  EffectLibrary effects = standard_effects();
  effects.add(std::make_shared<OpenDoor>());
  const std::vector<Parameter> parameters = calibration_parameters(machine, effects);
  const Simulation result = simulate(machine, {excitation_of(machine, batch)}, effects, parameters).front();
  for (Index k = 0; k < batch.rows(); ++k)
    std::printf("%4.0f s  column %.2f degC  Z %6.2f um  dZ/d(drop) %6.3f um/K\n", batch.time_s(k),
                result.nodes_degC(k, 0), result.channels(k, 0), result.jacobian(k, result.jacobian.cols() - 1));
}
