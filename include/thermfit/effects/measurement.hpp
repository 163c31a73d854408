#pragma once

#include <string>
#include <vector>

#include "thermfit/effects/output_traces.hpp"
#include "thermfit/effects/place.hpp"
#include "thermfit/effects/setting.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit {

/// A fault of one sensor, the place; what it does to the reading is up to the derived effect.
class SensorEffect : public Effect {
 public:
  Stage stage() const override { return Stage::measurement; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const std::string& sensor : sensor_places(setting.network)) {
      const EffectParameter p = parameter();
      result.push_back({name(), sensor, "", {{p.name, p.mean}}});
    }
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    sensor_at(network, added.location);
    return {parameter()};
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect& where, double batch_hours) const override {
    return block_that_shows(ScheduleKind::sensor_swap, where.location, batch_hours);
  }

 protected:
  /// The one number of its law.
  virtual EffectParameter parameter() const = 0;
};

/// Reading + b.
class SensorOffset : public SensorEffect {
 public:
  std::string name() const override { return "sensor-offset"; }
  std::string meaning() const override { return "the sensor reads a constant too much or too little"; }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    system.reading(sensor_at(network, added.location),
                   [](const Moment& now, const double* p) { return now.reading_degC + p[0]; });
  }
  bool calibration_does_the_same() const override { return true; }
  void trace(OutputTraces& traces) const override {
    for (const Index c : traces.thermometers())
      traces.added_to(c, traces.name(c), "", {"offset_K", "K"}, [](const PairedBatch&, Index) { return 1.; });
  }

 protected:
  EffectParameter parameter() const override { return linear_parameter("offset_K", "K", 3); }
};

/// Reading with another gain about the reference temperature.
class SensorGain : public SensorEffect {
 public:
  std::string name() const override { return "sensor-gain"; }
  std::string meaning() const override { return "the sensor's scale is wrong"; }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    system.reading(sensor_at(network, added.location),
                   [reference = network.reference_degC](const Moment& now, const double* p) {
                     return reference + p[0] * (now.reading_degC - reference);
                   });
  }
  void trace(OutputTraces& traces) const override {
    for (const Index c : traces.thermometers())
      traces.added_to(c, traces.name(c), "", {"gain", ""}, [&](const PairedBatch& batch, Index k) {
        return batch.simulated(k, c) - traces.reference_degC();
      });
  }

 protected:
  EffectParameter parameter() const override {
    EffectParameter gain = linear_parameter("gain", "", 0.1);
    gain.mean = gain.null = 1;
    return gain;
  }
};

/// Reading + b t, t since the first sample.
class SensorDrift : public SensorEffect {
 public:
  std::string name() const override { return "sensor-drift"; }
  std::string meaning() const override { return "the sensor's zero wanders"; }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    system.reading(sensor_at(network, added.location),
                   [](const Moment& now, const double* p) { return now.reading_degC + p[0] * now.time_s / 3600; });
  }
  void trace(OutputTraces& traces) const override {
    for (const Index c : traces.thermometers())
      traces.added_to(c, traces.name(c), "", {"rate_K_per_h", "K/h"},
                      [](const PairedBatch& batch, Index k) { return batch.time_s(k) / 3600; });
  }

 protected:
  EffectParameter parameter() const override { return linear_parameter("rate_K_per_h", "K/h", 0.5); }
};

/// A sensor that follows with a first-order lag: a mass too small to disturb its node, behind a conductance, so that
/// the lag is integrated exactly with everything else.
class SensorLag : public SensorEffect {
 public:
  std::string name() const override { return "sensor-lag"; }
  std::string meaning() const override { return "the sensor follows its place late"; }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const Index sensor = sensor_at(network, added.location);
    const Index node = network.sensors[static_cast<std::size_t>(sensor)].node;
    if (node < 0) throw Error("location", "'" + added.location + "' is in the air", "a sensor on a node");
    const double J_per_K = 1e-7 * network.nodes[static_cast<std::size_t>(node)].capacity_J_per_K;
    const Index tip = system.add_node(node, [J_per_K](const Moment&, const double*) { return J_per_K; });
    system.add_conductance(tip, node, [J_per_K](const Moment&, const double* p) { return J_per_K / p[0]; });
    system.read_from(sensor, tip);
  }
  void trace(OutputTraces& traces) const override {
    for (const Index c : traces.thermometers())
      for (double share = .003; share < .25; share *= 1.35) {
        const double lag_s = share * traces.longest_batch_s();
        traces.bends(c, {"lag_s", "s", lag_s}, [=](const Vector& time_s, const Vector& course) {
          return low_pass(time_s, course, lag_s, course(0));
        });
      }
  }

 protected:
  EffectParameter parameter() const override {
    EffectParameter lag = log_parameter("lag_s", "s", 100, 1.2);
    lag.lower = 0.1;
    lag.starts = {30, 200, 1000};
    return lag;
  }
};

/// The displacement probe drifts: + b t (driver `time`), or with the room: + k (amb - amb_0), as its fixture feels it
/// through a first-order lag (`ambient`).
class ProbeDrift : public Effect {
 public:
  std::string name() const override { return "probe-drift"; }
  Stage stage() const override { return Stage::measurement; }
  std::string meaning() const override { return "the displacement probe or its holder drifts"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    std::vector<ThermalNetwork::AddedEffect> result;
    const bool room = setting.ambient_varies || setting.network.ambient.rule == ThermalNetwork::Ambient::Rule::column;
    for (const std::string& place : displacement_places(setting.network)) {
      result.push_back({name(), place, "time", {{"rate_um_per_h", 0}}});
      if (room) result.push_back({name(), place, "ambient", {{"um_per_K", 0}, {"lag_s", 0}}});
    }
    return result;
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                          const ThermalNetwork::AddedEffect& added) const override {
    displacements_at(network, added.location);
    if (added.driver == "time") return {linear_parameter("rate_um_per_h", "um/h", 2)};
    if (added.driver == "ambient") return {linear_parameter("um_per_K", "um/K", 2), room_lag_parameter(600, {0, 600})};
    throw Error("driver", "'" + added.driver + "'", "time, ambient");
  }
  void act(ThermalSystem& system, const ThermalNetwork& network,
           const ThermalNetwork::AddedEffect& added) const override {
    const std::vector<Index> outputs = displacements_at(network, added.location);
    if (added.driver == "time") {
      for (const Index output : outputs)
        system.displacement(output, {}, [](const Moment& now, const double* p) { return p[0] * now.time_s / 3600; });
      return;
    }
    for (const Index output : outputs)
      system.displacement(output, {}, [](const Moment& now, const double* p) {
        return p[0] * now.measured_ambient->felt_rise(at_least_a_second(p[1]), now.time_s);
      });
  }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect&, double batch_hours) const override {
    return block_that_shows(ScheduleKind::idle_day, {}, 4 * batch_hours);
  }
  void trace(OutputTraces& traces) const override {
    for (const Index z : traces.displacements()) {
      traces.added_to(z, traces.place(z), "time", {"rate_um_per_h", "um/h"},
                      [](const PairedBatch& batch, Index k) { return batch.time_s(k) / 3600; });
      if (traces.has_room())
        traces.added_to(z, traces.place(z), "ambient", {"um_per_K", "um/K"},
                        [](const PairedBatch& batch, Index k) { return OutputTraces::room_rise_K(batch, k); });
    }
  }
};

/// The displacements are logged late by d against temperatures and inputs.
class ClockOffset : public Effect {
 public:
  std::string name() const override { return "clock-offset"; }
  Stage stage() const override { return Stage::measurement; }
  std::string meaning() const override { return "the displacement log has another clock"; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const override {
    if (setting.network.displacements.empty()) return {};
    return {{name(), "displacement", "", {{"late_s", 0}}}};
  }
  std::vector<EffectParameter> parameters(const ThermalNetwork&,
                                          const ThermalNetwork::AddedEffect& added) const override {
    if (added.location != "displacement") throw Error("location", "'" + added.location + "'", "displacement");
    EffectParameter late = linear_parameter("late_s", "s", 120);
    late.starts = {30, -30};
    return {late};
  }
  void act(ThermalSystem& system, const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    system.delay_displacements([](const Moment&, const double* p) { return p[0]; });
  }
  std::string disturbs(const ThermalNetwork::AddedEffect&) const override { return "clock"; }
  void trace(OutputTraces& traces) const override {
    for (const Index z : traces.displacements())
      for (double share = .002; share < .12; share *= 1.3) {
        const double delay_s = share * traces.longest_batch_s();
        traces.bends(z, {"late_s", "s", delay_s},
                     [=](const Vector& time_s, const Vector& course) { return delayed(time_s, course, delay_s); });
      }
  }
};

}  // namespace thermfit
