#pragma once

/// A random machine: cells, the lumps a modeller would draw around them, and its thermometers.

#include <algorithm>
#include <map>

#include "kinds.hpp"
#include "plant.hpp"
#include "random.hpp"

namespace blind {

struct Lump {
  std::string name, group;
  std::vector<Index> cells;
};

struct Sensor {
  std::string name;
  Index lump, cell;  ///< -1: the air
};

struct Machine {
  std::string kind, output;
  Plant plant;   ///< the cells
  Plant lumped;  ///< the nominal network, one cell a lump: first guess, then what fit_lumps makes of it
  std::vector<Lump> lumps;
  std::vector<Sensor> sensors;
  double top_speed_rpm;
  bool feeds;

  Index lump(const std::string& name) const {
    for (std::size_t i = 0; i < lumps.size(); ++i)
      if (lumps[i].name == name) return static_cast<Index>(i);
    return -1;
  }
  const std::string& name(Index lump_index) const { return lumps[static_cast<std::size_t>(lump_index)].name; }
  const std::string& group(Index lump_index) const { return lumps[static_cast<std::size_t>(lump_index)].group; }
  const std::vector<Index>& cells(Index lump_index) const { return lumps[static_cast<std::size_t>(lump_index)].cells; }

  std::vector<Index> linked(Index to) const {
    std::vector<Index> found;
    for (const Link& link : lumped.links) {
      if (link.a == to) found.push_back(link.b);
      if (link.b == to) found.push_back(link.a);
    }
    return found;
  }
  bool linked(Index a, Index b) const {
    const auto near = linked(a);
    return std::find(near.begin(), near.end(), b) != near.end();
  }
  /// The lump and those of the same group linked to it: what counts as the right place for an effect in it.
  std::vector<Index> around(Index at) const {
    std::vector<Index> found{at};
    for (const Index near : linked(at))
      if (group(near) == group(at)) found.push_back(near);
    return found;
  }
  bool has_sensor(Index lump_index) const {
    return std::any_of(sensors.begin(), sensors.end(), [&](const Sensor& s) { return s.lump == lump_index; });
  }
  std::string ambient_sensor() const {
    for (const Sensor& sensor : sensors)
      if (sensor.lump < 0) return sensor.name;
    return {};
  }
};

/// Splits `whole` into `parts` uneven shares that add up to it.
inline std::vector<double> uneven_shares(Random& random, std::size_t parts, double whole) {
  std::vector<double> shares(parts);
  double sum = 0;
  for (double& share : shares) sum += share = random.uniform(.6, 1.4);
  for (double& share : shares) share *= whole / sum;
  return shares;
}

inline Machine random_machine(Random& random) {
  const auto all = kinds();
  const Kind& kind = random.pick(all);
  Machine machine;
  machine.kind = kind.name;
  machine.output = random.chance(.85) ? "Z" : "Y";
  machine.top_speed_rpm = kind.top_speed_rpm * random.pick(std::vector<double>{.75, 1, 1, 1.5});
  machine.feeds = kind.feeds;

  // Lumps, with the typical values spread; small parts stay small beside large ones.
  const double size = std::exp(.25 * random.normal());
  const auto spread = [&](double typical) { return typical * std::exp(.2 * random.normal()); };
  std::vector<double> capacity, ambient, expansion;
  for (const Part& part : kind.parts) {
    if (!random.chance(part.present)) continue;
    machine.lumps.push_back({part.name, part.group, {}});
    capacity.push_back(spread(part.capacity_J_per_K) * size);
    ambient.push_back(spread(part.ambient_W_per_K) * size);
    expansion.push_back(part.um_per_K * std::exp(.25 * random.normal()));
  }
  Plant& lumped = machine.lumped;
  const Index n = static_cast<Index>(machine.lumps.size());
  lumped.capacity_J_per_K = Eigen::Map<Vector>(capacity.data(), n);
  lumped.ambient_W_per_K = Eigen::Map<Vector>(ambient.data(), n);
  lumped.um_per_K = Eigen::Map<Vector>(expansion.data(), n);
  for (const Joint& joint : kind.joints) {
    const Index a = machine.lump(joint.a), b = machine.lump(joint.b);
    if (a >= 0 && b >= 0) lumped.links.push_back({a, b, spread(joint.W_per_K) * size});
  }
  for (const Heat& heat : kind.heats) {
    const double scale = heat.input == "feed_mm_min" ? 1500 : machine.top_speed_rpm * 2 / 3;
    Source source{heat.name, heat.input, scale, heat.exponent + .1 * random.integer(-1, 1), spread(heat.power_W), {}};
    for (const auto& [part, share] : heat.into) source.into.push_back({machine.lump(part), share});
    lumped.sources.push_back(source);
  }

  // Cells: a chain in every lump, stiff against the heat that passes it.
  const double stiffness = random.log_uniform(1.3, 10);
  Vector through = lumped.ambient_W_per_K;
  for (const Link& link : lumped.links) through[link.a] += link.W_per_K, through[link.b] += link.W_per_K;
  Plant& plant = machine.plant;
  const int fewest = static_cast<int>((45 + n - 1) / n), most = static_cast<int>(80 / n);
  for (Index i = 0; i < n; ++i) {
    auto& cells = machine.lumps[static_cast<std::size_t>(i)].cells;
    const int drawn = random.integer(fewest, most), fine = static_cast<int>(lumped.capacity_J_per_K[i] / 400);
    const auto count = static_cast<std::size_t>(std::clamp(drawn, 2, std::max(2, fine)));
    const auto capacities = uneven_shares(random, count, lumped.capacity_J_per_K[i]);
    const auto surfaces = uneven_shares(random, count, lumped.ambient_W_per_K[i]);
    const auto weights = uneven_shares(random, count, lumped.um_per_K[i]);
    for (std::size_t c = 0; c < count; ++c) {
      const Index cell = plant.add_cell(capacities[c], surfaces[c]);
      plant.um_per_K[cell] = weights[c];
      if (c) plant.links.push_back({cell - 1, cell, stiffness * through[i] * random.uniform(.7, 1.4)});
      cells.push_back(cell);
    }
  }
  for (const Link& link : lumped.links)
    plant.links.push_back({random.pick(machine.cells(link.a)), random.pick(machine.cells(link.b)), link.W_per_K});
  for (const Source& source : lumped.sources) {
    Source fine = source;
    fine.into.clear();
    for (const auto& [lump, share] : source.into) {
      const double part = random.uniform(.3, .7);
      fine.into.push_back({random.pick(machine.cells(lump)), share * part});
      fine.into.push_back({random.pick(machine.cells(lump)), share * (1 - part)});
    }
    plant.sources.push_back(fine);
  }

  // Thermometers: on stationary parts mostly, a few parts twice, one in the air; numbered in no order.
  for (Index i = 0; i < n; ++i) {
    const bool turns = machine.group(i) == "shaft" || machine.group(i) == "spindle" || machine.name(i) == "rotor";
    if (random.chance(turns ? .1 : .8)) machine.sensors.push_back({"", i, random.pick(machine.cells(i))});
    if (!turns && random.chance(.3)) machine.sensors.push_back({"", i, random.pick(machine.cells(i))});
  }
  machine.sensors.push_back({"", -1, -1});
  random.shuffle(machine.sensors);
  for (std::size_t i = 0; i < machine.sensors.size(); ++i) machine.sensors[i].name = "T" + std::to_string(i + 1);
  return machine;
}

}  // namespace blind
