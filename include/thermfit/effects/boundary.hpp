#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/constants.hpp"
#include "thermfit/effects/output_traces.hpp"
#include "thermfit/effects/place.hpp"
#include "thermfit/effects/setting.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit {

/// Coolant that flows while an on/off input is on: + c(t) G (T_c - theta), G shared equally by the nodes of the place.
class Coolant : public Effect {
 public:
  std::string name() const override { return "coolant"; }
  Stage stage() const override { return Stage::boundary; }
  std::string meaning() const override { return "a coolant takes heat away while it is on"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const std::string& input : setting.on_off_inputs)
      for (const std::string& place : spread_places(setting.network))
        result.push_back({name(),
                          place,
                          input,
                          {{"conductance_W_per_K", 0},
                           {"temperature_degC", setting.network.reference_degC},
                           {"scale", setting.largest_of(input)}}});
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    const double count = static_cast<double>(nodes_at(network, added.location).size());
    return {positive_parameter("conductance_W_per_K", "W/K", count * typical_conductance_W_per_K(network)),
            shape_parameter("temperature_degC", "degC", network.reference_degC, 8, -50, 150),
            fixed_parameter("scale", 1)};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const Index input = system.input(added.driver);
    const std::vector<Index> nodes = nodes_at(network, added.location);
    const double share = 1 / static_cast<double>(nodes.size());
    for (const Index node : nodes)
      system.add_conductance_to(
          node, [=](const Moment& now, const double* p) { return share * p[0] * now.inputs[input] / p[2]; },
          [](const Moment&, const double* p) { return p[1]; });
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect& where, double batch_hours) const override {
    if (where.driver.empty() || where.driver == "constant") return Effect::shown_by(where, batch_hours);
    return block_that_shows(ScheduleKind::toggle, where.driver, batch_hours);
  }
  void trace(OutputTraces& traces) const override {
    for (const Index c : traces.thermometers())
      for (const TraceInput& input : traces.inputs())
        if (input.on_off)
          traces
              .heat_flow(traces.name(c), input.name,
                         {[&](const PairedBatch& batch, Index k) { return input.at(batch, k); },
                          [&](const PairedBatch& batch, Index k) {
                            return input.at(batch, k) * (batch.measured(k, c) - traces.reference_degC()) / 10;
                          }})
              .acts_on = {{c, 0}};
  }
};

/// Ambient is not constant: theta_amb + share (measured - first measured); a share of 1 is its measured course.
class AmbientDrift : public Effect {
 public:
  std::string name() const override { return "ambient-drift"; }
  Stage stage() const override { return Stage::boundary; }
  std::string meaning() const override { return "the room does not stay at its first temperature"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    if (setting.network.ambient.rule == ThermalNetwork::Ambient::Rule::column || !setting.ambient_varies) return {};
    return {{name(), "ambient", "", {{"share", 1}}}};
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork&,
                                          const ThermalNetwork::AddedEffect& added) const override {
    if (added.location != "ambient") throw Error("location", "'" + added.location + "'", "ambient");
    EffectParameter share = linear_parameter("share", "", 0.3);
    share.mean = 1;
    return {share};
  }
  void act(ThermalSystem& system, const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    system.ambient_becomes([](const Moment& now, const double* p) {
      return now.ambient_degC + p[0] * (now.measured_ambient_degC - now.first_measured_ambient_degC);
    });
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect&, double batch_hours) const override {
    return block_that_shows(ScheduleKind::idle_day, {}, 4 * batch_hours);
  }
  void trace(OutputTraces& traces) const override {
    if (traces.has_room() && !traces.room_is_simulated())
      traces.heat_flow("ambient", "",
                       [](const PairedBatch& batch, Index k) { return OutputTraces::room_rise_K(batch, k); });
  }
};

/// Air moved by a rotating part: H_i (1 + k (n/n0)^0.8).
class ForcedConvection : public Effect {
 public:
  std::string name() const override { return "forced-convection"; }
  Stage stage() const override { return Stage::boundary; }
  std::string meaning() const override { return "cooling grows with its driver"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const std::string& input : setting.inputs)
      if (!setting.is_on_off(input))
        for (const std::string& place : spread_places(setting.network))
          result.push_back({name(), place, input, {{"k", 0}, {"scale", scale_of(setting, input)}}});
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    nodes_at(network, added.location);
    EffectParameter k = linear_parameter("k", "", 1);
    k.lower = -0.5;
    return {k, fixed_parameter("scale", 1)};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const Index input = system.input(added.driver);
    for (const Index node : nodes_at(network, added.location))
      system.scale_conductance(system.ambient_element(node), [input](const Moment& now, const double* p) {
        return std::max(-0.95, p[0] * std::pow(std::abs(now.inputs[input]) / p[1], 0.8));
      });
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect& where, double batch_hours) const override {
    return block_that_shows(ScheduleKind::speed_stair, where.driver, 1.25 * batch_hours);
  }
  void trace(OutputTraces& traces) const override {
    for (const Index c : traces.thermometers())
      for (const TraceInput& input : traces.inputs())
        if (!input.on_off)
          traces
              .heat_flow(traces.name(c), input.name,
                         [&](const PairedBatch& batch, Index k) {
                           return std::pow(input.share(batch, k), 0.8) * traces.rise_over_room_K(batch, c, k);
                         })
              .acts_on = {{c, -1}};
  }
};

/// Free air moves more the warmer the wall: H_i (1 + k (|theta - theta_amb|/10 K)^m).
class NaturalConvection : public Effect {
 public:
  std::string name() const override { return "natural-convection"; }
  Stage stage() const override { return Stage::boundary; }
  std::string meaning() const override { return "cooling grows with the temperature difference"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const std::string& place : spread_places(setting.network))
      result.push_back({name(), place, "", {{"k", 0}, {"exponent", 0.5}}});
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    nodes_at(network, added.location);
    return {positive_parameter("k", "", 1), shape_parameter("exponent", "", 0.5, 0.25, 0.25, 1)};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    for (const Index node : nodes_at(network, added.location))
      system.scale_conductance_by_state(system.ambient_element(node), [node](const Moment& now, const double* p) {
        return p[0] * std::pow(std::abs(now.temperature_degC[node] - now.ambient_degC) / 10, p[1]);
      });
  }
  void trace(OutputTraces& traces) const override {
    for (const Index c : traces.thermometers())
      traces
          .heat_flow(traces.name(c), "",
                     [&](const PairedBatch& batch, Index k) {
                       const double rise = traces.rise_over_room_K(batch, c, k);
                       return rise * std::pow(std::abs(rise) / 10, 0.5);
                     })
          .acts_on = {{c, -1}};
  }
};

/// Radiation to walls that follow ambient with a lag: + k_i (theta_wall^4 - theta^4) in kelvin, with k_i = share H_i /
/// (4 (293.15 K)^3): the share is what radiation adds to the ambient conductance of each node at 20 degC, relative to
/// it.
class Radiation : public Effect {
 public:
  std::string name() const override { return "radiation"; }
  Stage stage() const override { return Stage::boundary; }
  std::string meaning() const override { return "heat is radiated"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const std::string& place : spread_places(setting.network))
      result.push_back({name(), place, "", {{"share", 0}, {"lag_s", 0}}});
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    nodes_at(network, added.location);
    return {positive_parameter("share", "", 0.5), room_lag_parameter(3600, {0, 1800})};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    for (const Index node : nodes_at(network, added.location))
      system.drive_conductance(system.ambient_element(node), {node}, [node](const Moment& now, const double* p) {
        const double felt_K = now.ambient->felt_rise(at_least_a_second(p[1]), now.time_s);
        const double wall = now.first_ambient_degC + felt_K + ice_point_K;
        const double part = now.temperature_degC[node] + ice_point_K;
        return p[0] * (wall - part) * (wall + part) * (wall * wall + part * part) / (4 * 293.15 * 293.15 * 293.15);
      });
  }
  void trace(OutputTraces& traces) const override {
    if (!traces.has_room()) return;
    const auto fourth_power = [](double degC) { return std::pow((degC + ice_point_K) / 293.15, 4); };
    for (const Index c : traces.thermometers())
      traces
          .heat_flow(traces.name(c), "",
                     [&](const PairedBatch& batch, Index k) {
                       return fourth_power(batch.measured(k, c)) - fourth_power(batch.room_degC(k));
                     })
          .acts_on = {{c, -1}};
  }
};

}  // namespace thermfit
