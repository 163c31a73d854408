#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/effects/output_traces.hpp"
#include "thermfit/effects/place.hpp"
#include "thermfit/effects/setting.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit {

/// The nodes of the place do not start where the network has them start: by dT above it in every batch, or (driver
/// `measured`) by a share of what their thermometers read above ambient at the first sample, batch by batch.
class InitialGradient : public Effect {
 public:
  std::string name() const override { return "initial-gradient"; }
  Stage stage() const override { return Stage::initial; }
  std::string meaning() const override { return "the machine does not start at room temperature"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    if (setting.network.initial.rule == ThermalNetwork::Initial::Rule::fitted) return result;  // every start is free
    const bool taken_over = setting.network.initial.rule == ThermalNetwork::Initial::Rule::measured;
    for (const std::string& place : spread_places(setting.network)) {
      result.push_back({name(), place, "", {{"rise_K", 0}}});
      // Everywhere at once is no gradient, but the error of the one reading of the room at the first sample.
      if (place != "all" && !taken_over && !sensors_at(setting.network, place).empty())
        result.push_back({name(), place, "measured", {{"share", 0}}});
    }
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    if (added.driver.empty()) {
      nodes_at(network, added.location);
      return {linear_parameter("rise_K", "K", 2)};
    }
    if (added.driver != "measured") throw Error("driver", "'" + added.driver + "'", "measured, or none");
    if (sensors_at(network, added.location).empty())
      throw Error("location", "'" + added.location + "' has no thermometer",
                  "a place with a sensor on one of its nodes");
    EffectParameter share = positive_parameter("share", "", 1);
    share.starts = {1};
    return {share};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const std::vector<std::size_t> sensors = sensors_at(network, added.location);
    for (const Index node : nodes_at(network, added.location)) {
      if (added.driver.empty()) {
        system.start(node, [](const Moment&, const double* p) { return p[0]; });
        continue;
      }
      std::vector<std::size_t> own;
      for (const std::size_t s : sensors)
        if (network.sensors[s].node == node) own.push_back(s);
      if (own.empty()) own = sensors;
      system.start(node, [own](const Moment& now, const double* p) { return p[0] * rise_K(now, own); });
    }
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect&, double batch_hours) const override {
    return block_that_shows(ScheduleKind::repeat, {}, batch_hours);
  }
  std::string disturbs(const ThermalNetwork::AddedEffect&) const override { return "start"; }
  void trace(OutputTraces& traces) const override { traces.fading_start(); }

 private:
  static std::vector<std::size_t> sensors_at(const ThermalNetwork& network, const std::string& place) {
    const std::vector<Index> nodes = nodes_at(network, place);
    std::vector<std::size_t> result;
    for (std::size_t s = 0; s < network.sensors.size(); ++s)
      if (std::find(nodes.begin(), nodes.end(), network.sensors[s].node) != nodes.end()) result.push_back(s);
    return result;
  }
  /// Mean of the first readings there are, above ambient.
  static double rise_K(const Moment& now, const std::vector<std::size_t>& sensors) {
    double sum = 0, count = 0;
    for (const std::size_t s : sensors)
      if (now.first_reading_degC != nullptr && std::isfinite(now.first_reading_degC[s]))
        sum += now.first_reading_degC[s] - now.first_ambient_degC, ++count;
    return count > 0 ? sum / count : 0;
  }
};

}  // namespace thermfit
