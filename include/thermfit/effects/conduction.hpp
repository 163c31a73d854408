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

/// A joint that conducts better when warm, G (1 + k ((theta_i + theta_j)/2 - reference)/10 K), or at speed,
/// G (1 + k u/scale), when it has a driver.
class JointConductance : public Effect {
 public:
  std::string name() const override { return "joint-conductance"; }
  Stage stage() const override { return Stage::conduction; }
  std::string meaning() const override { return "a joint conducts better or worse as it warms"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const auto& link : setting.network.links) {
      const std::string place = pair_name(setting.network, link.a, link.b);
      result.push_back({name(), place, "", {{"k", 0}}});
      for (const std::string& input : setting.inputs)
        if (!setting.is_on_off(input))
          result.push_back({name(), place, input, {{"k", 0}, {"scale", scale_of(setting, input)}}});
    }
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    link_at(network, added.location);
    EffectParameter k = linear_parameter("k", "", 0.3);
    k.lower = -0.5;
    if (added.driver.empty()) return {k};
    return {k, fixed_parameter("scale", 1)};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const Index element = system.link_element(link_at(network, added.location));
    if (!added.driver.empty()) {
      const Index input = system.input(added.driver);
      system.scale_conductance(element, [input](const Moment& now, const double* p) {
        return std::max(-0.95, p[0] * std::abs(now.inputs[input]) / p[1]);
      });
      return;
    }
    const auto [a, b] = pair_at(network, added.location);
    system.scale_conductance_by_state(
        element, [a = a, b = b, reference = network.reference_degC](const Moment& now, const double* p) {
          const double mean = (now.temperature_degC[a] + now.temperature_degC[b]) / 2;
          return std::max(-0.95, p[0] * (mean - reference) / 10);
        });
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect& where, double batch_hours) const override {
    return block_that_shows(ScheduleKind::speed_stair, where.driver, 1.25 * batch_hours);
  }
  void trace(OutputTraces& traces) const override {
    const std::vector<Index> all = traces.thermometers();
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const Index a = all[i], b = all[j];
        traces
            .heat_flow(traces.name(a) + "-" + traces.name(b), "",
                       [&](const PairedBatch& batch, Index k) {
                         const double mean = (batch.measured(k, a) + batch.measured(k, b)) / 2;
                         return (batch.measured(k, a) - batch.measured(k, b)) * (mean - traces.reference_degC()) / 10;
                       })
            .acts_on = {{a, 0}, {b, 0}};
      }
  }
};

/// Conduction between two nodes that have no link: + G (theta_j - theta_i).
class MissingLink : public Effect {
 public:
  std::string name() const override { return "missing-link"; }
  Stage stage() const override { return Stage::conduction; }
  std::string meaning() const override { return "heat flows between parts that the simulator does not connect"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (Index a = 0; a < setting.network.node_count(); ++a)
      for (Index b = a + 1; b < setting.network.node_count(); ++b)
        if (setting.network.find_link(a, b) < 0)
          result.push_back({name(), pair_name(setting.network, a, b), "", {{"conductance_W_per_K", 0}}});
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    pair_at(network, added.location);
    return {positive_parameter("conductance_W_per_K", "W/K", typical_conductance_W_per_K(network))};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const auto [a, b] = pair_at(network, added.location);
    system.add_conductance(a, b, [](const Moment&, const double* p) { return p[0]; });
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect&, double batch_hours) const override {
    return block_that_shows(ScheduleKind::idle_day, {}, 4 * batch_hours);
  }
  void trace(OutputTraces& traces) const override {
    const std::vector<Index> all = traces.thermometers();
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const Index a = all[i], b = all[j];
        traces
            .heat_flow(traces.name(a) + "-" + traces.name(b), "",
                       [=](const PairedBatch& batch, Index k) { return batch.measured(k, a) - batch.measured(k, b); })
            .acts_on = {{a, -1}, {b, 1}};
      }
  }
};

/// A hidden mass C behind the place through G, which remembers: it starts at the temperature of its node. Behind
/// several nodes it is as many masses, C and G shared out as the capacities of the nodes.
class ThermalMemory : public Effect {
 public:
  std::string name() const override { return "thermal-memory"; }
  Stage stage() const override { return Stage::conduction; }
  std::string meaning() const override { return "a hidden mass stores heat"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const std::string& place : spread_places(setting.network)) {
      if (place == "all") continue;
      ThermalNetwork::AddedEffect one{name(), place, "", {}};
      for (const EffectParameter& p : parameters(setting.network, one)) one.parameters.emplace_back(p.name, p.mean);
      result.push_back(std::move(one));
    }
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    double capacity = 0, conductance = 0;
    for (const Index node : nodes_at(network, added.location)) {
      const double own = network.nodes[static_cast<std::size_t>(node)].capacity_J_per_K;
      capacity += own;
      conductance += own / std::max(1e-9, network.time_constant_s(node));
    }
    EffectParameter C = log_parameter("capacity_J_per_K", "J/K", capacity, 1);
    EffectParameter G = log_parameter("conductance_W_per_K", "W/K", 0.3 * conductance, 1);
    C.starts = {capacity, 3 * capacity};
    C.shapes = true;
    return {C, G};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const std::vector<Index> nodes = nodes_at(network, added.location);
    const double share = 1 / static_cast<double>(nodes.size());
    for (const Index node : nodes) {
      const Index hidden = system.add_node(node, [share](const Moment&, const double* p) { return share * p[0]; });
      system.add_conductance(hidden, node, [share](const Moment&, const double* p) { return share * p[1]; });
    }
  }
  void trace(OutputTraces& traces) const override {
    for (const Index c : traces.thermometers())
      traces
          .heat_flow(traces.name(c), "",
                     [&](const PairedBatch& batch) {
                       Vector rise = batch.time_s;
                       for (Index k = 0; k < rise.size(); ++k) rise(k) = OutputTraces::rise_K(batch, c, k);
                       const Vector stored = low_pass(batch.time_s, rise, traces.lag_s(2), 0);
                       for (Index k = 0; k < rise.size(); ++k) rise(k) -= stored(k);
                       return rise;
                     })
          .acts_on = {{c, -1}};
  }
};

}  // namespace thermfit
