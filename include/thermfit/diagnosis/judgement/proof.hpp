#pragma once

/// No effect is named that has not shown, on batches it has not seen, that the gap shrinks with it.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "thermfit/diagnosis/judgement/gap_levels.hpp"
#include "thermfit/diagnosis/judgement/naming.hpp"

namespace thermfit {

/// How far held-out batches bear out what the evidence names.
enum class Proof {
  given,      ///< or not asked for
  suspicion,  ///< too few batches to prove anything
  lacking,    ///< no channel shrinks beyond doubt
  harms       ///< acts on the machine and brings temperatures closer at the cost of displacements
};

/// Whether the gap of some channel shrinks for sure and by something worth a name: the 95 % interval lies above 0, and
/// enough of the gap is gone or may be. `from` is what counts as the gap before. Allocates.
template <typename Scalar = double>
bool shrinks_somewhere(const MachineRecord& seen, const ChannelResiduals& from, const ChannelResiduals& to,
                       const Thresholds& thresholds, std::uint64_t seed) {
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    const BatchSquares before = squares_of<Scalar>(seen, from, {c}), after = squares_of<Scalar>(seen, to, {c});
    const Interval interval = shrink_interval<Scalar>(before, after, 0.95, seed);
    if (interval.low > 0 && (shrink_percent(before.rms(), after.rms()) > thresholds.surely_shrinks ||
                             interval.high > thresholds.may_shrink))
      return true;
  }
  return false;
}

/// Whether displacements are further off with the effects than without, by more than a hundredth of the gap. Allocates.
template <typename Scalar = double>
bool harms_displacements(const MachineRecord& seen, const GapResiduals& levels, const Thresholds& thresholds) {
  double log_ratio = 0;
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    if (!seen.channels[c].displacement) continue;
    const double before = squares_of<Scalar>(seen, levels.calibrated, {c}).rms();
    const double after = squares_of<Scalar>(seen, levels.with_effect, {c}).rms();
    if (before > 0 && after > 0) log_ratio += std::log(after / before);
  }
  return log_ratio > thresholds.harm;
}

/// How far held-out batches bear out what `naming` names. With some, but no channel that shrinks beyond doubt, there is
/// no proof, unless the evidence is overwhelming, as it is where calibration hides an effect in parameters that cost it
/// much. An effect that calibration can imitate counts against the machine as given. `levels` are the residuals with
/// what is named. Allocates.
template <typename Scalar = double>
Proof proof_of(const Naming& naming, const GapResiduals& levels, const SearchResult& found,
               const EffectLibrary& library, const Thresholds& thresholds, std::uint64_t seed) {
  if (naming.effects.empty()) return Proof::given;
  if (found.folds.empty()) return Proof::suspicion;
  bool machine = false, against_as_given = false;
  for (const FoundEffect& one : naming.effects) {
    machine = machine || library.at(one.effect).stage() != Stage::measurement;
    against_as_given = against_as_given || one.against_as_given;
  }
  if (machine && harms_displacements<Scalar>(found.seen, levels, thresholds)) return Proof::harms;
  const ChannelResiduals& from = against_as_given ? levels.as_simulated : levels.calibrated;
  if (!(naming.odds > thresholds.beyond_doubt) &&
      !shrinks_somewhere<Scalar>(found.seen, from, levels.with_effect, thresholds, seed))
    return Proof::lacking;
  return found.folds.size() < thresholds.proving_folds ? Proof::suspicion : Proof::given;
}

}  // namespace thermfit
