#pragma once

/// What is done about probes that count from another zero: it is left free.

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/batch/error_reference.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// Whether `problems` hold a displacement `name` whose probe counts from another zero.
inline bool has_free_datum(const std::vector<DataProblem>& problems, const std::string& name) {
  return std::any_of(problems.begin(), problems.end(), [&](const DataProblem& one) {
    return one.kind == DataProblem::Kind::datum && one.names[0] == name;
  });
}

/// Displacements whose probe counts from another zero, about their mean in each batch on both sides: a zero that is a
/// free number. Allocates.
template <typename Scalar = double>
void free_datums(ThermalNetwork& machine, Campaign& campaign, const std::vector<DataProblem>& problems) {
  for (ThermalNetwork::Displacement& output : machine.displacements) {
    if (!has_free_datum(problems, output.output)) continue;
    output.free_datum = true;
    for (Batch& batch : campaign) {
      MatrixX<Scalar>& values = batch.errors.values;
      const Index column = batch.errors.find(output.output);
      if (column < 0) continue;
      double sum = 0, count = 0;
      for (Index row = 0; row < values.rows(); ++row)
        if (std::isfinite(values(row, column))) sum += values(row, column), ++count;
      if (count > 0) values.col(column).array() -= Scalar(sum / count);
    }
  }
}

/// The machine with its own zeros again.
inline ThermalNetwork with_own_datums(ThermalNetwork machine) {
  for (ThermalNetwork::Displacement& output : machine.displacements) output.free_datum = false;
  return machine;
}

/// Displacements whose probe counts from another zero, in the batches where it does from where the simulated ones
/// start; whether there are any. Allocates.
template <typename Scalar = double>
bool start_alike(Campaign& measured, const Campaign& simulated, const std::vector<DataProblem>& problems) {
  bool any = false;
  for (const DataProblem& one : problems) {
    if (one.kind != DataProblem::Kind::datum) continue;
    any = true;
    for (Batch& batch : measured) {
      const auto same = std::find_if(simulated.begin(), simulated.end(),
                                     [&](const Batch& other) { return other.name == batch.name; });
      if (std::find(one.batches.begin(), one.batches.end(), batch.name) == one.batches.end()) continue;
      if (same == simulated.end()) continue;
      const Index own = batch.errors.find(one.names[0]), other = same->errors.find(one.names[0]);
      if (own < 0 || other < 0) continue;
      MatrixX<Scalar>& values = batch.errors.values;
      values.col(own).array() -= Scalar(error_start(batch.errors.values.col(own)).value_um -
                                        error_start(same->errors.values.col(other)).value_um);
    }
  }
  return any;
}

}  // namespace thermfit
