#pragma once

/// Effects at places weighed by the evidence of their traces.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/diagnosis/outputs/output_thresholds.hpp"
#include "thermfit/diagnosis/outputs/scan.hpp"

namespace thermfit {

/// The traces of all effects and what each is worth, strongest first.
struct OutputScan {
  std::vector<OutputTrace> traces;  ///< in the order of the library
  std::vector<TraceScore> scores;   ///< largest gain first

  /// The trace that was scored.
  const OutputTrace& trace_of(const TraceScore& score) const { return traces[score.trace]; }
};

/// The best variant of an effect at a place.
struct Suspect {
  const TraceScore* score = nullptr;  ///< of the scan
  std::string effect;                 ///< name in the library
  std::string location;               ///< where the trace lies, location_of()
  std::string driver;                 ///< empty where the effect has none
  double gain = 0;                    ///< nats, in the channels that are asked for
  double probability = 0;             ///< beside the other suspects and none
};

/// Where a trace lies: its own location, else the thermometer in which it shows most.
inline std::string location_of(const OutputScan& scan, const TraceScore& score, const PairedCampaign& campaign) {
  const OutputTrace& trace = scan.trace_of(score);
  if (!trace.location.empty()) return trace.location;
  const ChannelScore* strongest = strongest_sensor(score, campaign.temperatures);
  return strongest ? campaign.channels[static_cast<std::size_t>(strongest->channel)] : "";
}

namespace detail {

/// Shares the probability: of an account e^(gain / softness), of none e^(decisive / softness).
inline void weigh(std::vector<Suspect>& suspects, const OutputThresholds& thresholds) {
  if (suspects.empty()) return;
  double best = suspects[0].gain;
  for (const Suspect& one : suspects) best = std::max(best, one.gain);
  const double softness = std::max(thresholds.least_softness_nats, thresholds.softness_share * best);
  double sum = std::exp(std::min(0., (thresholds.decisive_nats - best) / softness));
  for (Suspect& one : suspects) sum += one.probability = std::exp((one.gain - best) / softness);
  for (Suspect& one : suspects) one.probability *= thresholds.most_certain / sum;
}

}  // namespace detail

/// Every plausible effect at every place at its best, strongest first.
inline std::vector<Suspect> suspects_of(const OutputScan& scan, const PairedCampaign& campaign,
                                        const OutputThresholds& thresholds) {
  std::vector<Suspect> found;
  for (const TraceScore& score : scan.scores) {
    if (score.implausible) continue;
    const OutputTrace& trace = scan.trace_of(score);
    const std::string location = location_of(scan, score, campaign);
    const bool known = std::any_of(found.begin(), found.end(), [&](const Suspect& one) {
      return one.effect == trace.effect && one.location == location && one.driver == trace.driver;
    });
    if (!known) found.push_back({&score, trace.effect, location, trace.driver, score.gain, 0});
  }
  detail::weigh(found, thresholds);
  return found;
}

/// Effects by what they are worth in one channel, each at its best there; most probable first.
template <typename Scalar = double>
std::vector<Suspect> suspects_in(Index own, const OutputScan& scan, const PairedCampaign& campaign,
                                 const OutputThresholds& thresholds) {
  std::vector<Suspect> found;
  for (const TraceScore& score : scan.scores)
    for (const ChannelScore& part : score.channels) {
      if (part.channel != own || score.implausible) continue;
      const OutputTrace& trace = scan.trace_of(score);
      const Suspect one{&score, trace.effect, location_of(scan, score, campaign), trace.driver, part.gain, 0};
      const auto known =
          std::find_if(found.begin(), found.end(), [&](const Suspect& other) { return other.effect == trace.effect; });
      if (known == found.end())
        found.push_back(one);
      else if (part.gain > known->gain)
        *known = one;
    }
  detail::weigh(found, thresholds);
  std::stable_sort(found.begin(), found.end(),
                   [](const Suspect& a, const Suspect& b) { return a.probability > b.probability; });
  return found;
}

}  // namespace thermfit
