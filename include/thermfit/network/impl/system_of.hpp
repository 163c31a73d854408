#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "thermfit/lazy.hpp"
#include "thermfit/network/effect.hpp"
#include "thermfit/network/parameters.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit {

namespace detail {

inline void add_effect(ThermalSystem& system, const ThermalNetwork& network, std::size_t index, const Effect& effect,
                       const std::vector<Parameter>& parameters) {
  const ThermalNetwork::AddedEffect& added = network.effects[index];
  BoundLaw::Owner owner;
  for (const EffectParameter& one : effect.parameters(network, added)) {
    const double value = added.value(one.name, one.mean);
    owner.values.push_back(value);
    owner.steps.push_back(1e-5 * (one.logarithmic ? std::abs(value) : std::max(std::abs(value), one.sd)));
    owner.columns.push_back(-1);
  }
  if (owner.values.size() > ThermalSystem::most_parameters)
    throw Error("effect " + added.effect, std::to_string(owner.values.size()) + " parameters",
                "at most " + std::to_string(ThermalSystem::most_parameters));
  for (std::size_t j = 0; j < parameters.size(); ++j)
    if (parameters[j].kind == Parameter::Kind::effect && parameters[j].item == index)
      owner.columns[parameters[j].part] = static_cast<Column>(j);
  system.owners.push_back(std::move(owner));
  effect.act(system, network, added);
}

/// Places of the parameters among the columns of the sensitivities.
class ParameterColumns {
 public:
  explicit ParameterColumns(const std::vector<Parameter>& parameters) : parameters_(parameters) {}
  Column operator()(Parameter::Kind kind, std::size_t item, std::size_t part = 0) const {
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      if (parameters_[j].kind == kind && parameters_[j].item == item && parameters_[j].part == part)
        return static_cast<Column>(j);
    return -1;
  }

 private:
  const std::vector<Parameter>& parameters_;
};

/// Capacities, conductances and heat sources.
template <typename Scalar>
void add_elements(Lazy<ThermalSystem, Scalar>& system, const Lazy<ThermalNetwork, Scalar>& network,
                  const ParameterColumns& column) {
  using Kind = Parameter::Kind;
  for (std::size_t i = 0; i < network.nodes.size(); ++i) {
    ThermalSystem::Capacity capacity;
    capacity.J_per_K = network.nodes[i].capacity_J_per_K;
    capacity.column = column(Kind::capacity, i);
    system.capacities.push_back(std::move(capacity));
    ThermalSystem::Conductance to_ambient;
    to_ambient.a = static_cast<Index>(i);
    to_ambient.W_per_K = network.nodes[i].ambient_W_per_K;
    to_ambient.column = column(Kind::ambient, i);
    system.conductances.push_back(std::move(to_ambient));
  }
  for (std::size_t i = 0; i < network.links.size(); ++i) {
    ThermalSystem::Conductance link;
    link.a = network.links[i].a;
    link.b = network.links[i].b;
    link.W_per_K = network.links[i].conductance_W_per_K;
    link.column = column(Kind::conductance, i);
    system.conductances.push_back(std::move(link));
  }
  for (std::size_t i = 0; i < network.heat_sources.size(); ++i) {
    const ThermalNetwork::HeatSource& source = network.heat_sources[i];
    system.sources.push_back({source.into, source.power_W, source.scale, source.exponent,
                              source.input == "constant" ? -1 : system.input(source.input), column(Kind::power, i)});
  }
}

/// Sensors, the start that their first readings give, and displacements.
template <typename Scalar>
void add_channels(Lazy<ThermalSystem, Scalar>& system, const Lazy<ThermalNetwork, Scalar>& network,
                  const ParameterColumns& column) {
  using Kind = Parameter::Kind;
  for (std::size_t i = 0; i < network.sensors.size(); ++i) {
    ThermalSystem::Sensor sensor;
    sensor.node = network.sensors[i].node;
    sensor.offset_K = network.sensors[i].offset_K;
    sensor.column = column(Kind::sensor_offset, i);
    sensor.placement = network.sensors[i].placement;
    for (std::size_t k = 0; k < sensor.placement.size(); ++k)
      sensor.placement_columns.push_back(column(Kind::placement, i, k));
    sensor.response_s = network.sensors[i].response_s;
    sensor.response_column = column(Kind::response, i);
    system.sensors.push_back(std::move(sensor));
  }
  system.start_by_readings = {network.initial.share, column(Kind::start, 0), {}};
  for (const ThermalNetwork::Sensor& sensor : network.sensors)
    system.start_by_readings.node_of_sensor.push_back(sensor.node);
  for (std::size_t i = 0; i < network.displacements.size(); ++i) {
    ThermalSystem::Displacement output;
    output.zero_at_first_sample = network.displacements[i].zero_at_first_sample;
    output.free_datum = network.displacements[i].free_datum;
    output.um_per_K = network.displacements[i].um_per_K;
    for (std::size_t k = 0; k < output.um_per_K.size(); ++k) output.columns.push_back(column(Kind::expansion, i, k));
    system.displacements.push_back(std::move(output));
  }
}

}  // namespace detail

/// The elements of a network and its effects; `parameters` are the numbers whose sensitivities are wanted, in order.
/// Throws Error on an unknown effect or place. Allocates.
template <typename Scalar = double>
ThermalSystem system_of(const ThermalNetwork& network, const EffectLibrary& effects,
                        const std::vector<Parameter>& parameters) {
  using Kind = Parameter::Kind;
  ThermalSystem system;
  system.own_nodes = network.node_count();
  system.reference_degC = network.reference_degC;
  system.columns = static_cast<Index>(parameters.size());
  const bool offsets_move_start = network.initial.rule == ThermalNetwork::Initial::Rule::measured ||
                                  network.initial.rule == ThermalNetwork::Initial::Rule::fitted;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const Kind kind = parameters[j].kind;
    if (!parameters[j].of_batch() && kind != Kind::expansion && kind != Kind::placement && kind != Kind::response &&
        (kind != Kind::sensor_offset || offsets_move_start))
      system.state_columns.push_back(static_cast<Column>(j));
  }
  const detail::ParameterColumns column(parameters);
  detail::add_elements<Scalar>(system, network, column);
  detail::add_channels<Scalar>(system, network, column);
  for (const ThermalNetwork::OfBatch& one : network.batches)
    system.batches.push_back({one.start_K, std::vector<Column>(one.start_K.size(), -1), one.ambient_K,
                              std::vector<Column>(one.ambient_K.size(), -1)});
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const auto [kind, batch, part] = std::tie(parameters[j].kind, parameters[j].item, parameters[j].part);
    if (kind == Kind::batch_start) system.batches[batch].start_columns[part] = static_cast<Column>(j);
    if (kind == Kind::batch_ambient) system.batches[batch].ambient_columns[part] = static_cast<Column>(j);
  }
  for (std::size_t e = 0; e < network.effects.size(); ++e)
    detail::add_effect(system, network, e, effects.at(network.effects[e].effect), parameters);
  return system;
}

}  // namespace thermfit
