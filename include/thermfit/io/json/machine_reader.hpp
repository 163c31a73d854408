#pragma once

/// What stands in `thermfit-machine/1`, key by key. Meant for machine.hpp.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/constants.hpp"
#include "thermfit/io/json/node.hpp"
#include "thermfit/io/units.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit::detail {

template <typename J>
class MachineReader {
 public:
  using Node = BasicJsonNode<J>;

  explicit MachineReader(const Node& root) : root_(root) {}

  ThermalNetwork read() {
    root_.require_format("thermfit-machine", 1);
    root_.require_keys({"format", "name", "reference_temperature_C", "ambient", "nodes", "links", "heat_sources",
                        "displacement", "sensors", "channels", "initial", "uncertainty", "effects"});
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
    if (const auto channels = root_.find("channels")) read_channels(*channels);
    if (const auto initial = root_.find("initial")) read_initial(*initial);
    if (const auto uncertainty = root_.find("uncertainty")) read_uncertainty(*uncertainty);
    if (const auto effects = root_.find("effects"))
      for (std::size_t i = 0; i < effects->size(); ++i) read_effect(effects->item(i));
    return network_;
  }

 private:
  void read_ambient(const Node& node) {
    using Rule = ThermalNetwork::Ambient::Rule;
    ThermalNetwork::Ambient& ambient = network_.ambient;
    if (node.json().is_number()) {
      ambient = {Rule::constant, "", node.number(absolute_zero_degC, 2000)};
    } else if (node.json().is_string()) {
      ambient = {node.text() == "initial" ? Rule::initial : Rule::column, node.text(), 0};
      if (ambient.rule == Rule::initial) ambient.column.clear();
    } else if (node.json().is_object()) {
      node.require_keys({"first_sample_of", "unmeasured"});
      if (const auto unmeasured = node.find("unmeasured")) {
        if (unmeasured->json() != J(true)) unmeasured->fail(unmeasured->json().dump(), "true");
        if (node.find("first_sample_of")) node.fail("two rules for one room", "one of first_sample_of and unmeasured");
        ambient = {Rule::unmeasured, "", 0};
      } else {
        ambient = {Rule::first_sample_of, node.at("first_sample_of").text(), 0};
      }
    } else {
      node.fail(
          "neither a text, a number nor an object",
          "a column name, a number in degC, \"initial\", {\"first_sample_of\": column} or {\"unmeasured\": true}");
    }
  }

  void read_nodes(const Node& list) {
    for (std::size_t i = 0; i < list.size(1000); ++i) {
      const Node node = list.item(i);
      node.require_keys({"name", "capacity_J_per_K", "ambient_W_per_K"});
      ThermalNetwork::Node& added = network_.nodes.emplace_back();
      added.name = node.at("name").text();
      added.capacity_J_per_K = node.at("capacity_J_per_K").number();
      if (const auto ambient = node.find("ambient_W_per_K")) added.ambient_W_per_K = ambient->number();
      names_.push_back(added.name);
    }
  }

  Index node_named(const Node& node, const std::string& name) const {
    const Index index = network_.find_node(name);
    if (index < 0)
      node.fail("there is no node '" + name + "'", name_list(names_),
                "add it or correct the name" + did_you_mean(name, names_));
    return index;
  }

  void read_links(const Node& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Node link = list.item(i);
      link.require_keys({"between", "conductance_W_per_K"});
      const Node between = link.at("between");
      if (between.size() != 2) between.fail(std::to_string(between.size()) + " names", "two nodes");
      network_.links.push_back({node_named(between.item(0), between.item(0).text()),
                                node_named(between.item(1), between.item(1).text()),
                                link.at("conductance_W_per_K").number()});
    }
  }

  /// An object of node: number.
  std::vector<std::pair<Index, double>> by_node(const Node& object) const {
    if (!object.json().is_object()) object.fail("not an object", "{node: number}");
    std::vector<std::pair<Index, double>> result;
    for (const auto& [name, value] : object.json().items())
      result.emplace_back(node_named(object, name), object.at(name).number());
    return result;
  }

  void read_heat_sources(const Node& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Node source = list.item(i);
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

  void read_displacement(const Node& node) {
    node.require_keys({"output", "zero", "datum", "um_per_K"});
    ThermalNetwork::Displacement& added = network_.displacements.emplace_back();
    added.output = node.at("output").text();
    if (const auto zero = node.find("zero"))
      added.zero_at_first_sample = zero->choice({"first_sample", "reference"}) == "first_sample";
    if (const auto datum = node.find("datum")) added.absolute = datum->choice({"per_batch", "absolute"}) == "absolute";
    added.um_per_K = by_node(node.at("um_per_K"));
  }

  void read_sensors(const Node& object) {
    if (!object.json().is_object()) object.fail("not an object", "{column: {\"node\": name}}");
    for (const auto& [column, value] : object.json().items()) {
      const Node sensor = object.at(column);
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

  void read_channels(const Node& object) {
    if (!object.json().is_object()) object.fail("not an object", "{column: {\"unit\": name, \"sign\": \"error\"}}");
    std::vector<std::string> temperatures, errors;
    for (const auto& sensor : network_.sensors) temperatures.push_back(sensor.column);
    if (!network_.ambient.column.empty()) temperatures.push_back(network_.ambient.column);
    for (const auto& output : network_.displacements) errors.push_back(output.output);
    const auto in = [](const std::vector<std::string>& list, const std::string& name) {
      return std::find(list.begin(), list.end(), name) != list.end();
    };
    for (const auto& [column, value] : object.json().items()) {
      const Node channel = object.at(column);
      const bool error = in(errors, column);
      if (!error && !in(temperatures, column)) {
        std::vector<std::string> known = temperatures;
        known.insert(known.end(), errors.begin(), errors.end());
        object.fail("no thermometer and no displacement is called '" + column + "'", name_list(known),
                    "correct the name" + did_you_mean(column, known));
      }
      if (error)
        channel.require_keys({"unit", "sign"});
      else
        channel.require_keys({"unit"});
      ThermalNetwork::Channel& added = network_.channels.emplace_back();
      added.column = column;
      if (const auto unit = channel.find("unit")) {
        added.unit = unit->text();
        const Quantity quantity = error ? Quantity::length : Quantity::temperature;
        const auto found = find_unit(added.unit);
        if (!found || found->quantity != quantity || found->numerator < 0)
          unit->fail("'" + added.unit + "' is no unit of it",
                     std::string(unit_names(quantity)) + ", also with a factor",
                     "such as " + std::string(error ? "mm or 0.1 um" : "K or 0.1 degC"));
      }
      if (const auto sign = channel.find("sign"))
        added.correction = sign->choice({"error", "correction"}) == "correction";
    }
  }

  void read_initial(const Node& node) {
    using Rule = ThermalNetwork::Initial::Rule;
    if (node.json().is_string()) {
      const std::string rule = node.choice({"ambient", "measured", "fitted"});
      network_.initial.rule = rule == "ambient" ? Rule::ambient : rule == "measured" ? Rule::measured : Rule::fitted;
    } else if (node.json().is_number())
      network_.initial = {Rule::ambient, {}, node.number(0, 1)};
    else
      network_.initial = {Rule::given, by_node(node), 0};
  }

  void read_uncertainty(const Node& node) {
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

  void read_effect(const Node& node) {
    if (!node.json().is_object()) node.fail("not an object", "{\"effect\", \"location\", parameters…}");
    ThermalNetwork::AddedEffect& added = network_.effects.emplace_back();
    added.effect = node.at("effect").text();
    added.location = node.at("location").text();
    if (const auto driver = node.find("driver")) added.driver = driver->text();
    for (const auto& [key, value] : node.json().items())
      if (key != "effect" && key != "location" && key != "driver")
        added.parameters.emplace_back(key, node.at(key).number());
  }

  Node root_;
  ThermalNetwork network_;
  std::vector<std::string> names_;
};

}  // namespace thermfit::detail
