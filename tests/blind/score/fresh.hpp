#pragma once

/// How far the gap shrinks on batches that neither the diagnosis nor the calibration has seen.

#include <cmath>

#include "thermfit/effects/catalogue.hpp"
#include "thermfit/io/csv_reader.hpp"
#include "thermfit/io/machine_json.hpp"
#include "thermfit/network/simulate.hpp"

namespace blind {

/// rms over all displacements of a machine file's prediction for measured batches, um.
inline double gap_um(const std::string& machine, const std::vector<std::string>& batches) {
  const thermfit::EffectLibrary effects = thermfit::standard_effects();
  const thermfit::ThermalNetwork network = thermfit::read_machine(machine, effects);
  const thermfit::Campaign campaign = thermfit::read_campaign(batches).batches;
  const auto runs = thermfit::simulate(network, thermfit::excitations_of(network, campaign), effects);
  double square = 0, count = 0;
  for (std::size_t b = 0; b < campaign.size(); ++b)
    for (std::size_t d = 0; d < network.displacements.size(); ++d) {
      const auto column = campaign[b].errors.find(network.displacements[d].output);
      if (column < 0) continue;
      const auto simulated = runs[b].channels.col(static_cast<Eigen::Index>(network.sensors.size() + d));
      square += (campaign[b].errors.values.col(column) - simulated).squaredNorm();
      count += static_cast<double>(simulated.size());
    }
  return count > 0 ? std::sqrt(square / count) : NAN;
}

}  // namespace blind
