#pragma once

/// No effect is named that has not shown, on batches it has not seen, that the gap shrinks with it.

#include <algorithm>
#include <cmath>

#include "thermfit/diagnosis/judgement/gap_levels.hpp"
#include "thermfit/diagnosis/judgement/judge.hpp"

namespace thermfit {

/// Whether the gap of some channel shrinks for sure and by something worth a name: the 95 % interval lies above 0, and
/// a fifth of the gap is gone or two fifths may be. An offset counts against the machine as given, since calibration
/// moves offsets too.
inline bool shrinks_somewhere(const MachineRecord& seen, const GapResiduals& stages, bool offset, std::uint64_t seed) {
  const ChannelResiduals& stage = offset ? stages.as_simulated : stages.calibrated;
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    const BatchSquares before = squares_of(seen, stage, {c}), after = squares_of(seen, stages.with_effect, {c});
    const Interval interval = shrink_interval(before, after, 0.95, seed);
    if (interval.low > 0 && (shrink_percent(before.rms(), after.rms()) > 20 || interval.high > 40)) return true;
  }
  return false;
}

/// Whether displacements are further off with the effects than without, by more than a hundredth of the gap.
inline bool harms_displacements(const MachineRecord& seen, const GapResiduals& stages) {
  double log_ratio = 0;
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    if (!seen.channels[c].displacement) continue;
    const double before = squares_of(seen, stages.calibrated, {c}).rms();
    const double after = squares_of(seen, stages.with_effect, {c}).rms();
    if (before > 0 && after > 0) log_ratio += std::log(after / before);
  }
  return log_ratio > 0.01;
}

/// Takes back what held-out batches do not bear out. With fewer than three, what fits best is a suspicion: `ambiguous`,
/// at most even odds. With some, but no channel that shrinks beyond doubt: nothing is named, unless the evidence is
/// overwhelming, as it is where calibration hides an effect in parameters that cost it much. Nor is something that acts
/// on the machine, not on a reading, and brings temperatures closer at the cost of displacements. `stages` are the
/// residuals with what `judgement` names; they follow it.
inline void demand_proof(Judgement& judgement, GapResiduals& stages, const SearchResult& found,
                         const EffectLibrary& library, const JudgingOptions& options, std::uint64_t seed) {
  if (judgement.effects.empty()) return;
  const auto some = [&](auto&& is_it) {
    return std::any_of(judgement.effects.begin(), judgement.effects.end(), is_it);
  };
  const bool offset = some([](const FoundEffect& one) { return one.effect == "sensor-offset"; });
  const bool machine =
      some([&](const FoundEffect& one) { return library.at(one.effect).stage() != Stage::measurement; });
  if (found.folds.size() < 3) {
    judgement.verdict = Verdict::ambiguous;
    for (FoundEffect& one : judgement.effects) one.confidence = std::min(one.confidence, 0.5);
    if (found.folds.empty()) return;
  }
  const bool harms = machine && harms_displacements(found.seen, stages);
  if (!harms && (judgement.odds > options.beyond_doubt || shrinks_somewhere(found.seen, stages, offset, seed))) return;
  judgement.effects.clear();
  judgement.best = &found.calibrated;
  stages.with_effect = stages.calibrated;
  const bool real = harms || gap_is_real(found.seen, found.calibrated.held.residual, options);
  judgement.verdict = real ? Verdict::unknown : verdict_of_calibration(found, options);
}

}  // namespace thermfit
