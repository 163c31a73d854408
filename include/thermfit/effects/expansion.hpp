#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "thermfit/effects/output_traces.hpp"
#include "thermfit/effects/place.hpp"
#include "thermfit/effects/setting.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit {

namespace detail {

/// One parameter for each displacement: `name` where there is one, else `name_<output>`.
inline std::vector<EffectParameter> per_output(const ThermalNetwork& network, const std::string& name,
                                               const std::string& unit, double sd) {
  std::vector<EffectParameter> result;
  const bool one = network.displacements.size() == 1;
  for (const auto& output : network.displacements)
    result.push_back(linear_parameter(one ? name : name + '_' + output.output, unit, sd));
  return result;
}

}  // namespace detail

/// Expansion of a node that the displacement ignores: + e (theta - reference).
class MissingExpansion : public Effect {
 public:
  std::string name() const override { return "missing-expansion"; }
  Stage stage() const override { return Stage::expansion; }
  std::string meaning() const override { return "a part expands that the simulator leaves out"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    if (setting.network.displacements.empty()) return result;
    for (Index i = 0; i < setting.network.node_count(); ++i) {
      bool expands = false;
      for (const auto& output : setting.network.displacements)
        for (const auto& [node, um_per_K] : output.um_per_K) expands = expands || (node == i && um_per_K != 0);
      if (expands) continue;
      ThermalNetwork::AddedEffect one{name(), setting.network.nodes[static_cast<std::size_t>(i)].name, "", {}};
      for (const EffectParameter& p : parameters(setting.network, one)) one.parameters.emplace_back(p.name, p.mean);
      result.push_back(std::move(one));
    }
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    node_at(network, added.location);
    return detail::per_output(network, "um_per_K", "um/K", largest_expansion_um_per_K(network));
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const Index node = node_at(network, added.location);
    for (std::size_t d = 0; d < network.displacements.size(); ++d)
      system.displacement(static_cast<Index>(d), {node},
                          [=, reference = network.reference_degC](const Moment& now, const double* p) {
                            return p[d] * (now.temperature_degC[node] - reference);
                          });
  }
  void trace(OutputTraces& traces) const override {
    for (const Index z : traces.displacements())
      for (const Index c : traces.thermometers())
        traces.added_to(z, traces.name(c), "", {"um_per_K", "um/K"},
                        [=](const PairedBatch& batch, Index k) { return OutputTraces::rise_K(batch, c, k); });
  }
};

/// Expansion with a square: + k (theta - reference)^2 for each node of the place.
class NonlinearExpansion : public Effect {
 public:
  std::string name() const override { return "nonlinear-expansion"; }
  Stage stage() const override { return Stage::expansion; }
  std::string meaning() const override { return "the expansion is not proportional to temperature"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    if (setting.network.displacements.empty()) return result;
    for (const std::string& place : spread_places(setting.network)) {
      ThermalNetwork::AddedEffect one{name(), place, "", {}};
      for (const EffectParameter& p : parameters(setting.network, one)) one.parameters.emplace_back(p.name, p.mean);
      result.push_back(std::move(one));
    }
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    const double count = static_cast<double>(nodes_at(network, added.location).size());
    return detail::per_output(network, "um_per_K2", "um/K2", 0.1 * largest_expansion_um_per_K(network) / count);
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    for (const Index node : nodes_at(network, added.location))
      for (std::size_t d = 0; d < network.displacements.size(); ++d)
        system.displacement(static_cast<Index>(d), {node},
                            [=, reference = network.reference_degC](const Moment& now, const double* p) {
                              const double rise = now.temperature_degC[node] - reference;
                              return p[d] * rise * rise;
                            });
  }
  void trace(OutputTraces& traces) const override {
    for (const Index z : traces.displacements())
      for (const Index c : traces.thermometers())
        traces.added_to(z, traces.name(c), "", {"um_per_K2", "um/K2"}, [&](const PairedBatch& batch, Index k) {
          const double rise = batch.measured(k, c) - traces.reference_degC();
          return rise * rise;
        });
  }
};

/// The spindle moves at once with speed, without any change of temperature: + k (n/n0)^2.
class SpeedShift : public Effect {
 public:
  std::string name() const override { return "speed-shift"; }
  Stage stage() const override { return Stage::expansion; }
  std::string meaning() const override { return "a shift follows its driver at once, without any heat"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const std::string& place : displacement_places(setting.network))
      for (const std::string& input : setting.inputs)
        if (!setting.is_on_off(input))
          result.push_back({name(), place, input, {{"shift_um", 0}, {"scale", scale_of(setting, input)}}});
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    displacements_at(network, added.location);
    return {linear_parameter("shift_um", "um", 5), fixed_parameter("scale", 1)};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const Index input = system.input(added.driver);
    for (const Index output : displacements_at(network, added.location))
      system.displacement(output, {}, [input](const Moment& now, const double* p) {
        const double u = now.inputs[input] / p[1];
        return p[0] * u * u;
      });
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect& where, double batch_hours) const override {
    return block_that_shows(ScheduleKind::speed_stair, where.driver, 1.25 * batch_hours);
  }
  void trace(OutputTraces& traces) const override {
    for (const Index z : traces.displacements())
      for (const TraceInput& input : traces.inputs())
        traces.added_to(z, traces.place(z), input.name, {"shift_um", "um"}, [&](const PairedBatch& batch, Index k) {
          return input.share(batch, k) * input.share(batch, k);
        });
  }
};

/// Play (backlash) of half-width r on the displacement: it stays until pushed by more than r either way.
class Hysteresis : public Effect {
 public:
  std::string name() const override { return "hysteresis"; }
  Stage stage() const override { return Stage::expansion; }
  std::string meaning() const override { return "play delays the displacement"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const std::string& place : displacement_places(setting.network))
      result.push_back({name(), place, "", {{"half_width_um", 1}}});
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    displacements_at(network, added.location);
    EffectParameter width = positive_parameter("half_width_um", "um", 4);
    width.starts = {1, 4};
    return {width};
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    for (const Index output : displacements_at(network, added.location)) system.displacement_series(output, play);
  }
  void trace(OutputTraces& traces) const override {
    for (const Index z : traces.displacements())
      for (double share = .004; share < .3; share *= 1.3) {
        const double half_width = share * traces.range_of(z);
        traces.bends(z, {"half_width_um", "um", half_width},
                     [=](const Vector&, const Vector& course) { return thermfit::play(course, half_width); });
      }
  }

 private:
  static void play(Eigen::Ref<Vector> z, Matrix& tangents, const double* p, const Column* columns) {
    for (Index k = 1; k < z.size(); ++k) {
      const double side = z(k) - p[0] > z(k - 1) ? -1 : z(k) + p[0] < z(k - 1) ? 1 : 0;
      if (side == 0) {
        z(k) = z(k - 1);
        if (tangents.cols() > 0) tangents.row(k) = tangents.row(k - 1).eval();
      } else {
        z(k) += side * p[0];
        if (columns[0] >= 0) tangents(k, columns[0]) += side;
      }
    }
  }
};

}  // namespace thermfit
