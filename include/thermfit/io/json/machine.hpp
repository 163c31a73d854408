#pragma once

/// The document `thermfit-machine/1`: a thermal network as JSON.

#include <string>
#include <utility>
#include <vector>

#include "thermfit/io/files/atomic_file.hpp"
#include "thermfit/io/json/machine_reader.hpp"
#include "thermfit/network/effect.hpp"
#include "thermfit/network/network_check.hpp"
#include "thermfit/network/parameters.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

namespace detail {

template <typename J>
J by_node_json(const ThermalNetwork& network, const std::vector<std::pair<Index, double>>& entries) {
  J object = J::object();
  for (const auto& [node, value] : entries) object[network.nodes[static_cast<std::size_t>(node)].name] = value;
  return object;
}

}  // namespace detail

/// The network in a parsed document; `file` names it in errors. Throws Error with the key path, what was found and what
/// is allowed. Effects are looked up in `effects` and get every parameter of their laws.
template <typename J = Json>
ThermalNetwork machine_from_json(const J& document, const std::string& file, const EffectLibrary& effects) {
  ThermalNetwork network = detail::MachineReader<J>({document, file}).read();
  check_network(network, file);
  try {
    return with_complete_effects(std::move(network), effects);
  } catch (const Error& error) {
    throw Error(file + ": " + error.place(), error.found(), error.allowed(), error.remedy());
  }
}

/// The network in a file; throws Error also when the file cannot be read or is no JSON.
template <typename J = Json>
ThermalNetwork read_machine(const std::string& path, const EffectLibrary& effects) {
  return machine_from_json(read_json<J>(path), path, effects);
}

/// The document of a network; reading it gives the same network to the last bit.
template <typename J = Json>
J machine_to_json(const ThermalNetwork& network) {
  const auto name = [&](Index node) {
    return node < 0 ? std::string("ambient") : network.nodes[static_cast<std::size_t>(node)].name;
  };
  J document{{"format", "thermfit-machine/1"}};
  if (!network.name.empty()) document["name"] = network.name;
  document["reference_temperature_C"] = network.reference_degC;
  using Rule = ThermalNetwork::Ambient::Rule;
  switch (network.ambient.rule) {
    case Rule::column:
      document["ambient"] = network.ambient.column;
      break;
    case Rule::constant:
      document["ambient"] = network.ambient.value_degC;
      break;
    case Rule::initial:
      document["ambient"] = "initial";
      break;
    case Rule::first_sample_of:
      document["ambient"] = J{{"first_sample_of", network.ambient.column}};
      break;
    case Rule::unmeasured:
      document["ambient"] = J{{"unmeasured", true}};
      break;
  }
  document["nodes"] = J::array();
  for (const auto& node : network.nodes)
    document["nodes"].push_back(
        {{"name", node.name}, {"capacity_J_per_K", node.capacity_J_per_K}, {"ambient_W_per_K", node.ambient_W_per_K}});
  document["links"] = J::array();
  for (const auto& link : network.links)
    document["links"].push_back(
        {{"between", J::array({name(link.a), name(link.b)})}, {"conductance_W_per_K", link.conductance_W_per_K}});
  document["heat_sources"] = J::array();
  for (const auto& source : network.heat_sources)
    document["heat_sources"].push_back({{"name", source.name},
                                        {"input", source.input},
                                        {"scale", source.scale},
                                        {"exponent", source.exponent},
                                        {"power_W", source.power_W},
                                        {"into", detail::by_node_json<J>(network, source.into)}});
  J outputs = J::array();
  for (const auto& output : network.displacements) {
    J entry{{"output", output.output}, {"zero", output.zero_at_first_sample ? "first_sample" : "reference"}};
    if (output.absolute) entry["datum"] = "absolute";
    entry["um_per_K"] = detail::by_node_json<J>(network, output.um_per_K);
    outputs.push_back(std::move(entry));
  }
  if (outputs.size() == 1) document["displacement"] = outputs[0];
  if (outputs.size() > 1) document["displacement"] = outputs;
  if (!network.sensors.empty()) document["sensors"] = Json::object();
  for (const auto& sensor : network.sensors) {
    J& entry = document["sensors"][sensor.column] = J{{"node", name(sensor.node)}};
    if (sensor.offset_K != 0) entry["offset_K"] = sensor.offset_K;
    std::vector<std::pair<Index, double>> moved;
    for (const auto& share : sensor.placement)
      if (share.second != 0) moved.push_back(share);
    if (!moved.empty()) entry["placement"] = detail::by_node_json<J>(network, moved);
    if (sensor.response_s != 0) entry["response_s"] = sensor.response_s;
  }
  for (const auto& channel : network.channels) {
    J& entry = document["channels"][channel.column] = J::object();
    if (!channel.unit.empty()) entry["unit"] = channel.unit;
    if (channel.correction) entry["sign"] = "correction";
  }
  using Start = ThermalNetwork::Initial::Rule;
  document["initial"] = network.initial.share != 0                ? J(network.initial.share)
                        : network.initial.rule == Start::ambient  ? J("ambient")
                        : network.initial.rule == Start::measured ? J("measured")
                        : network.initial.rule == Start::fitted
                            ? J("fitted")
                            : detail::by_node_json<J>(network, network.initial.degC);
  const ThermalNetwork::Uncertainty& sd = network.uncertainty;
  document["uncertainty"] = {{"capacity", sd.capacity},
                             {"ambient", sd.ambient},
                             {"conductance", sd.conductance},
                             {"power", sd.power},
                             {"um_per_K", sd.um_per_K},
                             {"sensor_offset_K", sd.sensor_offset_K},
                             {"sensor_placement", sd.sensor_placement},
                             {"sensor_response", sd.sensor_response}};
  if (network.effects.empty()) return document;
  document["effects"] = J::array();
  for (const auto& added : network.effects) {
    J entry{{"effect", added.effect}, {"location", added.location}};
    if (!added.driver.empty()) entry["driver"] = added.driver;
    for (const auto& [key, value] : added.parameters) entry[key] = value;
    document["effects"].push_back(entry);
  }
  return document;
}

/// Saves so that a reader sees the old file or the whole new one. Throws Error when it cannot be written.
template <typename J = Json>
void save_machine(const ThermalNetwork& network, const std::string& path) {
  write_atomically(path, machine_to_json<J>(network).dump(1) + '\n');
}

THERMFIT_COMPILED_TEMPLATE(ThermalNetwork machine_from_json<Json>(const Json&, const std::string&,
                                                                  const EffectLibrary&));
THERMFIT_COMPILED_TEMPLATE(ThermalNetwork read_machine<Json>(const std::string&, const EffectLibrary&));
THERMFIT_COMPILED_TEMPLATE(Json machine_to_json<Json>(const ThermalNetwork&));
THERMFIT_COMPILED_TEMPLATE(void save_machine<Json>(const ThermalNetwork&, const std::string&));

}  // namespace thermfit
