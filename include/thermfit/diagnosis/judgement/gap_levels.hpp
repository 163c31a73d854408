#pragma once

/// The gap of a campaign level by level: as simulated, calibrated, with effect, noise.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "thermfit/calibration/linearized.hpp"
#include "thermfit/calibration/repeats.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/judgement/shrink.hpp"
#include "thermfit/statistics/reading_step.hpp"
#include "thermfit/statistics/white_noise.hpp"

namespace thermfit {

/// Residuals of the levels, held out where the batches allow, and the noise of each channel.
struct GapResiduals {
  ChannelResiduals as_simulated;  ///< of the machine as given
  ChannelResiduals calibrated;    ///< its parameters moved
  ChannelResiduals with_effect;   ///< and what is named added
  Vector noise;                   ///< by channel, in its unit
};

/// The noise of each channel: from repeats, else from the high-frequency part of what the best account leaves; never
/// less than the readings' resolution adds. Allocates the result.
template <typename Scalar = double>
VectorX<Scalar> noise_floor(const MachineRecord& seen, const ChannelResiduals& best) {
  VectorX<Scalar> result(static_cast<Index>(seen.channels.size()));
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    const double repeats = repeat_sd(seen.excitations, seen.channels[c].measured);
    const double changes = repeats > 0 ? repeats : white_noise(best[c]);
    result(static_cast<Index>(c)) = std::max(changes, resolution_sd(seen.channels[c].measured));
  }
  return result;
}

/// Squares by batch of the channels `of`, all together; missing samples (NaN) are left out. Allocates the result.
template <typename Scalar = double>
BatchSquares squares_of(const MachineRecord& seen, const ChannelResiduals& residual,
                        const std::vector<std::size_t>& of) {
  const Index batches = static_cast<Index>(seen.batches());
  BatchSquares result{VectorX<Scalar>::Zero(batches), VectorX<Scalar>::Zero(batches)};
  for (const std::size_t c : of)
    for (std::size_t b = 0; b < seen.batches(); ++b)
      for (Index k = 0; k < residual[c][b].size(); ++k)
        if (const double r = residual[c][b](k); !std::isnan(r)) {
          result.sum(static_cast<Index>(b)) += r * r;
          ++result.count(static_cast<Index>(b));
        }
  return result;
}

/// The channels that a gap is told for: the first displacement; all temperatures together where there is none.
inline std::vector<std::size_t> told_channels(const MachineRecord& seen) {
  std::vector<std::size_t> all;
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    if (seen.channels[c].displacement) return {c};
    all.push_back(c);
  }
  return all;
}

/// The gap by level, batch and channel. `seed` draws the batches behind the interval of the shrink. Allocates.
template <typename Scalar = double>
Gap gap_of(const MachineRecord& seen, const GapResiduals& levels, std::uint64_t seed, bool held_out) {
  const std::vector<std::size_t> told = told_channels(seen);
  Gap gap;
  const bool displacement = seen.channels[told[0]].displacement;
  if (displacement) gap.output = seen.channels[told[0]].name;
  gap.unit = displacement ? "um" : "K";
  const auto noise_over = [&](const std::vector<std::size_t>& channels) {
    double sum = 0;
    for (const std::size_t c : channels)
      sum += levels.noise(static_cast<Index>(c)) * levels.noise(static_cast<Index>(c));
    return std::sqrt(sum / static_cast<double>(channels.size()));
  };
  const auto levels_of = [&](const std::vector<std::size_t>& channels) {
    return GapLevels{squares_of<Scalar>(seen, levels.as_simulated, channels).rms(),
                     squares_of<Scalar>(seen, levels.calibrated, channels).rms(),
                     squares_of<Scalar>(seen, levels.with_effect, channels).rms(), noise_over(channels)};
  };
  gap.rms = levels_of(told);
  gap.held_out = held_out;
  const BatchSquares given = squares_of<Scalar>(seen, levels.as_simulated, told),
                     before = squares_of<Scalar>(seen, levels.calibrated, told),
                     after = squares_of<Scalar>(seen, levels.with_effect, told);
  gap.shrink_percent = shrink_percent(gap.rms.calibrated, gap.rms.with_effect);
  gap.shrink_ci95_percent = shrink_interval<Scalar>(before, after, 0.95, seed);
  gap.shrink_of_explainable_percent =
      shrink_of_explainable_percent(gap.rms.calibrated, gap.rms.with_effect, gap.rms.noise);
  for (std::size_t b = 0; b < seen.batches(); ++b) {
    const Index i = static_cast<Index>(b);
    gap.per_batch.push_back({seen.names[b], {given.rms(i), before.rms(i), after.rms(i), gap.rms.noise}});
  }
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    gap.per_sensor.push_back({seen.channels[c].name, seen.channels[c].displacement ? "um" : "K", levels_of({c})});
  return gap;
}

}  // namespace thermfit
