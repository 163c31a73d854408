#pragma once

#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// What drives one batch, as the simulator needs it: a clock, held inputs, the ambient temperature and where it starts.
struct Excitation {
  std::string batch;
  Vector time_s;                         ///< since the first sample; strictly increasing
  std::vector<std::string> input_names;  ///< columns of `inputs`
  Matrix inputs;                         ///< samples x inputs, held until the next sample
  Vector ambient_degC;                   ///< at the samples, linear between them
  Vector measured_ambient_degC;          ///< reading of the ambient sensor; empty where there is none
  Vector start_degC;                     ///< of every node
  std::vector<Index> start_sensor;       ///< for each node, the sensor its start was read from, or -1

  Index samples() const { return time_s.size(); }
};

/// The excitation of a batch. Throws Error when the batch has no clock, fewer than two samples, lacks a column that the
/// network needs, or has a missing value in one.
Excitation excitation_of(const ThermalNetwork& network, const Batch& batch);
std::vector<Excitation> excitations_of(const ThermalNetwork& network, const Campaign& campaign);

}  // namespace thermfit
