#pragma once

/// The document `thermfit-machine/1`: a thermal network as JSON.

#include <string>
#include <vector>

#include "thermfit/constants.hpp"
#include "thermfit/io/json/node.hpp"
#include "thermfit/network/effect.hpp"
#include "thermfit/network/network_check.hpp"
#include "thermfit/network/parameters.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

namespace detail {

class MachineReader {
 public:
  explicit MachineReader(const JsonNode& root) : root_(root) {}

  ThermalNetwork read() {
    root_.require_format("thermfit-machine", 1);
    root_.require_keys({"format", "name", "reference_temperature_C", "ambient", "nodes", "links", "heat_sources",
                        "displacement", "sensors", "initial", "uncertainty", "effects"});
    if (const auto name = root_.find("name")) network_.name = name->text();
    network_.reference_degC = root_.at("reference_temperature_C").number(absolute_zero_degC, 2000);
    read_ambient(root_.at("ambient"));
    read_nodes(root_.at("nodes"));
    if (const auto links = root_.find("links")) read_links(*links);
    if (const auto sources = root_.find("heat_sources")) read_heat_sources(*sources);
    if (const auto displacement = root_.find("displacement")) {
      const bool several = displacement->json().is_array();
      for (std::size_t i = 0, n = several ? displacement->size() : 1; i < n; ++i)
        read_displacement(several ? displacement->item(i) : *displacement);
    }
    if (const auto sensors = root_.find("sensors")) read_sensors(*sensors);
    if (const auto initial = root_.find("initial")) read_initial(*initial);
    if (const auto uncertainty = root_.find("uncertainty")) read_uncertainty(*uncertainty);
    if (const auto effects = root_.find("effects"))
      for (std::size_t i = 0; i < effects->size(); ++i) read_effect(effects->item(i));
    return network_;
  }

 private:
  void read_ambient(const JsonNode& node) {
    using Rule = ThermalNetwork::Ambient::Rule;
    ThermalNetwork::Ambient& ambient = network_.ambient;
    if (node.json().is_number()) {
      ambient = {Rule::constant, "", node.number(absolute_zero_degC, 2000)};
    } else if (node.json().is_string()) {
      ambient = {node.text() == "initial" ? Rule::initial : Rule::column, node.text(), 0};
      if (ambient.rule == Rule::initial) ambient.column.clear();
    } else if (node.json().is_object()) {
      node.require_keys({"first_sample_of"});
      ambient = {Rule::first_sample_of, node.at("first_sample_of").text(), 0};
    } else {
      node.fail("neither a text, a number nor an object",
                "a column name, a number in degC, \"initial\" or {\"first_sample_of\": column}");
    }
  }

  void read_nodes(const JsonNode& list) {
    for (std::size_t i = 0; i < list.size(1000); ++i) {
      const JsonNode node = list.item(i);
      node.require_keys({"name", "capacity_J_per_K", "ambient_W_per_K"});
      ThermalNetwork::Node& added = network_.nodes.emplace_back();
      added.name = node.at("name").text();
      added.capacity_J_per_K = node.at("capacity_J_per_K").number();
      if (const auto ambient = node.find("ambient_W_per_K")) added.ambient_W_per_K = ambient->number();
      names_.push_back(added.name);
    }
  }

  Index node_named(const JsonNode& node, const std::string& name) const {
    const Index index = network_.find_node(name);
    if (index < 0)
      node.fail("there is no node '" + name + "'", name_list(names_),
                "add it or correct the name" + did_you_mean(name, names_));
    return index;
  }

  void read_links(const JsonNode& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const JsonNode link = list.item(i);
      link.require_keys({"between", "conductance_W_per_K"});
      const JsonNode between = link.at("between");
      if (between.size() != 2) between.fail(std::to_string(between.size()) + " names", "two nodes");
      network_.links.push_back({node_named(between.item(0), between.item(0).text()),
                                node_named(between.item(1), between.item(1).text()),
                                link.at("conductance_W_per_K").number()});
    }
  }

  /// An object of node: number.
  std::vector<std::pair<Index, double>> by_node(const JsonNode& object) const {
    if (!object.json().is_object()) object.fail("not an object", "{node: number}");
    std::vector<std::pair<Index, double>> result;
    for (const auto& [name, value] : object.json().items())
      result.emplace_back(node_named(object, name), object.at(name).number());
    return result;
  }

  void read_heat_sources(const JsonNode& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const JsonNode source = list.item(i);
      source.require_keys({"name", "input", "scale", "exponent", "power_W", "into"});
      ThermalNetwork::HeatSource& added = network_.heat_sources.emplace_back();
      added.name = source.at("name").text();
      added.input = source.at("input").text();
      if (const auto scale = source.find("scale")) added.scale = scale->number();
      if (const auto exponent = source.find("exponent")) added.exponent = exponent->number();
      added.power_W = source.at("power_W").number();
      added.into = by_node(source.at("into"));
    }
  }

  void read_displacement(const JsonNode& node) {
    node.require_keys({"output", "zero", "um_per_K"});
    ThermalNetwork::Displacement& added = network_.displacements.emplace_back();
    added.output = node.at("output").text();
    if (const auto zero = node.find("zero"))
      added.zero_at_first_sample = zero->choice({"first_sample", "reference"}) == "first_sample";
    added.um_per_K = by_node(node.at("um_per_K"));
  }

  void read_sensors(const JsonNode& object) {
    if (!object.json().is_object()) object.fail("not an object", "{column: {\"node\": name}}");
    for (const auto& [column, value] : object.json().items()) {
      const JsonNode sensor = object.at(column);
      sensor.require_keys({"node", "offset_K", "placement", "response_s"});
      const std::string node = sensor.at("node").text();
      const Index index = node == "ambient" ? ThermalNetwork::ambient_node : node_named(sensor.at("node"), node);
      ThermalNetwork::Sensor& added = network_.sensors.emplace_back();
      added.column = column;
      added.node = index;
      if (const auto offset = sensor.find("offset_K")) added.offset_K = offset->number();
      if (const auto placement = sensor.find("placement")) added.placement = by_node(*placement);
      if (const auto response = sensor.find("response_s")) added.response_s = response->number();
    }
  }

  void read_initial(const JsonNode& node) {
    using Rule = ThermalNetwork::Initial::Rule;
    if (node.json().is_string())
      network_.initial.rule = node.choice({"ambient", "measured"}) == "ambient" ? Rule::ambient : Rule::measured;
    else if (node.json().is_number())
      network_.initial = {Rule::ambient, {}, node.number(0, 1)};
    else
      network_.initial = {Rule::given, by_node(node), 0};
  }

  void read_uncertainty(const JsonNode& node) {
    node.require_keys({"capacity", "ambient", "conductance", "power", "um_per_K", "sensor_offset_K", "sensor_placement",
                       "sensor_response"});
    ThermalNetwork::Uncertainty& sd = network_.uncertainty;
    for (const auto& [key, target] : {std::pair<const char*, double*>{"capacity", &sd.capacity},
                                      {"ambient", &sd.ambient},
                                      {"conductance", &sd.conductance},
                                      {"power", &sd.power},
                                      {"um_per_K", &sd.um_per_K},
                                      {"sensor_offset_K", &sd.sensor_offset_K},
                                      {"sensor_placement", &sd.sensor_placement},
                                      {"sensor_response", &sd.sensor_response}})
      if (const auto value = node.find(key)) *target = value->number();
  }

  void read_effect(const JsonNode& node) {
    if (!node.json().is_object()) node.fail("not an object", "{\"effect\", \"location\", parameters…}");
    ThermalNetwork::AddedEffect& added = network_.effects.emplace_back();
    added.effect = node.at("effect").text();
    added.location = node.at("location").text();
    if (const auto driver = node.find("driver")) added.driver = driver->text();
    for (const auto& [key, value] : node.json().items())
      if (key != "effect" && key != "location" && key != "driver")
        added.parameters.emplace_back(key, node.at(key).number());
  }

  JsonNode root_;
  ThermalNetwork network_;
  std::vector<std::string> names_;
};

inline Json by_node_json(const ThermalNetwork& network, const std::vector<std::pair<Index, double>>& entries) {
  Json object = Json::object();
  for (const auto& [node, value] : entries) object[network.nodes[static_cast<std::size_t>(node)].name] = value;
  return object;
}

}  // namespace detail

/// The network in a parsed document; `file` names it in errors. Throws Error with the key path, what was found and what
/// is allowed. Effects are looked up in `effects` and get every parameter of their laws.
inline ThermalNetwork machine_from_json(const Json& document, const std::string& file, const EffectLibrary& effects) {
  ThermalNetwork network = detail::MachineReader({document, file}).read();
  check_network(network, file);
  try {
    return with_complete_effects(std::move(network), effects);
  } catch (const Error& error) {
    throw Error(file + ": " + error.place(), error.found(), error.allowed(), error.remedy());
  }
}

inline ThermalNetwork read_machine(const std::string& path, const EffectLibrary& effects) {
  return machine_from_json(read_json(path), path, effects);
}

/// The document of a network; reading it gives the same network to the last bit.
inline Json machine_to_json(const ThermalNetwork& network) {
  const auto name = [&](Index node) {
    return node < 0 ? std::string("ambient") : network.nodes[static_cast<std::size_t>(node)].name;
  };
  Json document{{"format", "thermfit-machine/1"}};
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
      document["ambient"] = Json{{"first_sample_of", network.ambient.column}};
      break;
  }
  document["nodes"] = Json::array();
  for (const auto& node : network.nodes)
    document["nodes"].push_back(
        {{"name", node.name}, {"capacity_J_per_K", node.capacity_J_per_K}, {"ambient_W_per_K", node.ambient_W_per_K}});
  document["links"] = Json::array();
  for (const auto& link : network.links)
    document["links"].push_back(
        {{"between", Json::array({name(link.a), name(link.b)})}, {"conductance_W_per_K", link.conductance_W_per_K}});
  document["heat_sources"] = Json::array();
  for (const auto& source : network.heat_sources)
    document["heat_sources"].push_back({{"name", source.name},
                                        {"input", source.input},
                                        {"scale", source.scale},
                                        {"exponent", source.exponent},
                                        {"power_W", source.power_W},
                                        {"into", detail::by_node_json(network, source.into)}});
  Json outputs = Json::array();
  for (const auto& output : network.displacements)
    outputs.push_back({{"output", output.output},
                       {"zero", output.zero_at_first_sample ? "first_sample" : "reference"},
                       {"um_per_K", detail::by_node_json(network, output.um_per_K)}});
  if (outputs.size() == 1) document["displacement"] = outputs[0];
  if (outputs.size() > 1) document["displacement"] = outputs;
  if (!network.sensors.empty()) document["sensors"] = Json::object();
  for (const auto& sensor : network.sensors) {
    Json& entry = document["sensors"][sensor.column] = Json{{"node", name(sensor.node)}};
    if (sensor.offset_K != 0) entry["offset_K"] = sensor.offset_K;
    std::vector<std::pair<Index, double>> moved;
    for (const auto& share : sensor.placement)
      if (share.second != 0) moved.push_back(share);
    if (!moved.empty()) entry["placement"] = detail::by_node_json(network, moved);
    if (sensor.response_s != 0) entry["response_s"] = sensor.response_s;
  }
  using Start = ThermalNetwork::Initial::Rule;
  document["initial"] = network.initial.share != 0                ? Json(network.initial.share)
                        : network.initial.rule == Start::ambient  ? Json("ambient")
                        : network.initial.rule == Start::measured ? Json("measured")
                                                                  : detail::by_node_json(network, network.initial.degC);
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
  document["effects"] = Json::array();
  for (const auto& added : network.effects) {
    Json entry{{"effect", added.effect}, {"location", added.location}};
    if (!added.driver.empty()) entry["driver"] = added.driver;
    for (const auto& [key, value] : added.parameters) entry[key] = value;
    document["effects"].push_back(entry);
  }
  return document;
}

}  // namespace thermfit
