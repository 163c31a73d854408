#pragma once

/// What a fit says of single batches.

#include <cmath>
#include <cstddef>
#include <vector>

#include "thermfit/calibration/fitted_batch.hpp"
#include "thermfit/calibration/fitted_machine.hpp"
#include "thermfit/calibration/machine_record.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/network/room_shape.hpp"

namespace thermfit {

/// The numbers of every batch; nothing where the machine's rules leave none open. Allocates.
template <typename Scalar = double>
std::vector<FittedBatch> fitted_batches(const MapFit& fit, const MachineRecord& seen) {
  std::vector<FittedBatch> result;
  const ThermalNetwork network = fit.network();
  if (network.batches.empty()) return result;
  const MatrixX<Scalar> covariance = fit.covariance<Scalar>();
  const VectorX<Scalar> slopes = fit.slopes();
  for (std::size_t b = 0; b < network.batches.size(); ++b) {
    const ThermalNetwork::OfBatch& own = network.batches[b];
    const Excitation& one = seen.excitations[b];
    FittedBatch& told = result.emplace_back();
    told.batch = own.name;
    std::vector<Index> room(own.ambient_K.size(), -1), start(own.start_K.size(), -1);
    for (Index j = 0; j < slopes.size(); ++j) {
      const Parameter& parameter = fit.parameter(j);
      if (!parameter.of_batch() || parameter.item != b) continue;
      (parameter.kind == Parameter::Kind::batch_start ? start : room)[parameter.part] = j;
    }
    for (std::size_t i = 0; i < start.size(); ++i) {
      FittedNumber number{one.start_degC(static_cast<Index>(i)) + own.start_K[i], 0};
      const std::vector<Index>& sensors = one.start_sensors[i];
      for (const Index s : sensors)
        number.value -= network.sensors[static_cast<std::size_t>(s)].offset_K / static_cast<double>(sensors.size());
      if (start[i] >= 0) number.standard_error = slopes(start[i]) * std::sqrt(covariance(start[i], start[i]));
      told.start_degC.push_back(number);
    }
    told.room = !room.empty();
    if (!told.room) continue;
    const auto combined = [&](auto weight) {
      FittedNumber number;
      double variance = 0;
      for (std::size_t i = 0; i < room.size(); ++i) {
        number.value += weight(i) * own.ambient_K[i];
        for (std::size_t j = 0; j < room.size(); ++j)
          if (room[i] >= 0 && room[j] >= 0)
            variance += weight(i) * weight(j) * slopes(room[i]) * slopes(room[j]) * covariance(room[i], room[j]);
      }
      number.standard_error = std::sqrt(variance);
      return number;
    };
    told.room_degC = combined([](std::size_t k) { return k == 0 ? 1. : 0.; });
    told.room_degC.value += one.ambient_degC(0);
    told.room_drift_K = combined([](std::size_t k) { return room_shape(k, 1) - room_shape(k, 0); });
  }
  return result;
}

THERMFIT_COMPILED_TEMPLATE(std::vector<FittedBatch> fitted_batches<double>(const MapFit&, const MachineRecord&));

}  // namespace thermfit
