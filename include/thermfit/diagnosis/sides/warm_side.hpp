#pragma once

/// A warm start as a data problem.

#include <vector>

#include "thermfit/calibration/warm_start.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"

namespace thermfit {

/// What to tell of batches that start out of equilibrium: nothing where none does, or where the machine file says how
/// its parts start.
inline std::vector<DataProblem> warm_start_problem(const ThermalNetwork& machine,
                                                   const std::vector<Excitation>& excitations) {
  if (machine.initial.rule != ThermalNetwork::Initial::Rule::ambient || machine.initial.share != 0) return {};
  const WarmStart warm = warm_start(machine, excitations);
  if (!warm) return {};
  DataProblem told;
  told.kind = DataProblem::Kind::warm_start;
  told.batches = warm.batches;
  told.batch = warm.batch;
  told.channel = warm.channel;
  told.figure = warm.rise_K;
  return {told};
}

}  // namespace thermfit
