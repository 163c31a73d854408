#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/network/effect.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// One number that calibration may move, with what is known of it beforehand.
///
/// Its working coordinate t is 0 at the prior's mean and counts prior standard deviations:
/// value = mean exp(sd t) where `logarithmic`, else mean + sd t. So the prior of every t is N(0, 1).
struct Parameter {
  /// Which number of the network it is.
  enum class Kind {
    capacity,
    ambient,
    conductance,
    power,
    expansion,
    sensor_offset,
    placement,
    response,
    start,
    batch_start,
    batch_ambient,
    effect
  };
  Kind kind = Kind::capacity;  ///< which number it is
  std::size_t item = 0;  ///< node, node, link, source, displacement, sensor, sensor, sensor, –, batch, batch, effect
  /// Entry of the displacement's um_per_K or of the sensor's placement, node or shape of the batch's number, or
  /// parameter of the effect.
  std::size_t part = 0;
  std::string name;          ///< "capacity of head_front"
  std::string unit;          ///< of the value; empty for a pure number
  bool logarithmic = false;  ///< positive, moved by its logarithm
  double mean = 0;           ///< of the prior
  double sd = 1;             ///< of the prior: of the value, or of its logarithm where `logarithmic`
  double lower = -std::numeric_limits<double>::infinity();  ///< of the value
  double upper = std::numeric_limits<double>::infinity();   ///< of the value

  /// A number of the machine's own physics, as its document states it; not how it is read, nor what was added.
  bool of_machine() const { return kind <= Kind::expansion; }
  /// A number of one batch (`item`), which no other batch can tell.
  bool of_batch() const { return kind == Kind::batch_start || kind == Kind::batch_ambient; }

  /// The value at a working coordinate.
  double value(double t) const { return logarithmic ? mean * std::exp(sd * t) : mean + sd * t; }
  /// The working coordinate of a value.
  double coordinate(double value) const { return logarithmic ? std::log(value / mean) / sd : (value - mean) / sd; }
  /// dvalue/dt at t.
  double slope(double t) const { return logarithmic ? sd * value(t) : sd; }
};

namespace detail {

/// Gives `take` a reference to the number itself, in any network of the same shape.
template <class Network, class Take>
void visit_value(Network& network, const Parameter& parameter, Take take) {
  using Kind = Parameter::Kind;
  switch (parameter.kind) {
    case Kind::capacity:
      return take(network.nodes[parameter.item].capacity_J_per_K);
    case Kind::ambient:
      return take(network.nodes[parameter.item].ambient_W_per_K);
    case Kind::conductance:
      return take(network.links[parameter.item].conductance_W_per_K);
    case Kind::power:
      return take(network.heat_sources[parameter.item].power_W);
    case Kind::expansion:
      return take(network.displacements[parameter.item].um_per_K[parameter.part].second);
    case Kind::sensor_offset:
      return take(network.sensors[parameter.item].offset_K);
    case Kind::placement:
      return take(network.sensors[parameter.item].placement[parameter.part].second);
    case Kind::response:
      return take(network.sensors[parameter.item].response_s);
    case Kind::start:
      return take(network.initial.share);
    case Kind::batch_start:
      return take(network.batches[parameter.item].start_K[parameter.part]);
    case Kind::batch_ambient:
      return take(network.batches[parameter.item].ambient_K[parameter.part]);
    case Kind::effect:
      return take(network.effects[parameter.item].parameters[parameter.part].second);
  }
}

}  // namespace detail

/// The effects of a network with every parameter of their laws, in the order of the law; those that are absent get the
/// prior's mean. Throws Error on an unknown effect, place or parameter.
template <typename Scalar = double>
ThermalNetwork with_complete_effects(Lazy<ThermalNetwork, Scalar> network, const EffectLibrary& effects) {
  for (std::size_t e = 0; e < network.effects.size(); ++e) {
    ThermalNetwork::AddedEffect& added = network.effects[e];
    const std::vector<EffectParameter> known = effects.at(added.effect).parameters(network, added);
    std::vector<std::pair<std::string, double>> complete;
    for (const EffectParameter& one : known) complete.emplace_back(one.name, added.value(one.name, one.mean));
    for (const auto& [name, value] : added.parameters) {
      const auto is_it = [&name = name](const EffectParameter& one) { return one.name == name; };
      if (std::any_of(known.begin(), known.end(), is_it)) continue;
      std::string allowed;
      for (const EffectParameter& one : known) allowed += (allowed.empty() ? "" : ", ") + one.name;
      throw Error("effects[" + std::to_string(e) + "]." + name, "no such parameter of " + added.effect, allowed,
                  "remove or rename it");
    }
    added.parameters = std::move(complete);
  }
  return network;
}

/// The network with a share, zero at first, for every neighbour of every sensor's node, so that calibration can move
/// it.
template <typename Scalar = double>
ThermalNetwork with_placements(Lazy<ThermalNetwork, Scalar> network) {
  for (ThermalNetwork::Sensor& sensor : network.sensors)
    for (const ThermalNetwork::Link& link : network.links) {
      if (link.a != sensor.node && link.b != sensor.node) continue;
      const Index neighbour = link.a == sensor.node ? link.b : link.a;
      const bool known = std::any_of(sensor.placement.begin(), sensor.placement.end(),
                                     [&](const auto& one) { return one.first == neighbour; });
      if (!known) sensor.placement.emplace_back(neighbour, 0.0);
    }
  return network;
}

namespace detail {

/// Appends what can be calibrated, with the prior that ThermalNetwork::Uncertainty gives it.
class ParameterList {
 public:
  /// A number above 0, by its logarithm; `sd` is relative.
  void positive(Parameter::Kind kind, std::size_t item, std::string name, const char* unit, double value, double sd) {
    if (value > 0 && sd > 0) list_.push_back({kind, item, 0, std::move(name), unit, true, value, sd, 0});
  }
  void linear(Parameter::Kind kind, std::size_t item, std::size_t part, std::string name, const char* unit, double mean,
              double sd) {
    if (sd > 0) list_.push_back({kind, item, part, std::move(name), unit, false, mean, sd});
  }
  void add(Parameter parameter) { list_.push_back(std::move(parameter)); }
  std::vector<Parameter> take() && { return std::move(list_); }

 private:
  std::vector<Parameter> list_;
};

template <typename Scalar>
void add_physics(ParameterList& list, const Lazy<ThermalNetwork, Scalar>& network) {
  using Kind = Parameter::Kind;
  const ThermalNetwork::Uncertainty& sd = network.uncertainty;
  const auto& nodes = network.nodes;
  const auto name = [&](Index node) -> const std::string& { return nodes[static_cast<std::size_t>(node)].name; };
  for (std::size_t i = 0; i < nodes.size(); ++i)
    list.positive(Kind::capacity, i, "capacity of " + nodes[i].name, "J/K", nodes[i].capacity_J_per_K, sd.capacity);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    list.positive(Kind::ambient, i, nodes[i].name + " to ambient", "W/K", nodes[i].ambient_W_per_K, sd.ambient);
  for (std::size_t i = 0; i < network.links.size(); ++i) {
    const ThermalNetwork::Link& link = network.links[i];
    list.positive(Kind::conductance, i, name(link.a) + " to " + name(link.b), "W/K", link.conductance_W_per_K,
                  sd.conductance);
  }
  for (std::size_t i = 0; i < network.heat_sources.size(); ++i)
    list.positive(Kind::power, i, "power of " + network.heat_sources[i].name, "W", network.heat_sources[i].power_W,
                  sd.power);
  for (std::size_t i = 0; i < network.displacements.size(); ++i) {
    const ThermalNetwork::Displacement& output = network.displacements[i];
    for (std::size_t k = 0; k < output.um_per_K.size(); ++k) {
      const auto [node, value] = output.um_per_K[k];
      list.linear(Kind::expansion, i, k, output.output + " per K of " + name(node), "um/K", value,
                  sd.um_per_K * std::abs(value));
    }
  }
}

template <typename Scalar>
void add_readings(ParameterList& list, const Lazy<ThermalNetwork, Scalar>& network) {
  using Kind = Parameter::Kind;
  const ThermalNetwork::Uncertainty& sd = network.uncertainty;
  const std::vector<ThermalNetwork::Sensor>& sensors = network.sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (sensors[i].node >= 0)
      list.linear(Kind::sensor_offset, i, 0, "offset of " + sensors[i].column, "K", sensors[i].offset_K,
                  sd.sensor_offset_K);
  for (std::size_t i = 0; i < sensors.size(); ++i)
    for (std::size_t k = 0; k < sensors[i].placement.size(); ++k) {
      const auto [node, share] = sensors[i].placement[k];
      list.linear(Kind::placement, i, k,
                  sensors[i].column + " towards " + network.nodes[static_cast<std::size_t>(node)].name, "", share,
                  sd.sensor_placement);
    }
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (sensors[i].node >= 0)
      list.linear(Kind::response, i, 0, "response of " + sensors[i].column, "s", sensors[i].response_s,
                  sd.sensor_response * network.time_constant_s(sensors[i].node));
  if (network.initial.rule == ThermalNetwork::Initial::Rule::ambient && sd.start_share > 0)
    list.add({Kind::start, 0, 0, "share of the first readings in the start", "", false, network.initial.share,
              sd.start_share, 0, 1});
}

template <typename Scalar>
void add_batches(ParameterList& list, const Lazy<ThermalNetwork, Scalar>& network) {
  using Kind = Parameter::Kind;
  for (std::size_t b = 0; b < network.batches.size(); ++b) {
    const ThermalNetwork::OfBatch& one = network.batches[b];
    for (std::size_t i = 0; i < one.start_K.size(); ++i)
      list.linear(Kind::batch_start, b, i, "start of " + network.nodes[i].name + " in " + one.name, "K", one.start_K[i],
                  one.start_sd_K[i]);
    for (std::size_t k = 0; k < one.ambient_K.size(); ++k)
      list.linear(Kind::batch_ambient, b, k, std::string(k == 0 ? "" : "course of ") + "ambient in " + one.name, "K",
                  one.ambient_K[k], one.ambient_sd_K[k]);
  }
}

template <typename Scalar>
void add_effects(ParameterList& list, const Lazy<ThermalNetwork, Scalar>& network, const EffectLibrary& effects) {
  for (std::size_t e = 0; e < network.effects.size(); ++e) {
    const ThermalNetwork::AddedEffect& added = network.effects[e];
    const std::vector<EffectParameter> own = effects.at(added.effect).parameters(network, added);
    for (std::size_t k = 0; k < own.size(); ++k)
      if (!own[k].fixed)
        list.add({Parameter::Kind::effect, e, k, added.effect + " at " + added.location + ": " + own[k].name,
                  own[k].unit, own[k].logarithmic, own[k].mean, own[k].sd, own[k].lower, own[k].upper});
  }
}

}  // namespace detail

/// Everything that can be calibrated, in this order: capacities, ambient conductances, links, powers, expansions,
/// sensor offsets, placements and responses, the start, numbers of single batches, then each effect's own
/// (network.effects must be complete). Numbers that are zero and cannot be negative stay zero and are left out, and so
/// are offsets of ambient sensors. Throws Error on an unknown effect or place. Allocates.
template <typename Scalar = double>
std::vector<Parameter> calibration_parameters(const Lazy<ThermalNetwork, Scalar>& network,
                                              const EffectLibrary& effects) {
  detail::ParameterList list;
  detail::add_physics<Scalar>(list, network);
  detail::add_readings<Scalar>(list, network);
  detail::add_batches<Scalar>(list, network);
  detail::add_effects<Scalar>(list, network, effects);
  return std::move(list).take();
}

THERMFIT_COMPILED_TEMPLATE(std::vector<Parameter> calibration_parameters<double>(const ThermalNetwork&,
                                                                                 const EffectLibrary&));

/// The number that a parameter stands for, in a network of the same shape. Does not allocate.
inline double value_in(const ThermalNetwork& network, const Parameter& parameter) {
  double result = 0;
  detail::visit_value(network, parameter, [&](const double& value) { result = value; });
  return result;
}

/// value_in() of each parameter. Allocates.
inline Vector values_of(const ThermalNetwork& network, const std::vector<Parameter>& parameters) {
  Vector values(static_cast<Index>(parameters.size()));
  for (std::size_t j = 0; j < parameters.size(); ++j) values(static_cast<Index>(j)) = value_in(network, parameters[j]);
  return values;
}

/// The network with other values, in the order of `parameters`. Allocates the copy.
inline ThermalNetwork with_values(ThermalNetwork network, const std::vector<Parameter>& parameters,
                                  const Vector& values) {
  for (std::size_t j = 0; j < parameters.size(); ++j)
    detail::visit_value(network, parameters[j], [&](double& value) { value = values(static_cast<Index>(j)); });
  return network;
}

}  // namespace thermfit
