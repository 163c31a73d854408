#pragma once

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "thermfit/error.hpp"
#include "thermfit/network/thermal_network.hpp"
#include "thermfit/number.hpp"

namespace thermfit {

namespace detail {

/// Complaints with the key path of `thermfit-machine/1`.
class NetworkCheck {
 public:
  NetworkCheck(const ThermalNetwork& network, std::string source) : network_(network), source_(std::move(source)) {}

  void run() const {
    nodes();
    links();
    heat_sources();
    displacements();
    sensors();
    uncertainty();
    if (network_.displacements.empty() && network_.sensors.empty())
      fail("sensors", "neither sensors nor a displacement", "at least one", "without them nothing can be compared");
    paths_to_ambient();
  }

 private:
  [[noreturn]] void fail(const std::string& path, const std::string& found, const std::string& allowed = {},
                         const std::string& remedy = {}) const {
    throw Error(source_.empty() ? path : source_ + ": " + path, found, allowed, remedy);
  }
  static std::string at(const char* list, std::size_t i, const char* key = nullptr) {
    return std::string(list) + '[' + std::to_string(i) + ']' + (key ? std::string(".") + key : "");
  }
  void require(bool fits, const std::string& path, const char* found, const char* allowed) const {
    if (!fits) fail(path, found, allowed);
  }
  void number(double value, double lowest, bool lowest_itself, const std::string& path) const {
    if (std::isfinite(value) && (value > lowest || (lowest_itself && value == lowest))) return;
    fail(path,
         !std::isfinite(value) ? "not a finite number"
         : value < 0           ? "a negative number"
                               : "zero",
         std::string(lowest_itself ? "a number of at least " : "a number above ") + (lowest == 0 ? "0" : "the lowest"));
  }
  void unique(std::set<std::string>& seen, const std::string& name, const std::string& path) const {
    if (name.empty()) fail(path, "an empty name", "a name");
    if (!seen.insert(name).second) fail(path, "'" + name + "' is there twice", "each name once", "rename one");
  }
  void node_index(Index node, const std::string& path, bool ambient_too = false) const {
    const Index lowest = ambient_too ? ThermalNetwork::ambient_node : 0;
    if (node < lowest || node >= network_.node_count())
      fail(path, "node number " + std::to_string(node), "0 to " + std::to_string(network_.node_count() - 1));
  }
  const std::string& name(Index node) const { return network_.nodes[static_cast<std::size_t>(node)].name; }

  void nodes() const {
    if (network_.nodes.empty()) fail("nodes", "an empty list", "at least one node");
    std::set<std::string> seen;
    for (std::size_t i = 0; i < network_.nodes.size(); ++i) {
      const ThermalNetwork::Node& node = network_.nodes[i];
      unique(seen, node.name, at("nodes", i, "name"));
      if (node.name == "ambient" || node.name == "all")
        fail(at("nodes", i, "name"), "'" + node.name + "' is reserved", "any other name");
      if (node.name.find('+') != std::string::npos)
        fail(at("nodes", i, "name"), "'+' in '" + node.name + "'", "a name without '+', which joins places",
             "rename it");
      number(node.capacity_J_per_K, 0, false, at("nodes", i, "capacity_J_per_K"));
      number(node.ambient_W_per_K, 0, true, at("nodes", i, "ambient_W_per_K"));
    }
  }

  void links() const {
    for (std::size_t i = 0; i < network_.links.size(); ++i) {
      const ThermalNetwork::Link& link = network_.links[i];
      node_index(link.a, at("links", i, "between"));
      node_index(link.b, at("links", i, "between"));
      if (link.a == link.b) fail(at("links", i, "between"), "'" + name(link.a) + "' linked to itself", "two nodes");
      if (network_.find_link(link.a, link.b) != static_cast<Index>(i))
        fail(at("links", i, "between"), "'" + name(link.a) + "' and '" + name(link.b) + "' are linked twice",
             "one link between two nodes", "add the conductances");
      number(link.conductance_W_per_K, 0, true, at("links", i, "conductance_W_per_K"));
    }
  }

  void heat_sources() const {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < network_.heat_sources.size(); ++i) {
      const ThermalNetwork::HeatSource& source = network_.heat_sources[i];
      unique(seen, source.name, at("heat_sources", i, "name"));
      require(!source.input.empty(), at("heat_sources", i, "input"), "an empty name", "a column, or \"constant\"");
      number(source.scale, 0, false, at("heat_sources", i, "scale"));
      number(source.exponent, 0, false, at("heat_sources", i, "exponent"));
      require(std::isfinite(source.power_W), at("heat_sources", i, "power_W"), "not a finite number", "a number");
      double sum = 0;
      std::set<Index> nodes;
      for (const auto& [node, share] : source.into) {
        node_index(node, at("heat_sources", i, "into"));
        const std::string path = at("heat_sources", i, "into") + '.' + name(node);
        if (!nodes.insert(node).second) fail(path, "the node is there twice", "each node once");
        number(share, 0, true, path);
        sum += share;
      }
      if (!(std::abs(sum - 1) <= 1e-6))
        fail(at("heat_sources", i, "into"), "shares that add to " + general_text(sum, 6), "shares that add to 1");
    }
  }

  void displacements() const {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < network_.displacements.size(); ++i) {
      const ThermalNetwork::Displacement& output = network_.displacements[i];
      const std::string path = network_.displacements.size() == 1 ? "displacement" : at("displacement", i);
      unique(seen, output.output, path + ".output");
      std::set<Index> nodes;
      for (const auto& [node, um_per_K] : output.um_per_K) {
        node_index(node, path + ".um_per_K");
        const std::string entry = path + ".um_per_K." + name(node);
        if (!nodes.insert(node).second) fail(entry, "the node is there twice", "each node once");
        require(std::isfinite(um_per_K), entry, "not a finite number", "a number");
      }
    }
  }

  void sensors() const {
    std::set<std::string> seen;
    for (const ThermalNetwork::Sensor& sensor : network_.sensors) {
      unique(seen, sensor.column, "sensors." + sensor.column);
      node_index(sensor.node, "sensors." + sensor.column + ".node", true);
      require(std::isfinite(sensor.offset_K), "sensors." + sensor.column + ".offset_K", "not a number", "a number");
    }
    for (const auto& [node, degC] : network_.initial.degC) {
      node_index(node, "initial");
      require(std::isfinite(degC), "initial." + name(node), "not a finite number", "a temperature in degC");
    }
    if (network_.ambient.rule == ThermalNetwork::Ambient::Rule::constant)
      require(std::isfinite(network_.ambient.value_degC), "ambient", "not a finite number", "a temperature in degC");
    require(std::isfinite(network_.reference_degC), "reference_temperature_C", "not a finite number", "a number");
  }

  void uncertainty() const {
    const ThermalNetwork::Uncertainty& sd = network_.uncertainty;
    number(sd.capacity, 0, true, "uncertainty.capacity");
    number(sd.ambient, 0, true, "uncertainty.ambient");
    number(sd.conductance, 0, true, "uncertainty.conductance");
    number(sd.power, 0, true, "uncertainty.power");
    number(sd.um_per_K, 0, true, "uncertainty.um_per_K");
    number(sd.sensor_offset_K, 0, true, "uncertainty.sensor_offset_K");
  }

  void paths_to_ambient() const {
    std::vector<bool> reached(network_.nodes.size());
    for (std::size_t i = 0; i < reached.size(); ++i) reached[i] = network_.nodes[i].ambient_W_per_K > 0;
    for (bool changed = true; changed;) {
      changed = false;
      for (const ThermalNetwork::Link& link : network_.links) {
        const auto a = static_cast<std::size_t>(link.a), b = static_cast<std::size_t>(link.b);
        if (link.conductance_W_per_K <= 0 || reached[a] == reached[b]) continue;
        reached[a] = reached[b] = changed = true;
      }
    }
    std::string cut_off;
    for (std::size_t i = 0; i < reached.size(); ++i)
      if (!reached[i]) cut_off += (cut_off.empty() ? "" : ", ") + network_.nodes[i].name;
    if (!cut_off.empty())
      fail("links", "no way for heat to leave " + cut_off, "a path of links from every node to ambient",
           "add a link, or an ambient_W_per_K above 0");
  }

  const ThermalNetwork& network_;
  std::string source_;
};

}  // namespace detail

/// Throws Error unless the network can be simulated: names unique, indices in range, capacities positive, conductances
/// not negative, shares adding to 1, a path to ambient from every node. `source` names the document in the complaint.
inline void check_network(const ThermalNetwork& network, const std::string& source = {}) {
  detail::NetworkCheck(network, source).run();
}

}  // namespace thermfit
