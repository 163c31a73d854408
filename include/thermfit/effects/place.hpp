#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "thermfit/error.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// Places as text: a node `head_front`, several `head_front+head_nose`, every node `all`; a link `a-b` in either order;
/// a heat source or a sensor by name; a displacement by its output, or `displacement` for all of them.

/// Nodes of a place. Throws Error naming the nodes there are.
inline std::vector<Index> nodes_at(const ThermalNetwork& network, const std::string& location) {
  std::vector<Index> result;
  if (location == "all") {
    for (Index i = 0; i < network.node_count(); ++i) result.push_back(i);
    return result;
  }
  for (std::size_t begin = 0; begin <= location.size();) {
    const std::size_t end = std::min(location.find('+', begin), location.size());
    const Index node = network.find_node(location.substr(begin, end - begin));
    if (node < 0) {
      std::string known;
      for (const auto& one : network.nodes) known += (known.empty() ? "" : ", ") + one.name;
      throw Error("location", "there is no node '" + location.substr(begin, end - begin) + "'",
                  known + ", several joined by '+', or all");
    }
    result.push_back(node);
    begin = end + 1;
  }
  return result;
}

/// The node of a place that is one. Throws Error where it is none or several.
inline Index node_at(const ThermalNetwork& network, const std::string& location) {
  const std::vector<Index> nodes = nodes_at(network, location);
  if (nodes.size() != 1) throw Error("location", "'" + location + "'", "one node");
  return nodes.front();
}

/// The two nodes of `a-b`, whether linked or not; names may contain hyphens. Throws Error where there are no such two.
inline std::pair<Index, Index> pair_at(const ThermalNetwork& network, const std::string& location) {
  for (std::size_t at = location.find('-'); at != std::string::npos; at = location.find('-', at + 1)) {
    const Index a = network.find_node(location.substr(0, at)), b = network.find_node(location.substr(at + 1));
    if (a >= 0 && b >= 0 && a != b) return {a, b};
  }
  throw Error("location", "'" + location + "' names no two nodes", "two node names joined by '-'");
}

/// `a-b` of the names of two nodes, in this order.
inline std::string pair_name(const ThermalNetwork& network, Index a, Index b) {
  return network.nodes[static_cast<std::size_t>(a)].name + "-" + network.nodes[static_cast<std::size_t>(b)].name;
}

/// The one name of two nodes as a place: as their link has them, else in the order of the nodes.
inline std::string pair_place(const ThermalNetwork& network, Index a, Index b) {
  const Index link = network.find_link(a, b);
  if (link < 0) return pair_name(network, std::min(a, b), std::max(a, b));
  return pair_name(network, network.links[static_cast<std::size_t>(link)].a,
                   network.links[static_cast<std::size_t>(link)].b);
}

/// The link of `a-b`, in either order. Throws Error where there are no such nodes or no link between them.
inline Index link_at(const ThermalNetwork& network, const std::string& location) {
  const auto [a, b] = pair_at(network, location);
  const Index link = network.find_link(a, b);
  if (link < 0) throw Error("location", "'" + location + "' are not linked", "a link of the network");
  return link;
}

/// Index in a list of parts by the member that names them. Throws Error naming what there is.
template <class Items, class Name>
Index part_at(const Items& items, Name name, const std::string& location, const std::string& kind) {
  std::string known;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].*name == location) return static_cast<Index>(i);
    known += (known.empty() ? "" : ", ") + items[i].*name;
  }
  throw Error("location", "there is no " + kind + " '" + location + "'", known);
}

/// The heat source of this name. Throws Error naming those there are.
inline Index source_at(const ThermalNetwork& network, const std::string& location) {
  return part_at(network.heat_sources, &ThermalNetwork::HeatSource::name, location, "heat source");
}

/// The sensor that is read from this column. Throws Error naming those there are.
inline Index sensor_at(const ThermalNetwork& network, const std::string& location) {
  return part_at(network.sensors, &ThermalNetwork::Sensor::column, location, "sensor");
}

/// The displacement of this output, or all of them at `displacement`. Throws Error naming those there are.
inline std::vector<Index> displacements_at(const ThermalNetwork& network, const std::string& location) {
  if (location == "displacement" && !network.displacements.empty()) {
    std::vector<Index> all;
    for (std::size_t i = 0; i < network.displacements.size(); ++i) all.push_back(static_cast<Index>(i));
    return all;
  }
  return {part_at(network.displacements, &ThermalNetwork::Displacement::output, location, "displacement")};
}

/// Places for an effect on one displacement: `displacement` where there is one, else each by its output.
inline std::vector<std::string> displacement_places(const ThermalNetwork& network) {
  if (network.displacements.size() == 1) return {"displacement"};
  std::vector<std::string> result;
  for (const auto& one : network.displacements) result.push_back(one.output);
  return result;
}

/// Every node by its name, in their order.
inline std::vector<std::string> node_places(const ThermalNetwork& network) {
  std::vector<std::string> result;
  for (const auto& node : network.nodes) result.push_back(node.name);
  return result;
}

/// Sensors on nodes; those in the air show what the simulator is told.
inline std::vector<std::string> sensor_places(const ThermalNetwork& network) {
  std::vector<std::string> result;
  for (const auto& sensor : network.sensors)
    if (sensor.node >= 0) result.push_back(sensor.column);
  return result;
}

/// Nodes as one place: `a+b`, or `all`.
inline std::string place_of(const ThermalNetwork& network, const std::vector<Index>& nodes) {
  if (static_cast<Index>(nodes.size()) == network.node_count() && nodes.size() > 1) return "all";
  std::string name;
  for (const Index i : nodes) name += (name.empty() ? "" : "+") + network.nodes[static_cast<std::size_t>(i)].name;
  return name;
}

/// Every single node, then the spread places: a node with its neighbours, with those of its family (the part of the
/// name before its last `_`), all linked nodes of a family, and all nodes. Each set of nodes once.
inline std::vector<std::string> spread_places(const ThermalNetwork& network) {
  std::vector<std::vector<Index>> groups;
  const auto add = [&](std::vector<Index> group) {
    std::sort(group.begin(), group.end());
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(std::move(group));
  };
  const Index count = network.node_count();
  for (Index i = 0; i < count; ++i) add({i});
  for (Index i = 0; i < count; ++i) {
    std::vector<Index> group{i};
    for (Index j = 0; j < count; ++j)
      if (network.find_link(i, j) >= 0) group.push_back(j);
    add(std::move(group));
  }
  for (Index i = 0; i < count; ++i) {
    const std::string& name = network.nodes[static_cast<std::size_t>(i)].name;
    const std::string family = name.substr(0, name.rfind('_') == std::string::npos ? 0 : name.rfind('_') + 1);
    if (family.empty()) continue;
    std::vector<Index> beside{i};
    for (Index j = 0; j < count; ++j)
      if (network.find_link(i, j) >= 0 && network.nodes[static_cast<std::size_t>(j)].name.rfind(family, 0) == 0)
        beside.push_back(j);
    add(std::move(beside));
    std::vector<Index> group{i};
    for (std::size_t known = 0; known < group.size(); ++known)
      for (Index j = 0; j < count; ++j)
        if (network.find_link(group[known], j) >= 0 &&
            network.nodes[static_cast<std::size_t>(j)].name.rfind(family, 0) == 0 &&
            std::find(group.begin(), group.end(), j) == group.end())
          group.push_back(j);
    add(std::move(group));
  }
  std::vector<std::string> result;
  for (const std::vector<Index>& group : groups)
    if (static_cast<Index>(group.size()) < count || count == 1) result.push_back(place_of(network, group));
  if (count > 1) result.push_back("all");
  return result;
}

/// Places one step from `place`: a link or a pair with one end moved to a neighbour; a single node moved to a
/// neighbour; a set of nodes with a neighbour added or one of its nodes taken out. None for sources, sensors and
/// outputs.
inline std::vector<std::string> places_beside(const ThermalNetwork& network, const std::string& place) {
  std::vector<std::string> result;
  const auto add = [&](const std::string& one) {
    if (one != place && std::find(result.begin(), result.end(), one) == result.end()) result.push_back(one);
  };
  const Index count = network.node_count();
  std::vector<Index> nodes;
  try {
    nodes = nodes_at(network, place);
  } catch (const Error&) {
    try {
      const auto [a, b] = pair_at(network, place);
      for (Index j = 0; j < count; ++j) {
        if (j == a || j == b) continue;
        if (network.find_link(a, j) >= 0) add(pair_place(network, j, b));
        if (network.find_link(b, j) >= 0) add(pair_place(network, a, j));
      }
    } catch (const Error&) {
    }
    return result;
  }
  const auto beside = [&](Index j) {
    return std::any_of(nodes.begin(), nodes.end(), [&](Index i) { return network.find_link(i, j) >= 0; });
  };
  for (Index j = 0; j < count; ++j) {
    const auto at = std::find(nodes.begin(), nodes.end(), j);
    std::vector<Index> other = nodes;
    if (at == nodes.end() && beside(j)) {
      if (nodes.size() == 1) add(place_of(network, {j}));
      other.push_back(j);
    } else if (at != nodes.end() && nodes.size() > 1) {
      other.erase(other.begin() + (at - nodes.begin()));
    } else {
      continue;
    }
    std::sort(other.begin(), other.end());
    add(place_of(network, other));
  }
  return result;
}

}  // namespace thermfit
