#pragma once

/// A campaign laid beside what a machine file says for it.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/linearized.hpp"
#include "thermfit/calibration/machine_record.hpp"
#include "thermfit/calibration/start_tolerance.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/sides/side_channel.hpp"
#include "thermfit/effects/setting.hpp"

namespace thermfit {

/// What `machine` says for a record beside what was measured, its calibration parameters as the belief. `machine` is
/// complete, as of with_complete_effects(); `library` must outlive the result. Throws Error as simulate() does.
/// Allocates.
template <typename Scalar = double>
Sides sides_of(const ThermalNetwork& machine, const Lazy<MachineRecord, Scalar>& seen, const EffectLibrary& library) {
  Lazy<Sides, Scalar> result;
  result.batches = seen.names;
  result.time_s = seen.time_s;
  result.computed = true;
  result.largest_um_per_K = largest_expansion_um_per_K(machine);
  const Lazy<std::vector<Simulation>, Scalar> simulated = simulate<Scalar>(machine, seen.excitations, library);
  std::vector<Index> columns;
  for (const ObservedChannel& channel : seen.channels) {
    SideChannel one{channel.name, channel.displacement, channel.measured, {}, channel.floor, false};
    for (const ThermalNetwork::Displacement& output : machine.displacements)
      if (output.output == channel.name) one.absolute = output.absolute;
    for (const Simulation& batch : simulated) one.simulated.push_back(batch.channels.col(channel.column));
    columns.push_back(channel.column);
    result.channels.push_back(std::move(one));
  }
  struct Known {
    std::vector<Parameter> parameters;
    Lazy<std::vector<Simulation>, Scalar> simulated;
  };
  auto known = std::make_shared<Known>();
  result.belief = [machine, excitations = seen.excitations, &library, columns, known](std::size_t c) {
    if (known->simulated.empty()) {
      known->parameters = calibration_parameters<Scalar>(machine, library);
      known->simulated = simulate<Scalar>(machine, excitations, library, known->parameters);
    }
    std::vector<VectorX<Scalar>> kept;
    Index rows = 0;
    for (const Simulation& batch : known->simulated) rows += batch.channels.rows();
    for (Index j = 0; j < static_cast<Index>(known->parameters.size()); ++j) {
      VectorX<Scalar> direction(rows);
      Index row = 0;
      for (const Lazy<Simulation, Scalar>& batch : known->simulated) {
        const Index n = batch.channels.rows();
        direction.segment(row, n) = batch.jacobian.col(j).segment(columns[c] * n, n);
        row += n;
      }
      direction *= known->parameters[static_cast<std::size_t>(j)].slope(0);
      if (direction.squaredNorm() > 0) kept.push_back(std::move(direction));
    }
    MatrixX<Scalar> directions(rows, static_cast<Index>(kept.size()));
    for (std::size_t j = 0; j < kept.size(); ++j) directions.col(static_cast<Index>(j)) = kept[j];
    return directions;
  };
  return result;
}

}  // namespace thermfit
