#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/lazy.hpp"
#include "thermfit/network/impl/drive.hpp"
#include "thermfit/network/impl/state_columns.hpp"

namespace thermfit::detail {

/// Temperatures of all nodes at the first sample, hidden ones last, and their tangents.
template <typename Scalar>
struct StartState {
  VectorX<Scalar> degC;
  MatrixX<Scalar> tangents;  ///< nodes x state columns
};

/// Moves every node with sensors towards what they read first, offsets and all: were the offsets taken off, they
/// could move the starts at will.
template <typename Scalar>
void start_by_readings(const Lazy<ThermalSystem, Scalar>& system, const Drive<Scalar>& drive,
                       const StateColumns<Scalar>& place, StartState<Scalar>& start) {
  const auto& [share, own_column, node_of_sensor] = system.start_by_readings;
  const Lazy<Excitation, Scalar>& excitation = drive.excitation();
  const VectorX<Scalar>& first_degC = excitation.first_reading_degC;
  const Index sensors = std::min(static_cast<Index>(node_of_sensor.size()), first_degC.size());
  VectorX<Scalar> sensors_at = VectorX<Scalar>::Zero(start.degC.size());
  std::vector<Index> read_by;
  for (Index s = 0; s < sensors; ++s) {
    read_by.push_back(std::isfinite(first_degC(s)) ? node_of_sensor[static_cast<std::size_t>(s)] : -1);
    if (read_by.back() >= 0) sensors_at(read_by.back()) += 1;
  }
  for (Index s = 0; s < sensors; ++s) {
    const Index node = read_by[static_cast<std::size_t>(s)];
    if (node < 0) continue;
    const double rise = (first_degC(s) - excitation.ambient_degC(0) - drive.first_move_K()) / sensors_at(node);
    start.degC(node) += share * rise;
    if (const auto* own = drive.of_batch())
      for (std::size_t k = 0; k < own->ambient_columns.size(); ++k)
        if (const Column column = own->ambient_columns[k]; column >= 0)
          start.tangents(node, place(column)) -= share * room_shape(k, 0) / sensors_at(node);
    if (own_column >= 0) start.tangents(node, place(own_column)) += rise;
  }
}

/// Moves the start by the numbers of the batch: nodes that start at ambient go with it.
template <typename Scalar>
void start_by_batch(const ThermalSystem::OfBatch& own, const Drive<Scalar>& drive, const StateColumns<Scalar>& place,
                    StartState<Scalar>& start) {
  const std::vector<char>& at_ambient = drive.excitation().starts_at_ambient;
  for (std::size_t i = 0; i < at_ambient.size(); ++i) {
    if (!at_ambient[i]) continue;
    start.degC(static_cast<Index>(i)) += drive.first_move_K();
    for (std::size_t k = 0; k < own.ambient_columns.size(); ++k)
      if (const Column column = own.ambient_columns[k]; column >= 0)
        start.tangents(static_cast<Index>(i), place(column)) += room_shape(k, 0);
  }
  for (std::size_t i = 0; i < own.start_K.size(); ++i) {
    start.degC(static_cast<Index>(i)) += own.start_K[i];
    if (own.start_columns[i] >= 0) start.tangents(static_cast<Index>(i), place(own.start_columns[i])) += 1;
  }
}

/// Where a batch begins, by ThermalNetwork::Initial and the effects on it.
template <typename Scalar>
StartState<Scalar> start_state(const Lazy<ThermalSystem, Scalar>& system, const Drive<Scalar>& drive,
                               const StateColumns<Scalar>& place, Index nodes) {
  const Lazy<Excitation, Scalar>& excitation = drive.excitation();
  StartState<Scalar> start{VectorX<Scalar>::Zero(nodes), MatrixX<Scalar>::Zero(nodes, place.count())};
  start.degC.head(system.own_nodes) = excitation.start_degC;
  for (Index node = 0; node < system.own_nodes; ++node) {
    const auto& sensors = excitation.start_sensors[static_cast<std::size_t>(node)];
    for (const Index s : sensors) {
      const ThermalSystem::Sensor& sensor = system.sensors[static_cast<std::size_t>(s)];
      const double share = 1 / static_cast<double>(sensors.size());
      start.degC(node) -= share * sensor.offset_K;
      if (sensor.column >= 0) start.tangents(node, place(sensor.column)) -= share;
    }
  }
  if (system.start_by_readings.share != 0 || system.start_by_readings.column >= 0)
    start_by_readings<Scalar>(system, drive, place, start);
  if (drive.of_batch() != nullptr) start_by_batch<Scalar>(*drive.of_batch(), drive, place, start);
  const Moment now = drive.moment(0, drive.time_s(0), nullptr);
  for (const auto& [node, law] : system.starts) {
    start.degC(node) += system.value(law, now);
    const Index row = node;
    system.derivatives(law, now, [&](Column column, double slope) { start.tangents(row, place(column)) += slope; });
  }
  for (Index i = system.own_nodes; i < nodes; ++i) {
    const ThermalSystem::Capacity& hidden = system.capacities[static_cast<std::size_t>(i)];
    start.degC(i) = start.degC(hidden.starts_like);
    start.tangents.row(i) = start.tangents.row(hidden.starts_like);
  }
  return start;
}

}  // namespace thermfit::detail
