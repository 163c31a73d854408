#pragma once

#include <random>

#include "thermfit/effects/catalogue.hpp"
#include "thermfit/network/simulate.hpp"

/// Spindle, head and column in a row, driven by spindle speed; each has a sensor, T4 is the room.
inline thermfit::ThermalNetwork small_machine() {
  thermfit::ThermalNetwork machine;
  machine.name = "small";
  machine.ambient = {thermfit::ThermalNetwork::Ambient::Rule::column, "T4", 0};
  machine.nodes = {{"spindle", 3000, 2}, {"head", 9000, 4}, {"column", 30000, 6}};
  machine.links = {{0, 1, 8}, {1, 2, 5}};
  machine.heat_sources = {{"bearing", "spindle_rpm", 4000, 1, 200, {{0, 1.0}}}};
  machine.displacements = {{"Z", true, {{0, 1.5}, {1, 2.0}, {2, -1.0}}}};
  machine.sensors = {{"T1", 0, 0}, {"T2", 1, 0}, {"T3", 2, 0}, {"T4", thermfit::ThermalNetwork::ambient_node, 0}};
  return machine;
}

/// What `machine` would measure in `count` batches of six hours with random speed stairs: noise of .03 K and .25 um.
inline thermfit::Campaign small_campaign(const thermfit::ThermalNetwork& machine, int count, unsigned seed = 1,
                                         const thermfit::EffectLibrary& library = thermfit::standard_effects()) {
  using namespace thermfit;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Campaign campaign;
  for (int b = 0; b < count; ++b) {
    Batch batch;
    batch.name = "K0" + std::to_string(b + 1);
    batch.time_s = Vector::LinSpaced(121, 0, 21600);
    batch.inputs = {{"spindle_rpm"}, Matrix(121, 1)};
    batch.temperatures = {{"T1", "T2", "T3", "T4"}, Matrix::Constant(121, 4, 15. + 2 * b)};
    batch.errors = {{"Z"}, Matrix::Zero(121, 1)};
    double level = 2000;
    for (int k = 0; k < 121; ++k)
      batch.inputs.values(k, 0) = level = random() % 25 == 0 ? 1000. * static_cast<double>(random() % 7) : level;
    const Simulation truth = simulate(machine, {excitation_of(machine, batch)}, library)[0];
    for (int k = 0; k < 121; ++k) {
      for (int c = 0; c < 3; ++c) batch.temperatures.values(k, c) = truth.channels(k, c) + .03 * normal(random);
      batch.errors.values(k, 0) = truth.channels(k, 4) + .25 * normal(random);
    }
    campaign.push_back(std::move(batch));
  }
  return campaign;
}
