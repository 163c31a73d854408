#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/calibration/repeats.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/judgement/shrink.hpp"
#include "thermfit/diagnosis/search/account.hpp"
#include "thermfit/statistics/reading_step.hpp"

namespace thermfit {

/// Residuals of the four stages: as simulated, calibrated, with effect (all held out), and the noise of each channel.
struct GapResiduals {
  ChannelResiduals as_simulated, calibrated, with_effect;
  Vector noise;  ///< by channel
};

/// The noise of each channel: from repeats, else from the high-frequency part of what the best account leaves; never
/// less than the readings' resolution adds.
inline Vector noise_floor(const MachineRecord& seen, const ChannelResiduals& best) {
  Vector result(static_cast<Index>(seen.channels.size()));
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    const double repeats = repeat_sd(seen.excitations, seen.channels[c].measured);
    const double changes = repeats > 0 ? repeats : high_frequency_sd(best[c]);
    result(static_cast<Index>(c)) = std::max(changes, resolution_sd(seen.channels[c].measured));
  }
  return result;
}

/// Squares by batch of the channels of one kind: `displacement`, or all temperatures together.
inline BatchSquares squares_of(const MachineRecord& seen, const ChannelResiduals& residual,
                               const std::vector<std::size_t>& of) {
  BatchSquares result{Vector::Zero(static_cast<Index>(seen.batches())),
                      Vector::Zero(static_cast<Index>(seen.batches()))};
  for (const std::size_t c : of)
    for (std::size_t b = 0; b < seen.batches(); ++b)
      for (Index k = 0; k < residual[c][b].size(); ++k)
        if (const double r = residual[c][b](k); !std::isnan(r)) {
          result.sum(static_cast<Index>(b)) += r * r;
          ++result.count(static_cast<Index>(b));
        }
  return result;
}

/// The gap of a campaign in the first displacement (or all temperatures, where there is none), by stage, batch and
/// channel.
inline Gap gap_of(const MachineRecord& seen, const GapResiduals& stages, std::uint64_t seed, bool held_out) {
  std::vector<std::size_t> of;
  for (std::size_t c = 0; c < seen.channels.size() && of.empty(); ++c)
    if (seen.channels[c].displacement) of = {c};
  Gap gap;
  gap.output = of.empty() ? "temperatures" : seen.channels[of[0]].name;
  gap.unit = of.empty() ? "K" : "um";
  if (of.empty())
    for (std::size_t c = 0; c < seen.channels.size(); ++c) of.push_back(c);
  const auto noise_over = [&](const std::vector<std::size_t>& channels) {
    double sum = 0;
    for (const std::size_t c : channels)
      sum += stages.noise(static_cast<Index>(c)) * stages.noise(static_cast<Index>(c));
    return std::sqrt(sum / static_cast<double>(channels.size()));
  };
  const auto staged = [&](const std::vector<std::size_t>& channels) {
    return GapLevels{squares_of(seen, stages.as_simulated, channels).rms(),
                     squares_of(seen, stages.calibrated, channels).rms(),
                     squares_of(seen, stages.with_effect, channels).rms(), noise_over(channels)};
  };
  gap.rms = staged(of);
  gap.held_out = held_out;
  const BatchSquares given = squares_of(seen, stages.as_simulated, of),
                     before = squares_of(seen, stages.calibrated, of), after = squares_of(seen, stages.with_effect, of);
  gap.shrink_percent = shrink_percent(gap.rms.calibrated, gap.rms.with_effect);
  gap.shrink_ci95_percent = shrink_interval(before, after, 0.95, seed);
  gap.shrink_of_explainable_percent =
      shrink_of_explainable_percent(gap.rms.calibrated, gap.rms.with_effect, gap.rms.noise);
  for (std::size_t b = 0; b < seen.batches(); ++b) {
    const Index i = static_cast<Index>(b);
    gap.per_batch.push_back({seen.names[b], {given.rms(i), before.rms(i), after.rms(i), gap.rms.noise}});
  }
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    gap.per_sensor.push_back({seen.channels[c].name, seen.channels[c].displacement ? "um" : "K", staged({c})});
  return gap;
}

}  // namespace thermfit
