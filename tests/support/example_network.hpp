#pragma once

#include <cmath>

#include "thermfit/batch/batch.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit::test {

/// Five lumps with two sources, four sensors and one displacement.
inline ThermalNetwork example_network() {
  ThermalNetwork network;
  network.name = "example";
  network.reference_degC = 20;
  network.ambient = {ThermalNetwork::Ambient::Rule::column, "T9", 0};
  network.nodes = {
      {"nose", 1300, 0.4}, {"bearing", 1500, 0.3}, {"head", 12000, 4}, {"motor", 6300, 2.2}, {"bed", 90000, 9}};
  network.links = {{0, 1, 2.0}, {1, 2, 9.1}, {2, 3, 3.4}, {2, 4, 20.0}};
  network.heat_sources = {{"bearing friction", "spindle_rpm", 4000, 1.2, 150, {{1, 0.6}, {2, 0.4}}},
                          {"motor losses", "spindle_rpm", 4000, 1.0, 80, {{3, 1.0}}}};
  network.displacements = {{"Z", true, {{0, 0.8}, {1, 0.6}, {2, 2.5}, {4, -1.6}}}};
  network.sensors = {{"T1", 1}, {"T2", 2}, {"T3", 3}, {"T4", 4}, {"T9", ThermalNetwork::ambient_node}};
  return network;
}

/// A duty cycle of an hour or more with uneven sampling, a changing room and a coolant that is switched.
inline Batch example_batch(int number = 0, Index samples = 41) {
  Batch batch;
  batch.name = "B" + std::to_string(number);
  batch.time_s.resize(samples);
  batch.inputs.names = {"spindle_rpm", "feed_mm_min", "coolant"};
  batch.inputs.values.resize(samples, 3);
  batch.temperatures.names = {"T1", "T2", "T3", "T4", "T9"};
  batch.temperatures.values.resize(samples, 5);
  batch.errors.names = {"Z"};
  batch.errors.values = Matrix::Zero(samples, 1);
  const double speeds[] = {2000, 6000, 3000, 0, 4500};
  for (Index k = 0; k < samples; ++k) {
    const auto i = static_cast<double>(k);
    batch.time_s(k) = 180 * i + (k % 3 == 1 ? 40 : 0);
    batch.inputs.values(k, 0) = speeds[(k / 9 + number) % 5];
    batch.inputs.values(k, 1) = (k / 7 + number) % 2 ? 1500 : 0;
    batch.inputs.values(k, 2) = (k / 5 + number) % 3 == 1 ? 1 : 0;
    batch.temperatures.values(k, 4) = 17 + 3 * number + 2.5 * std::sin(0.11 * i + number);
    batch.temperatures.values.row(k).head(4).setConstant(batch.temperatures.values(k, 4));
  }
  return batch;
}

}  // namespace thermfit::test
