#pragma once

#include <string>
#include <vector>

#include "thermfit/effects/place.hpp"
#include "thermfit/effects/setting.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit {

/// The nodes of the place start by dT above where the network has them start, in every batch.
class InitialGradient : public Effect {
 public:
  std::string name() const override { return "initial-gradient"; }
  Stage stage() const override { return Stage::initial; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const std::string& place : spread_places(setting.network))
      result.push_back({name(), place, "", {{"rise_K", 0}}});
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    nodes_at(network, added.location);
    return {linear_parameter("rise_K", "K", 2)};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    for (const Index node : nodes_at(network, added.location))
      system.start(node, [](const Moment&, const double* p) { return p[0]; });
  }
};

}  // namespace thermfit
