#pragma once

/// Which half of the chain the displacement gap comes from: the temperatures, or what is made of them.

#include <cmath>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/network/simulate.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// Share of the expansion that must be on nodes with a thermometer for the split to mean something.
constexpr double least_sensed = .2;

/// Splits measured minus simulated displacement exactly, sample by sample:
///
///   z - z_sim = [z - sum_i e_i (theta_i* - reference)] + [sum_i e_i (theta_i* - theta_i)]
///
/// where theta* is the mean of the sensors of a node (offsets taken off) and, for nodes without one, the simulated
/// temperature. The first part is expansion and probe, the second the temperatures' share. Speaks of the machine's
/// first displacement; `known` is false without one, or when less than a fifth of the expansion is on nodes with a
/// sensor. `simulated[b]` belongs to `campaign[b]`.
template <typename Scalar = double>
ChainSplit chain_split(const ThermalNetwork& network, const Campaign& campaign,
                       const std::vector<Simulation>& simulated) {
  ChainSplit split;
  if (network.displacements.empty()) return split;
  const ThermalNetwork::Displacement& output = network.displacements[0];
  double sensed = 0, all = 0, total = 0, temperature = 0, expansion = 0, rows = 0;
  for (std::size_t b = 0; b < campaign.size(); ++b) {
    const Batch& batch = campaign[b];
    const Index column = batch.errors.find(output.output);
    if (column < 0) return split;
    const MatrixX<Scalar>&temperatures = batch.temperatures.values, &errors = batch.errors.values,
          &channels = simulated[b].channels;
    VectorX<Scalar> carried = VectorX<Scalar>::Zero(batch.rows());
    for (const auto& [node, um_per_K] : output.um_per_K) {
      VectorX<Scalar> offset_K = VectorX<Scalar>::Zero(batch.rows());
      double count = 0;
      for (std::size_t s = 0; s < network.sensors.size(); ++s) {
        const Index at = batch.temperatures.find(network.sensors[s].column);
        if (network.sensors[s].node != node || at < 0) continue;
        offset_K += temperatures.col(at) - channels.col(static_cast<Index>(s));
        ++count;
      }
      if (count > 0) carried += um_per_K / count * offset_K;
      if (b == 0) {
        all += std::abs(um_per_K);
        if (count > 0) sensed += std::abs(um_per_K);
      }
    }
    if (output.free_datum)
      carried.array() -= carried.mean();
    else if (output.zero_at_first_sample && carried.size() > 0)
      carried.array() -= carried(0);
    const VectorX<Scalar> gap = errors.col(column) - channels.col(static_cast<Index>(network.sensors.size()));
    total += gap.squaredNorm();
    temperature += carried.squaredNorm();
    expansion += (gap - carried).squaredNorm();
    rows += static_cast<double>(gap.size());
  }
  split.um_per_K_sensed = all > 0 ? sensed / all : 0;
  split.known = rows > 0 && split.um_per_K_sensed >= least_sensed;
  split.total_um = std::sqrt(total / std::max(rows, 1.));
  split.temperature_um = std::sqrt(temperature / std::max(rows, 1.));
  split.expansion_um = std::sqrt(expansion / std::max(rows, 1.));
  return split;
}

}  // namespace thermfit
