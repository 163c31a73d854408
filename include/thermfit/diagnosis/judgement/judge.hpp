#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/judgement/suspicion.hpp"

namespace thermfit {

/// The verdict with what it rests on.
struct Judgement {
  Verdict verdict = Verdict::unknown;  ///< `effect` or `ambiguous` where something is named
  std::vector<FoundEffect> effects;    ///< empty for none, miscalibration and unknown
  Suspicions suspicions;               ///< what is told without a name
  AccountIndex best;                   ///< the account behind `effects`; calibration alone where there are none
  AccountIndex nearest;                ///< the best account tried, named or not
  Support support;                     ///< of `nearest`
  GapResiduals levels;                 ///< residuals as simulated, calibrated, with what is named
};

/// `none` or `miscalibration`, where there is no effect: calibration was needed when it closes most of what is left
/// once the sensors sit where they sit. What lumping leaves, it does not. Allocates.
template <typename Scalar = double>
Verdict verdict_of_calibration(const SearchResult& found, const Thresholds& thresholds) {
  const ChannelResiduals& calibrated = found.calibrated.held.residual;
  const double placed =
      excess_of(misfit_of<Scalar>(found.seen, found.placed.residual.empty() ? calibrated : found.placed.residual));
  const double left = excess_of(misfit_of<Scalar>(found.seen, calibrated));
  const bool needed = placed > thresholds.least_excess && left < (1 - thresholds.calibration_helps) * placed;
  return needed ? Verdict::miscalibration : Verdict::none;
}

/// From what was tried to a verdict: what the evidence names, asked for proof on batches it has not seen. The one place
/// where a verdict is decided. A suspicion has at most even odds. `seed` draws the batches of the proof. Allocates.
template <typename Scalar = double>
Judgement judge(const SearchContext& context, const SearchResult& found, const Thresholds& thresholds,
                std::uint64_t seed) {
  Naming naming = named_by_evidence<Scalar>(context, found, thresholds);
  Judgement result;
  result.nearest = naming.nearest;
  result.support = naming.support;
  result.levels.as_simulated = found.as_given;
  result.levels.calibrated = found.calibrated.held.residual;
  result.levels.with_effect = found.at(naming.best).held.residual;
  result.levels.noise = noise_floor<Scalar>(found.seen, found.at(naming.nearest).held.residual);

  const bool named = !naming.effects.empty();
  const Proof proof = proof_of<Scalar>(naming, result.levels, found, context.library, thresholds, seed);
  if (named && (proof == Proof::given || proof == Proof::suspicion)) {
    result.best = naming.best;
    result.effects = std::move(naming.effects);
    if (proof == Proof::suspicion)
      for (FoundEffect& one : result.effects) one.confidence = std::min(one.confidence, 0.5);
    const bool rivals = std::any_of(result.effects.begin(), result.effects.end(),
                                    [](const FoundEffect& one) { return !one.alternatives.empty(); });
    result.verdict = proof == Proof::suspicion || rivals ? Verdict::ambiguous : Verdict::effect;
    result.suspicions.suspected = suspected_beside<Scalar>(context, found, result.effects, thresholds);
    return result;
  }
  result.levels.with_effect = result.levels.calibrated;
  result.suspicions = suspicions_of<Scalar>(context, found, naming, proof, thresholds, seed);
  const bool unexplained = naming.real || proof == Proof::harms || (!named && naming.odds >= 0);
  result.verdict = unexplained ? Verdict::unknown : verdict_of_calibration<Scalar>(found, thresholds);
  return result;
}

THERMFIT_COMPILED_TEMPLATE(Judgement judge<double>(const SearchContext&, const SearchResult&, const Thresholds&,
                                                   std::uint64_t));

}  // namespace thermfit
