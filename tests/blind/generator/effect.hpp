#pragma once

/// What the plant does that the nominal machine does not know of: a set of hooks.

#include "schedule.hpp"

namespace blind {

/// Everything a law may look at when it is made.
struct Scene {
  const Machine& machine;
  const Campaign& campaign;
  Random random;  ///< a copy: the same choices whatever the size

  double batch_s() const {
    const Experiment& first = campaign.batches.front();
    return first.interval_s * static_cast<double>(first.samples() - 1);
  }
  bool has_input(const std::string& name) const { return campaign.batches.front().column(name) >= 0; }
  Index input(const std::string& name) const { return campaign.batches.front().column(name); }
};

using Course = std::function<void(std::size_t batch, const Experiment&, const Matrix& cell_degC, Vector& course)>;

struct Effect {
  std::string name;
  std::vector<std::string> places;  ///< all that count as right
  std::string driver;
  std::vector<std::string> also;        ///< other names that count as right
  std::function<void(Plant&)> rebuild;  ///< adds cells, links, expansion
  HeatFlow heat;                        ///< adds heat flows
  std::function<void(std::size_t batch, Vector& start_degC)> start;
  Course displacement;                    ///< changes the displacement, um at every step
  std::string sensor;                     ///< the thermometer that `reading` changes
  Course reading;                         ///< changes what it shows, degC at every step
  std::function<void(Machine&)> nominal;  ///< what the nominal machine leaves out, before lumping
  bool forgets_ambient = false;           ///< the nominal machine takes the first air temperature for all
};

inline std::vector<std::string> names(const Machine& machine, const std::vector<Index>& lumps) {
  std::vector<std::string> result;
  for (const Index lump : lumps) result.push_back(machine.name(lump));
  return result;
}

/// Places `a-b` in both directions, either end moved to a neighbour in its own group.
inline std::vector<std::string> link_places(const Machine& machine, Index a, Index b, bool existing) {
  std::vector<std::string> result;
  const auto ends_a = machine.around(a), ends_b = machine.around(b);
  const auto add = [&](Index x, Index y) {
    if (x == y || machine.linked(x, y) != existing) return;
    result.push_back(machine.name(x) + "-" + machine.name(y));
    result.push_back(machine.name(y) + "-" + machine.name(x));
  };
  add(a, b);
  for (const Index x : ends_a)
    if (x != a) add(x, b);
  for (const Index y : ends_b)
    if (y != b) add(a, y);
  return result;
}

/// First-order lag of a course at equal steps, at rest at the first value.
inline Vector lagged(const Vector& course, double step_s, double lag_s) {
  Vector result = course;
  const double keep = std::exp(-step_s / lag_s);
  for (Index row = 1; row < course.size(); ++row)
    result[row] = keep * result[row - 1] + (1 - keep) * .5 * (course[row] + course[row - 1]);
  return result;
}

}  // namespace blind
