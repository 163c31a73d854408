#pragma once

/// What is told without being named: parts of the cause, and the best account where it falls short of evidence.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "thermfit/diagnosis/judgement/proof.hpp"

namespace thermfit {

/// What stands beside the names, or in their place.
struct Suspicions {
  std::vector<FoundEffect> parts;      ///< acts beyond doubt, more remains; at most one
  std::vector<FoundEffect> suspected;  ///< the best account; at most one
  double doubt = 1;  ///< what is left of the probability of a part of the cause where its place is in doubt, 0…1
};

/// What may be told where `naming` names nothing, or its names have no `proof`.
///
/// A part of the cause has evidence beyond doubt and closes most of the gap on batches not used for fitting, surely
/// some of it: something acts there with that driver, while a law of another shape or a second cause leaves the rest.
/// All else is suspected; a machine that lacks nothing gains a few tens of nats too, and a true effect that is not
/// named hardly more. Neither is more probable than not. Allocates.
template <typename Scalar = double>
Suspicions suspicions_of(const SearchContext& context, const SearchResult& found, const Naming& naming, Proof proof,
                         const Thresholds& thresholds, std::uint64_t seed) {
  Suspicions result;
  if (found.single.empty()) return result;
  const Account& leader = found.single.front();
  const double gain = leader.fit.log_evidence - found.calibrated.fit.log_evidence;
  if (!(gain > 0)) return result;
  GapResiduals levels;
  levels.calibrated = found.calibrated.held.residual;
  levels.with_effect = leader.held.residual;
  const Closure closure = detail::closure_by<Scalar>(context, found.calibrated, leader, thresholds);
  const bool machine = context.library.at(leader.effects[0].effect).stage() != Stage::measurement;
  const bool part = naming.real && naming.odds > thresholds.beyond_doubt && closure.share > thresholds.part &&
                    proof != Proof::harms &&
                    !(machine && harms_displacements<Scalar>(found.seen, levels, thresholds)) && !found.folds.empty() &&
                    shrinks_somewhere<Scalar>(found.seen, levels.calibrated, levels.with_effect, thresholds, seed);
  const double known = logistic(thresholds.suspected_from + thresholds.suspected_by_gain * std::log1p(gain) -
                                thresholds.suspected_by_left * std::log1p(closure.left));
  FoundEffect one = detail::found_with_rivals<Scalar>(
      context, found.single, marginals(found.single, probabilities(found.single), "", thresholds.listed),
      part ? 0.5 : std::min(0.5, known), thresholds);
  one.closes = closure.share;
  if (part) {
    result.doubt = std::min(1.0, known / 0.5);
    result.parts.push_back(std::move(one));
  } else if (one.confidence >= thresholds.least_suspected) {
    result.suspected.push_back(std::move(one));
  }
  return result;
}

/// Further effects beside those named: the second of the best pair, short of what a name takes.
template <typename Scalar = double>
std::vector<FoundEffect> suspected_beside(const SearchContext& context, const SearchResult& found,
                                          const std::vector<FoundEffect>& named, const Thresholds& thresholds) {
  if (named.size() != 1 || found.several.empty()) return {};
  const double second = std::min(0.5, detail::probability_of_second<Scalar>(context, found, thresholds));
  if (second < thresholds.least_suspected) return {};
  const std::vector<ThermalNetwork::AddedEffect>& pair = found.several.front().effects;
  for (std::size_t k = 0; k < pair.size(); ++k) {
    if (pair[k].effect == named[0].effect && pair[k].location == named[0].location) continue;
    if (pair[1 - k].effect != named[0].effect) continue;
    FoundEffect one = detail::found_in<Scalar>(context, found.several.front(), k, second);
    one.closes = detail::closure_by<Scalar>(context, found.single.front(), found.several.front(), thresholds).share;
    return {std::move(one)};
  }
  return {};
}

}  // namespace thermfit
