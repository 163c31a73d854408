#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "thermfit/effects/output_traces.hpp"
#include "thermfit/effects/place.hpp"
#include "thermfit/effects/setting.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit {

/// Heat that the network does not have: + P u/scale into a node; u an input column, or 1 for the driver `constant`.
class HeatSourceEffect : public Effect {
 public:
  std::string name() const override { return "heat-source"; }
  Stage stage() const override { return Stage::heat; }
  std::string meaning() const override { return "heat arises that the simulator lacks"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const std::string& node : node_places(setting.network)) {
      for (const std::string& input : setting.inputs)
        result.push_back({name(), node, input, {{"power_W", 0}, {"scale", scale_of(setting, input)}}});
      result.push_back({name(), node, "constant", {{"power_W", 0}, {"scale", 1}}});
    }
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    node_at(network, added.location);
    return {positive_parameter("power_W", "W", typical_power_W(network)), fixed_parameter("scale", 1)};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const Index input = added.driver == "constant" ? -1 : system.input(added.driver);
    system.heat({{node_at(network, added.location), 1.0}}, [input](const Moment& now, const double* p) {
      return input < 0 ? p[0] : p[0] * now.inputs[input] / p[1];
    });
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect& where, double batch_hours) const override {
    if (where.driver.empty() || where.driver == "constant") return Effect::shown_by(where, batch_hours);
    return block_that_shows(ScheduleKind::toggle, where.driver, batch_hours);
  }
  void trace(OutputTraces& traces) const override {
    traces.heat_flow("", "constant", [](const PairedBatch&, Index) { return 1.; });
    for (const TraceInput& input : traces.inputs())
      traces.heat_flow("", input.name, [&](const PairedBatch& batch, Index k) { return input.share(batch, k); });
  }
};

/// A modelled source that grows with another power of its input too: + P2 (u/scale)^m, spread as the source is.
class FrictionLaw : public Effect {
 public:
  std::string name() const override { return "friction-law"; }
  Stage stage() const override { return Stage::heat; }
  std::string meaning() const override { return "a heat source grows with another power of its input"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const auto& source : setting.network.heat_sources)
      if (std::find(setting.inputs.begin(), setting.inputs.end(), source.input) != setting.inputs.end() &&
          !setting.is_on_off(source.input))
        result.push_back({name(), source.name, source.input, {{"power_W", 0}, {"exponent", 2}}});
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    const auto& source = network.heat_sources[static_cast<std::size_t>(source_at(network, added.location))];
    EffectParameter exponent = shape_parameter("exponent", "", 2.2, 0.4, 1.5, 3);
    exponent.starts = {2, 2.8};
    return {linear_parameter("power_W", "W", std::max(0.5 * source.power_W, 0.1 * typical_power_W(network))), exponent};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const auto& source = network.heat_sources[static_cast<std::size_t>(source_at(network, added.location))];
    const Index input = source.input == "constant" ? -1 : system.input(source.input);
    system.heat(source.into, [input, scale = source.scale](const Moment& now, const double* p) {
      return input < 0 ? p[0] : p[0] * std::pow(std::abs(now.inputs[input]) / scale, p[1]);
    });
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect& where, double batch_hours) const override {
    return block_that_shows(ScheduleKind::speed_stair, where.driver, 1.25 * batch_hours);
  }
  void trace(OutputTraces& traces) const override {
    for (const TraceInput& input : traces.inputs()) {
      if (input.on_off) continue;
      for (const double exponent : {1.5, 2., 3.})
        traces
            .heat_flow("source driven by " + input.name, input.name,
                       [&](const PairedBatch& batch, Index k) { return std::pow(input.share(batch, k), exponent); })
            .shape = {{"exponent", "", exponent}};
    }
  }
};

}  // namespace thermfit
