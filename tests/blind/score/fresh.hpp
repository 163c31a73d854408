#pragma once

/// How far the gap shrinks on batches that neither the diagnosis nor the calibration has seen.

#include <cmath>

#include "thermfit/diagnosis/judgement/shrink.hpp"
#include "thermfit/effects/catalogue.hpp"
#include "thermfit/io/csv/reader.hpp"
#include "thermfit/io/json/machine.hpp"
#include "thermfit/network/simulate.hpp"

namespace blind {

/// Squares over all displacements of a machine file's errors on measured batches, um.
inline thermfit::BatchSquares errors_of(const std::string& machine, const std::vector<std::string>& batches) {
  const thermfit::EffectLibrary effects = thermfit::standard_effects();
  const thermfit::ThermalNetwork network = thermfit::read_machine(machine, effects);
  const thermfit::Campaign campaign = thermfit::read_campaign(batches).batches;
  const auto runs = thermfit::simulate(network, thermfit::excitations_of(network, campaign), effects);
  const auto count = static_cast<Eigen::Index>(campaign.size());
  thermfit::BatchSquares result{thermfit::Vector::Zero(count), thermfit::Vector::Zero(count)};
  for (std::size_t b = 0; b < campaign.size(); ++b)
    for (std::size_t d = 0; d < network.displacements.size(); ++d) {
      const auto column = campaign[b].errors.find(network.displacements[d].output);
      if (column < 0) continue;
      const auto simulated = runs[b].channels.col(static_cast<Eigen::Index>(network.sensors.size() + d));
      result.sum(static_cast<Eigen::Index>(b)) += (campaign[b].errors.values.col(column) - simulated).squaredNorm();
      result.count(static_cast<Eigen::Index>(b)) += static_cast<double>(simulated.size());
    }
  return result;
}

/// A shrink in percent, with the interval that the batches it was measured on allow.
struct MeasuredShrink {
  double percent;
  thermfit::Interval interval;
};

inline MeasuredShrink measured_shrink(const thermfit::BatchSquares& before, const thermfit::BatchSquares& after) {
  return {thermfit::shrink_percent(before.rms(), after.rms()), thermfit::shrink_interval(before, after, 0.95, 1)};
}

/// Whether two measurements of one shrink differ by no more than both intervals, combined, allow.
inline bool agree(const MeasuredShrink& a, const MeasuredShrink& b) {
  const MeasuredShrink &low = a.percent < b.percent ? a : b, &high = a.percent < b.percent ? b : a;
  return high.percent - low.percent <= std::hypot(low.interval.high - low.percent, high.percent - high.interval.low);
}

}  // namespace blind
