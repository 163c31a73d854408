#pragma once

/// Effects outside the catalogue: nothing that is logged drives them, or no law of the catalogue has their form. The
/// right answer is `unknown`; `places` says where.

#include "known_effects.hpp"

namespace blind {

namespace laws {

/// On and off at random times, in every batch.
inline std::vector<Vector> unlogged_events(Scene& scene, double shortest_s, double longest_s, double on_share) {
  std::vector<Vector> courses;
  for (const Experiment& batch : scene.campaign.batches) {
    Vector course(batch.fine_rows());
    bool on = scene.random.chance(on_share);
    for (Index row = 0; row < course.size(); on = !on) {
      const double factor = 2 * (on ? on_share : 1 - on_share);
      const double length_s = scene.random.uniform(shortest_s, longest_s) * factor;
      const Index end = std::min(course.size(), row + 1 + static_cast<Index>(length_s / batch.step_s()));
      for (; row < end; ++row) course[row] = on;
    }
    courses.push_back(course);
  }
  return courses;
}

inline HeatFlow pulses(const std::vector<Vector>& courses, const std::vector<Index>& cells, double watts) {
  return [=](const Instant& now, Vector& flow) {
    for (const Index cell : cells)
      flow[cell] += watts / static_cast<double>(cells.size()) * courses[now.batch][now.row];
  };
}

/// A chiller of its own with hysteresis: the supply is a sawtooth that no column shows.
inline Effect chiller(Scene scene, double size) {
  const Index lump = warm_lump(scene);
  Effect effect = at_lump(scene, "x-chiller", lump);
  const double period_s = scene.random.uniform(20, 70) * 60, width_K = scene.random.uniform(3, 8);
  std::vector<Vector> supply;
  for (const Experiment& batch : scene.campaign.batches) {
    Vector course(batch.fine_rows());
    double phase = scene.random.uniform();
    for (Index row = 0; row < course.size(); ++row) {
      phase += batch.step_s() / period_s * (1 + .15 * scene.random.normal());
      const double in = phase - std::floor(phase);
      course[row] = 22 + width_K * (in < .7 ? in / .7 - .5 : .5 - (in - .7) / .3);
    }
    supply.push_back(course);
  }
  const std::vector<Index> cells = scene.machine.cells(lump);
  effect.heat = [=](const Instant& now, Vector& flow) {
    for (const Index cell : cells)
      flow[cell] += 10 * size / static_cast<double>(cells.size()) * (supply[now.batch][now.row] - now.theta[cell]);
  };
  return effect;
}

/// Tool changes: short bursts of heat at the front.
inline Effect tool_change(Scene scene, double size) {
  const Index lump = warm_group(scene.machine).front();
  Effect effect = at_lump(scene, "x-tool-change", lump);
  effect.heat = pulses(unlogged_events(scene, 600, 4800, .2), scene.machine.cells(lump), 150 * size);
  return effect;
}

/// A pump that nobody logs.
inline Effect hydraulics(Scene scene, double size) {
  const Index lump = visible_lump(scene);
  Effect effect = at_lump(scene, "x-hydraulics", lump);
  effect.heat = pulses(unlogged_events(scene, 1500, 6000, .45), scene.machine.cells(lump), 80 * size);
  return effect;
}

/// Doors open: colder air and more of it over a whole group.
inline Effect door(Scene scene, double size) {
  Effect effect;
  effect.name = "x-door";
  const auto lumps = warm_group(scene.machine);
  effect.places = names(scene.machine, lumps);
  const auto open = unlogged_events(scene, 1200, 5400, .35);
  const auto area = surfaces(scene.machine, lumps);
  const double colder_K = scene.random.uniform(2, 6);
  effect.heat = [=](const Instant& now, Vector& flow) {
    const double on = open[now.batch][now.row];
    for (const auto& [cell, W_per_K] : area)
      flow[cell] += on * W_per_K * size * (1.5 * (now.air_degC - now.theta[cell]) - colder_K);
  };
  return effect;
}

/// At the first heat source, the spindle's front bearings; the lumps that it heats count as right too.
inline Effect at_front_bearings(const Scene& scene, const std::string& name) {
  Effect effect;
  effect.name = name;
  effect.places = {scene.machine.plant.sources[0].name};
  for (const auto& [lump, share] : scene.machine.lumped.sources[0].into)
    effect.places.push_back(scene.machine.name(lump));
  return effect;
}

/// Friction that falls as the oil warms: Walther's viscosity of an ISO VG 32 oil to the power 2/3.
inline Effect viscosity(Scene scene, double size) {
  Effect effect = at_front_bearings(scene, "x-viscosity");
  const Source source = scene.machine.plant.sources[0];
  effect.driver = "temperature";
  const Index column = scene.input(source.input);
  const auto oil = [](double degC) {
    return std::pow(10., std::pow(10., 9.1 - 3.56 * std::log10(degC + 273.15))) - .7;
  };
  effect.heat = [=](const Instant& now, Vector& flow) {
    const double watts = source_W(source, now.experiment.held(column, now.row));
    for (const auto& [cell, share] : source.into) {
      const double thinner = std::pow(oil(std::clamp(now.theta[cell], -10., 120.)) / oil(30), 2. / 3);
      flow[cell] += share * watts * (std::pow(thinner, std::min(size, 1.5)) - 1);
    }
  };
  return effect;
}

/// Cutting: the load of the spindle is not logged, its heat goes up and down.
inline Effect cutting(Scene scene, double size) {
  Effect effect = at_front_bearings(scene, "x-cutting");
  const Source source = scene.machine.plant.sources[0];
  const auto load = unlogged_events(scene, 1200, 4800, .5);
  const Index column = scene.input(source.input);
  effect.heat = [=](const Instant& now, Vector& flow) {
    const double watts = source_W(source, now.experiment.held(column, now.row));
    for (const auto& [cell, share] : source.into)
      flow[cell] += share * watts * .5 * size * (load[now.batch][now.row] - .5);
  };
  return effect;
}

/// Something gives way now and then: the displacement jumps.
inline Effect settling(Scene scene, double size) {
  Effect effect;
  effect.name = "x-settling";
  effect.places = {"displacement", scene.machine.output};
  std::vector<Vector> jumps;
  for (const Experiment& batch : scene.campaign.batches) {
    Vector course = Vector::Zero(batch.fine_rows());
    for (int j = scene.random.integer(1, 4); j > 0; --j) {
      const Index at = scene.random.integer(1, static_cast<int>(course.size()) - 1);
      course.tail(course.size() - at).array() += 4 * size * scene.random.normal();
    }
    jumps.push_back(course);
  }
  effect.displacement = [=](std::size_t batch, const Experiment&, const Matrix&, Vector& course) {
    course += jumps[batch];
  };
  return effect;
}

/// A thermometer whose cable comes loose at times and then reads partly the air.
inline Effect loose_cable(Scene scene, double size) {
  Effect effect = on_sensor(scene, "x-loose-cable");
  const auto loose = unlogged_events(scene, 900, 4800, .35);
  effect.reading = [=](std::size_t batch, const Experiment& experiment, const Matrix&, Vector& course) {
    for (Index row = 0; row < course.size(); ++row)
      course[row] -= loose[batch][row] * std::min(.9, .3 * size) * (course[row] - experiment.air_degC[row] + 1);
  };
  return effect;
}

}  // namespace laws

inline const std::map<std::string, std::pair<Law, double>>& unknown_effects() {
  static const std::map<std::string, std::pair<Law, double>> all{
      {"x-chiller", {laws::chiller, 6}},       {"x-tool-change", {laws::tool_change, 6}},
      {"x-hydraulics", {laws::hydraulics, 6}}, {"x-door", {laws::door, 5}},
      {"x-viscosity", {laws::viscosity, 1.5}}, {"x-cutting", {laws::cutting, 2}},
      {"x-settling", {laws::settling, 6}},     {"x-loose-cable", {laws::loose_cable, 3}}};
  return all;
}

}  // namespace blind
