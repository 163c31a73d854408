#pragma once

/// The catalogue's effects as the plant shows them: where physics allows, by other formulas than a one-parameter law.

#include <map>
#include <stdexcept>

#include "effect.hpp"

namespace blind {

/// `size` 1 is an ordinary magnitude; every law grows with it.
using Law = Effect (*)(Scene scene, double size);

namespace laws {

constexpr double pi = 3.141592653589793;

inline bool turns(const Machine& machine, Index lump) {
  return machine.group(lump) == "shaft" || machine.group(lump) == "spindle" || machine.name(lump) == "rotor";
}

/// A lump that is neither huge nor turning and, if asked, carries a thermometer.
inline Index pick_lump(Scene& scene, bool sensed, double largest_J_per_K = 2e5) {
  std::vector<Index> fit;
  for (Index i = 0; i < static_cast<Index>(scene.machine.lumps.size()); ++i)
    if (!turns(scene.machine, i) && scene.machine.lumped.capacity_J_per_K[i] < largest_J_per_K &&
        (!sensed || scene.machine.has_sensor(i)))
      fit.push_back(i);
  return scene.random.pick(fit);
}

/// A lump with expansion or a thermometer: an effect elsewhere leaves no trace.
inline Index visible_lump(Scene& scene, double largest_J_per_K = 2e5) {
  for (int trial = 0; trial < 50; ++trial) {
    const Index lump = pick_lump(scene, false, largest_J_per_K);
    if (scene.machine.has_sensor(lump) || std::abs(scene.machine.lumped.um_per_K[lump]) > .3) return lump;
  }
  return pick_lump(scene, true, 1e12);
}

/// The group of stationary parts that gets warmest: head, headstock or housing.
inline std::vector<Index> warm_group(const Machine& machine) {
  std::vector<Index> group;
  for (Index i = 0; i < static_cast<Index>(machine.lumps.size()); ++i)
    if (machine.group(i) == "head" || machine.group(i) == "headstock" || machine.group(i) == "housing")
      group.push_back(i);
  return group;
}

inline Index warm_lump(Scene& scene) { return scene.random.pick(warm_group(scene.machine)); }

/// At one lump; those around it count as right too.
inline Effect at_lump(const Scene& scene, const std::string& name, Index lump) {
  Effect effect;
  effect.name = name;
  effect.places = names(scene.machine, scene.machine.around(lump));
  return effect;
}

inline std::vector<std::pair<Index, double>> surfaces(const Machine& machine, const std::vector<Index>& lumps) {
  std::vector<std::pair<Index, double>> found;
  for (const Index lump : lumps)
    for (const Index cell : machine.cells(lump)) found.push_back({cell, machine.plant.ambient_W_per_K[cell]});
  return found;
}

/// Missing heat, from an input or from switching on, that arrives through a slow path of some minutes.
inline Effect heat_source(Scene scene, double size) {
  Effect effect;
  effect.name = "heat-source";
  std::vector<std::string> drivers{"constant"};
  for (const char* input : {"pump", "feed_mm_min", "coolant", "spindle_rpm"})
    if (scene.has_input(input)) drivers.push_back(input);
  effect.driver = scene.has_input("pump") ? "pump" : scene.random.pick(drivers);
  const Index lump = visible_lump(scene);
  effect.places = names(scene.machine, scene.machine.around(lump));
  const double delay_s = scene.random.uniform(30, 240);
  const Index column = scene.input(effect.driver);
  double scale = 1;
  if (column >= 0)
    for (const Experiment& batch : scene.campaign.batches) scale = std::max(scale, batch.input.col(column).maxCoeff());
  std::vector<Vector> watts;
  for (const Experiment& batch : scene.campaign.batches) {
    Vector course(batch.fine_rows());
    for (Index row = 0; row < course.size(); ++row)
      course[row] = column < 0 ? 1 : std::pow(batch.held(column, row) / scale, 1.05);
    Vector from_rest = course;
    from_rest[0] = 0;
    watts.push_back(60 * size * lagged(from_rest, batch.step_s(), delay_s));
  }
  const std::vector<Index> cells = scene.machine.cells(lump);
  effect.heat = [=](const Instant& now, Vector& flow) {
    for (const Index cell : cells) flow[cell] += watts[now.batch][now.row] / static_cast<double>(cells.size());
  };
  return effect;
}

/// Palmgren's viscous moment with its regime below nu n = 2000, or churning: a nominal source that grows faster.
inline Effect friction_law(Scene scene, double size) {
  Effect effect;
  effect.name = "friction-law";
  const std::size_t which = static_cast<std::size_t>(scene.random.integer(0, 1));
  const Source source = scene.machine.plant.sources[which];
  effect.places = {source.name};
  effect.driver = "spindle_rpm";
  const Index column = scene.input("spindle_rpm");
  const bool churns = scene.random.chance(.4);
  const double viscosity = scene.random.uniform(15, 60);
  effect.heat = [=](const Instant& now, Vector& flow) {
    const double speed = now.experiment.held(column, now.row), x = speed / source.scale;
    if (x <= 0) return;
    const double moment = std::pow(std::max(viscosity * speed, 2000.) / (viscosity * source.scale), 2. / 3);
    const double shape = churns ? x * x * x / (1 + .25 * x) : moment * x * (.6 + .4 * x);
    for (const auto& [cell, share] : source.into) flow[cell] += .5 * size * source.power_W * shape * share;
  };
  return effect;
}

/// A jacket with finite flow: effectiveness 1 - exp(-NTU), coolant that warms a little while it runs.
inline Effect coolant(Scene scene, double size) {
  const Index lump = warm_lump(scene);
  Effect effect = at_lump(scene, "coolant", lump);
  effect.driver = "coolant";
  const Index column = scene.input("coolant");
  const bool chilled = scene.random.chance(.7);
  const double supply_degC = chilled ? scene.random.uniform(16, 24) : 0, below_air_K = scene.random.uniform(0, 3);
  const double stream_W_per_K = scene.random.uniform(60, 200), warms_K = scene.random.uniform(0, .6);
  const double taken = stream_W_per_K * (1 - std::exp(-10 * size / stream_W_per_K));
  std::vector<Vector> running;
  for (const Experiment& batch : scene.campaign.batches) {
    Vector on(batch.fine_rows());
    for (Index row = 0; row < on.size(); ++row) on[row] = batch.held(column, row);
    running.push_back(lagged(on, batch.step_s(), 25));
  }
  const std::vector<Index> cells = scene.machine.cells(lump);
  effect.heat = [=](const Instant& now, Vector& flow) {
    const double on = running[now.batch][now.row];
    const double supply = (chilled ? supply_degC : now.air_degC - below_air_K) + warms_K * on;
    for (const Index cell : cells)
      flow[cell] += on * taken / static_cast<double>(cells.size()) * (supply - now.theta[cell]);
  };
  return effect;
}

inline Effect ambient_drift(Scene, double) {
  Effect effect;
  effect.name = "ambient-drift";
  effect.places = {"ambient"};
  effect.forgets_ambient = true;
  return effect;
}

/// Rotating cylinder, Nu = 0.133 Re^(2/3) Pr^(1/3), blended with free convection as (a^3 + b^3)^(1/3).
inline Effect forced_convection(Scene scene, double size) {
  Effect effect;
  effect.name = "forced-convection";
  effect.driver = "spindle_rpm";
  const auto lumps = warm_group(scene.machine);
  effect.places = names(scene.machine, lumps);
  const auto area = surfaces(scene.machine, lumps);
  const Index column = scene.input("spindle_rpm");
  const double diameter_m = scene.random.uniform(.08, .2), still = scene.random.uniform(7, 10);
  effect.heat = [=](const Instant& now, Vector& flow) {
    const double speed = now.experiment.held(column, now.row);
    const double reynolds = pi * speed / 60 * diameter_m * diameter_m / 1.6e-5;
    const double driven = size * .2 * .133 * std::pow(reynolds, 2. / 3) * std::cbrt(.71) * .026 / diameter_m;
    const double more = std::cbrt(1 + std::pow(driven / still, 3)) - 1;
    for (const auto& [cell, W_per_K] : area) flow[cell] += W_per_K * more * (now.air_degC - now.theta[cell]);
  };
  return effect;
}

/// Vertical plate in free air, laminar 1.42 (dT/L)^(1/4) below Gr Pr = 1e9 and turbulent 1.31 dT^(1/3) above.
inline Effect natural_convection(Scene scene, double size) {
  Effect effect;
  effect.name = "natural-convection";
  effect.also = {"radiation"};
  auto lumps = warm_group(scene.machine);
  const Index motor = scene.machine.lump("motor");
  if (motor >= 0 && scene.random.chance(.5)) lumps.push_back(motor);
  effect.places = names(scene.machine, lumps);
  const auto area = surfaces(scene.machine, lumps);
  const double length_m = scene.random.uniform(.2, .8);
  effect.heat = [=](const Instant& now, Vector& flow) {
    for (const auto& [cell, W_per_K] : area) {
      const double rise = now.theta[cell] - now.air_degC, size_K = std::abs(rise);
      const double rayleigh = 9.81 / 300 * size_K * std::pow(length_m, 3) / (1.6e-5 * 2.2e-5);
      const double film = rayleigh < 1e9 ? 1.42 * std::pow(size_K / length_m, .25) : 1.31 * std::cbrt(size_K);
      flow[cell] -= size * W_per_K / 8 * film * rise;
    }
  };
  return effect;
}

/// Stefan and Boltzmann, towards walls that follow the air within an hour and a half.
inline Effect radiation(Scene scene, double size) {
  Effect effect;
  effect.name = "radiation";
  effect.also = {"natural-convection"};
  const auto lumps = warm_group(scene.machine);
  effect.places = names(scene.machine, lumps);
  const auto area = surfaces(scene.machine, lumps);
  std::vector<Vector> walls;
  for (const Experiment& batch : scene.campaign.batches) walls.push_back(lagged(batch.air_degC, batch.step_s(), 5400));
  effect.heat = [=](const Instant& now, Vector& flow) {
    const double wall = std::pow(walls[now.batch][now.row] + 273.15, 4);
    for (const auto& [cell, W_per_K] : area)
      flow[cell] -= size * W_per_K / 8 * .9 * 5.67e-8 * (std::pow(now.theta[cell] + 273.15, 4) - wall);
  };
  return effect;
}

/// Contact conductance ~ pressure^0.95 with pressure from the joint's temperature, or an oil film that grows with
/// speed.
inline Effect joint_conductance(Scene scene, double size) {
  Effect effect;
  effect.name = "joint-conductance";
  const Plant& lumped = scene.machine.lumped;
  std::vector<std::size_t> fit;
  for (std::size_t i = 0; i < lumped.links.size(); ++i)
    if (scene.machine.group(lumped.links[i].a) != scene.machine.group(lumped.links[i].b) && lumped.links[i].W_per_K > 5)
      fit.push_back(i);
  const std::size_t which = scene.random.pick(fit);
  const Link coarse = lumped.links[which];
  // The joints of the lumps come last among the links of the cells, in the same order.
  const Link link = scene.machine.plant.links[scene.machine.plant.links.size() - lumped.links.size() + which];
  effect.places = link_places(scene.machine, coarse.a, coarse.b, true);
  const bool bearing = turns(scene.machine, coarse.a) || turns(scene.machine, coarse.b);
  const Index column = scene.input("spindle_rpm");
  const double top = scene.machine.top_speed_rpm;
  const double direction = bearing ? 1 : scene.random.sign();
  effect.driver = bearing ? "spindle_rpm" : "temperature";
  effect.heat = [=](const Instant& now, Vector& flow) {
    double factor;
    if (bearing) {
      factor = 1 + size * .6 * std::log1p(9 * now.experiment.held(column, now.row) / top) / std::log(10.);
    } else {
      const double mean = .5 * (now.theta[link.a] + now.theta[link.b]);
      factor = std::pow(std::clamp(1 + size * direction * .25 * (mean - 20) / 10, .1, 4.), .95);
    }
    const double more_W = (factor - 1) * link.W_per_K * (now.theta[link.b] - now.theta[link.a]);
    flow[link.a] += more_W;
    flow[link.b] -= more_W;
  };
  return effect;
}

/// A bracket, pipe or guard between parts the network does not join: two light cells in the way.
inline Effect missing_link(Scene scene, double size) {
  Effect effect;
  effect.name = "missing-link";
  const Machine& machine = scene.machine;
  Index a = 0, b = 0;
  for (int trial = 0; trial < 200; ++trial) {
    a = visible_lump(scene);
    b = visible_lump(scene, 1e12);
    const auto near = machine.around(a);
    if (a != b && !machine.linked(a, b) && machine.group(a) != machine.group(b)) break;
  }
  effect.places = link_places(machine, a, b, false);
  const Index cell_a = scene.random.pick(machine.cells(a)), cell_b = scene.random.pick(machine.cells(b));
  effect.rebuild = [=](Plant& plant) {
    const Index first = plant.add_cell(250, .05), second = plant.add_cell(250, .05);
    plant.links.push_back({cell_a, first, 24 * size});
    plant.links.push_back({first, second, 24 * size});
    plant.links.push_back({second, cell_b, 24 * size});
  };
  return effect;
}

/// A slab behind a lump, three cells deep: heat soaks in and comes back.
inline Effect thermal_memory(Scene scene, double size) {
  const Index lump = warm_lump(scene);
  Effect effect = at_lump(scene, "thermal-memory", lump);
  const double capacity = scene.random.uniform(.4, 1.2) * scene.machine.lumped.capacity_J_per_K[lump] * std::sqrt(size);
  const double time_s = scene.random.log_uniform(1800, 10000);
  const std::vector<Index> cells = scene.machine.cells(lump);
  effect.rebuild = [=](Plant& plant) {
    Index before = cells[cells.size() / 2];
    double share = .25;
    for (int i = 0; i < 3; ++i, share += .0833333) {
      const Index cell = plant.add_cell(capacity * share, 0);
      plant.links.push_back({before, cell, 2.2 * capacity / time_s * (i ? 1.5 : 1)});
      before = cell;
    }
  };
  return effect;
}

inline Effect missing_expansion(Scene scene, double size) {
  Effect effect;
  effect.name = "missing-expansion";
  std::vector<Index> fit;
  for (Index i = 0; i < static_cast<Index>(scene.machine.lumps.size()); ++i)
    if (scene.machine.lumped.um_per_K[i] != 0) fit.push_back(i);
  const Index lump = scene.random.pick(fit);
  effect.places = {scene.machine.name(lump)};
  const double sign = scene.random.sign();
  const std::vector<Index> cells = scene.machine.cells(lump);
  effect.nominal = [=](Machine& machine) {
    machine.lumped.um_per_K[lump] = 0;
    for (const Index cell : cells) machine.plant.um_per_K[cell] = 0;
  };
  effect.rebuild = [=](Plant& plant) {
    for (const Index cell : cells) plant.um_per_K[cell] += sign * size / static_cast<double>(cells.size());
  };
  return effect;
}

/// A gap that closes: quadratic at first, linear when closed, 2 s^2 log cosh(dT/s).
inline Effect nonlinear_expansion(Scene scene, double size) {
  const Index lump = warm_lump(scene);
  Effect effect = at_lump(scene, "nonlinear-expansion", lump);
  const std::vector<Index> cells = scene.machine.cells(lump);
  const double closes_K = scene.random.uniform(20, 60), k = scene.random.sign() * .02 * size;
  effect.displacement = [=](std::size_t, const Experiment&, const Matrix& theta, Vector& course) {
    for (Index row = 0; row < course.size(); ++row) {
      double mean = 0;
      for (const Index cell : cells) mean += theta(row, cell) / static_cast<double>(cells.size());
      course[row] += k * 2 * closes_K * closes_K * std::log(std::cosh((mean - 20) / closes_K));
    }
  };
  return effect;
}

/// Centrifugal force against the bearings' stiffness, which rises with the shift.
inline Effect speed_shift(Scene scene, double size) {
  Effect effect;
  effect.name = "speed-shift";
  effect.places = {"displacement", scene.machine.output};
  effect.driver = "spindle_rpm";
  const Index column = scene.input("spindle_rpm");
  const double top = scene.machine.top_speed_rpm, sign = scene.random.sign(), hard = scene.random.uniform(.05, .3);
  effect.displacement = [=](std::size_t, const Experiment& batch, const Matrix&, Vector& course) {
    for (Index row = 0; row < course.size(); ++row) {
      const double x = batch.held(column, row) / top;
      course[row] += sign * 4 * size * x * x / (1 + hard * x * x);
    }
  };
  return effect;
}

/// Guides that stick: two play elements in parallel (Prandtl and Ishlinskii), the larger one with the lesser weight.
inline Effect hysteresis(Scene scene, double size) {
  Effect effect;
  effect.name = "hysteresis";
  effect.places = {"displacement", scene.machine.output};
  const double weight = scene.random.uniform(.6, .9), ratio = scene.random.uniform(1.3, 2);
  effect.displacement = [=](std::size_t, const Experiment&, const Matrix&, Vector& course) {
    const Vector moved = course;
    Vector shown = Vector::Zero(course.size());
    for (const auto& [share, radius] : {std::pair{weight, 2 * size}, {1 - weight, 2 * ratio * size}}) {
      double state = moved[0];
      for (Index row = 0; row < course.size(); ++row) {
        state = std::clamp(state, moved[row] - radius, moved[row] + radius);
        shown[row] += share * state;
      }
    }
    course = shown;
  };
  return effect;
}

/// The machine was warm: a group starts above the air and has settled for ten minutes before the record.
inline Effect initial_gradient(Scene scene, double size) {
  Effect effect;
  effect.name = "initial-gradient";
  std::vector<Index> lumps = warm_group(scene.machine);
  if (scene.random.chance(.3)) lumps = scene.machine.around(pick_lump(scene, true));
  effect.places = names(scene.machine, lumps);
  const bool same = scene.random.chance(.4);
  std::vector<double> rises;
  for (std::size_t b = 0; b < scene.campaign.batches.size(); ++b)
    rises.push_back(2 * size * (same ? 1 : scene.random.uniform(.3, 1.7)));
  std::vector<Index> cells;
  for (const Index lump : lumps)
    cells.insert(cells.end(), scene.machine.cells(lump).begin(), scene.machine.cells(lump).end());
  const Plant plant = scene.machine.plant;
  effect.start = [=](std::size_t batch, Vector& start) {
    const double air = start[0];
    for (const Index cell : cells) start[cell] += rises[batch];
    Experiment settling;
    settling.interval_s = 600;
    settling.steps = 30;
    settling.input = Matrix::Zero(2, 0);
    settling.air_degC = Vector::Constant(31, air);
    Plant resting = plant;
    resting.sources.clear();
    start.head(plant.cells()) =
        simulate(resting, settling, batch, start.head(plant.cells()), {}).bottomRows(1).transpose();
  };
  return effect;
}

inline Effect on_sensor(Scene& scene, const char* name) {
  Effect effect;
  effect.name = name;
  std::vector<std::string> on_parts;
  for (const Sensor& sensor : scene.machine.sensors)
    if (sensor.lump >= 0 && (scene.machine.lumped.capacity_J_per_K[sensor.lump] < 2e5)) on_parts.push_back(sensor.name);
  effect.sensor = scene.random.pick(on_parts);
  effect.places = {effect.sensor};
  return effect;
}

inline Effect sensor_offset(Scene scene, double size) {
  Effect effect = on_sensor(scene, "sensor-offset");
  const double offset_K = scene.random.sign() * size;
  effect.reading = [=](std::size_t, const Experiment&, const Matrix&, Vector& course) { course.array() += offset_K; };
  return effect;
}

/// A wrong scale about the reference, or (a loose clamp) a reading between surface and air.
inline Effect sensor_gain(Scene scene, double size) {
  Effect effect = on_sensor(scene, "sensor-gain");
  const bool loose = scene.random.chance(.25);
  const double lost = .1 * size * (loose ? 1 : scene.random.sign());
  effect.reading = [=](std::size_t, const Experiment& batch, const Matrix&, Vector& course) {
    for (Index row = 0; row < course.size(); ++row)
      course[row] -= lost * (course[row] - (loose ? batch.air_degC[row] : 20));
  };
  return effect;
}

inline Effect sensor_drift(Scene scene, double size) {
  Effect effect = on_sensor(scene, "sensor-drift");
  const double rate_K_per_s = scene.random.sign() * size / 6 / 3600;
  const double settles_s = scene.random.uniform(3, 8) * scene.batch_s();
  effect.reading = [=](std::size_t, const Experiment& batch, const Matrix&, Vector& course) {
    for (Index row = 0; row < course.size(); ++row)
      course[row] += rate_K_per_s * settles_s * -std::expm1(-batch.step_s() * static_cast<double>(row) / settles_s);
  };
  return effect;
}

/// Grease and sleeve in series.
inline Effect sensor_lag(Scene scene, double size) {
  Effect effect = on_sensor(scene, "sensor-lag");
  const double lag_s = 300 * size;
  effect.reading = [=](std::size_t, const Experiment& batch, const Matrix&, Vector& course) {
    course = lagged(lagged(course, batch.step_s(), .85 * lag_s), batch.step_s(), .15 * lag_s);
  };
  return effect;
}

/// The probe creeps, or its fixture follows the air within minutes.
inline Effect probe_drift(Scene scene, double size) {
  Effect effect;
  effect.name = "probe-drift";
  effect.places = {"displacement", scene.machine.output};
  const bool with_air = scene.campaign.air_swing_K > .5 && scene.random.chance(.6);
  effect.driver = with_air ? "ambient" : "time";
  const double sign = scene.random.sign(), fixture_s = scene.random.uniform(60, 600);
  const double settles_s = scene.random.uniform(3, 8) * scene.batch_s();
  effect.displacement = [=](std::size_t, const Experiment& batch, const Matrix&, Vector& course) {
    if (with_air) {
      const Vector fixture = lagged(batch.air_degC, batch.step_s(), fixture_s);
      course += sign * 3 * size * (fixture.array() - fixture[0]).matrix();
      return;
    }
    for (Index row = 0; row < course.size(); ++row)
      course[row] +=
          sign * size / 3600 * settles_s * -std::expm1(-batch.step_s() * static_cast<double>(row) / settles_s);
  };
  return effect;
}

inline Effect clock_offset(Scene scene, double size) {
  Effect effect;
  effect.name = "clock-offset";
  effect.places = {"displacement", scene.machine.output};
  const double late_s = 180 * size;
  effect.displacement = [=](std::size_t, const Experiment& batch, const Matrix&, Vector& course) {
    const Vector on_time = course;
    for (Index row = 0; row < course.size(); ++row) {
      const double at = std::max(0., static_cast<double>(row) - late_s / batch.step_s());
      const Index before = static_cast<Index>(at);
      const double rest = at - static_cast<double>(before);
      course[row] = (1 - rest) * on_time[before] + rest * on_time[std::min(before + 1, course.size() - 1)];
    }
  };
  return effect;
}

}  // namespace laws

/// Law and its greatest physical size.
inline const std::map<std::string, std::pair<Law, double>>& known_effects() {
  static const std::map<std::string, std::pair<Law, double>> all{
      {"heat-source", {laws::heat_source, 8}},
      {"friction-law", {laws::friction_law, 4}},
      {"coolant", {laws::coolant, 6}},
      {"ambient-drift", {laws::ambient_drift, 1}},
      {"forced-convection", {laws::forced_convection, 5}},
      {"natural-convection", {laws::natural_convection, 8}},
      {"radiation", {laws::radiation, 8}},
      {"joint-conductance", {laws::joint_conductance, 3}},
      {"missing-link", {laws::missing_link, 3}},
      {"thermal-memory", {laws::thermal_memory, 16}},
      {"missing-expansion", {laws::missing_expansion, 8}},
      {"nonlinear-expansion", {laws::nonlinear_expansion, 8}},
      {"speed-shift", {laws::speed_shift, 8}},
      {"hysteresis", {laws::hysteresis, 8}},
      {"initial-gradient", {laws::initial_gradient, 3}},
      {"sensor-offset", {laws::sensor_offset, 6}},
      {"sensor-gain", {laws::sensor_gain, 4}},
      {"sensor-drift", {laws::sensor_drift, 8}},
      {"sensor-lag", {laws::sensor_lag, 4}},
      {"probe-drift", {laws::probe_drift, 8}},
      {"clock-offset", {laws::clock_offset, 5}}};
  return all;
}

}  // namespace blind
