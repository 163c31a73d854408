#pragma once

/// A small machine and campaigns of it, made with the simulator itself: quick ground truth for the diagnosis. (The
/// blind check in tests/blind uses a finer, independent plant.)

#include <cmath>
#include <random>
#include <string>

#include "thermfit/effects/catalogue.hpp"
#include "thermfit/network/simulate.hpp"

namespace bench {

using namespace thermfit;

inline ThermalNetwork machine() {
  ThermalNetwork network;
  network.name = "bench";
  const auto node = [&](const char* name, double J_per_K, double W_per_K) {
    ThermalNetwork::Node one;
    one.name = name;
    one.capacity_J_per_K = J_per_K;
    one.ambient_W_per_K = W_per_K;
    network.nodes.push_back(one);
  };
  node("spindle", 1500, 0.5);
  node("head", 9000, 3);
  node("column", 40000, 6);
  node("bed", 90000, 8);
  const auto link = [&](Index a, Index b, double W_per_K) {
    ThermalNetwork::Link one;
    one.a = a;
    one.b = b;
    one.conductance_W_per_K = W_per_K;
    network.links.push_back(one);
  };
  link(0, 1, 9);
  link(1, 2, 12);
  link(2, 3, 8);
  ThermalNetwork::HeatSource bearing;
  bearing.name = "bearing";
  bearing.input = "spindle_rpm";
  bearing.scale = 4000;
  bearing.exponent = 1.2;
  bearing.power_W = 150;
  bearing.into = {{0, 0.6}, {1, 0.4}};
  network.heat_sources = {bearing};
  ThermalNetwork::Displacement z;
  z.output = "Z";
  z.um_per_K = {{0, 0.8}, {1, 1.5}, {2, -2.0}};
  network.displacements = {z};
  const auto sensor = [&](const char* column, Index at) {
    ThermalNetwork::Sensor one;
    one.column = column;
    one.node = at;
    network.sensors.push_back(one);
  };
  sensor("T1", 0);
  sensor("T2", 1);
  sensor("T3", 2);
  sensor("T4", 3);
  sensor("T5", ThermalNetwork::ambient_node);
  network.ambient.rule = ThermalNetwork::Ambient::Rule::column;
  network.ambient.column = "T5";
  return network;
}

/// Batches of four hours, a sample every three minutes, with changing speed and room, measured on `plant` with noise of
/// .03 K and .25 um. Every part starts off the room by its own draw, a batch at a time, of the standard deviation
/// given.
inline Campaign campaign(const ThermalNetwork& plant, std::size_t batches, unsigned seed, double uneven_start_K = 0,
                         const EffectLibrary& library = standard_effects()) {
  std::mt19937 random(seed), starts(seed + 1);
  std::normal_distribution<double> normal, off;
  const Index rows = 81;
  Campaign result;
  for (std::size_t b = 0; b < batches; ++b) {
    Batch batch;
    batch.name = "K0" + std::to_string(b + 1);
    batch.time_s = Vector::LinSpaced(rows, 0, 180.0 * static_cast<double>(rows - 1));
    batch.inputs.names = {"spindle_rpm"};
    batch.inputs.values.resize(rows, 1);
    batch.temperatures.names = {"T1", "T2", "T3", "T4", "T5"};
    batch.temperatures.values.setZero(rows, 5);
    batch.errors.names = {"Z"};
    batch.errors.values.setZero(rows, 1);
    const double speeds[] = {0, 1000, 2000, 3000, 4500, 6000}, room = 8 + 3.0 * static_cast<double>(b);
    double speed = 4500, swing = 1 + 0.3 * static_cast<double>(b % 3);
    for (Index k = 0; k < rows; ++k) {
      if (k % 20 == 0) speed = speeds[random() % 6];
      batch.inputs.values(k, 0) = speed;
      batch.temperatures.values(k, 4) = room + swing * std::sin(0.03 * static_cast<double>(k) + static_cast<double>(b));
    }
    Excitation excitation = excitation_of(plant, batch);
    for (double& start : excitation.start_degC) start += uneven_start_K * off(starts);
    const Simulation truth = simulate(plant, {excitation}, library)[0];
    for (Index k = 0; k < rows; ++k) {
      for (Index s = 0; s < 4; ++s) batch.temperatures.values(k, s) = truth.channels(k, s) + 0.03 * normal(random);
      batch.errors.values(k, 0) = truth.channels(k, 5) + 0.25 * normal(random);
    }
    result.push_back(std::move(batch));
  }
  return result;
}

/// Every batch without its first rows, the probe zeroed where it now begins.
inline Campaign begun_late(Campaign campaign, Index rows) {
  for (Batch& batch : campaign) {
    const Index kept = batch.rows() - rows;
    batch.time_s = Vector(batch.time_s.tail(kept).array() - batch.time_s(rows));
    for (Channels* one : {&batch.temperatures, &batch.errors, &batch.inputs})
      one->values = Matrix(one->values.bottomRows(kept));
    batch.errors.values.rowwise() -= Eigen::RowVectorXd(batch.errors.values.row(0));
  }
  return campaign;
}

}  // namespace bench
