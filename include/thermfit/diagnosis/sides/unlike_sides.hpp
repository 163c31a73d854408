#pragma once

/// What a diagnosis says where its two sides are not written down alike: that, and no effect.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/leading_channel.hpp"
#include "thermfit/diagnosis/sides/side_channel.hpp"
#include "thermfit/statistics/rms.hpp"

namespace thermfit {

/// Whether something is certainly wrong between the sides, so that no effect may be named on top of it. Another zero is
/// not: it is left free.
inline bool sides_unlike(const std::vector<DataProblem>& problems) {
  return std::any_of(problems.begin(), problems.end(),
                     [](const DataProblem& one) { return one.certain && one.kind != DataProblem::Kind::datum; });
}

/// The diagnosis of such sides: no effect, the gap as it stands, certain problems first. Allocates.
template <typename Scalar = double>
Diagnosis diagnosis_of_unlike_sides(const Sides& sides, std::vector<DataProblem> problems) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  Diagnosis result;
  result.batches = sides.batches;
  result.unlike_sides = true;
  std::vector<double> rms;
  for (const SideChannel& one : sides.channels) {
    SeriesByBatch gap;
    for (std::size_t b = 0; b < one.measured.size(); ++b) {
      const VectorX<Scalar>&measured = one.measured[b], &simulated = one.simulated[b];
      gap.push_back(measured - simulated);
    }
    rms.push_back(rms_of(gap));
    result.gap.per_sensor.push_back(
        {one.name, one.displacement ? "um" : "K", {rms.back(), unknown, unknown, one.noise}});
  }
  if (!sides.channels.empty()) {
    const std::size_t told = leading_channel(
        sides.channels.size(), [&](std::size_t c) { return sides.channels[c].displacement; },
        [&](std::size_t c) { return rms[c]; });
    result.gap.output = sides.channels[told].name;
    result.gap.unit = sides.channels[told].displacement ? "um" : "K";
    result.gap.rms = result.gap.per_sensor[told].rms;
  }
  result.gap.shrink_percent = result.gap.shrink_of_explainable_percent = unknown;
  result.gap.shrink_ci95_percent = {unknown, unknown};
  result.gap.held_out = false;
  result.remaining.unexplained = unknown;
  std::stable_partition(problems.begin(), problems.end(), [](const DataProblem& one) { return one.certain; });
  result.data_problems = std::move(problems);
  return result;
}

}  // namespace thermfit
