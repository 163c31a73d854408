#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/gap/diagnosis.hpp"
#include "thermfit/gap/posterior.hpp"

namespace thermfit {

/// The verdict with what it rests on.
struct Judgement {
  Verdict verdict = Verdict::unknown;
  std::vector<FoundEffect> effects;      ///< empty for none, miscalibration and unknown
  const Explanation* best = nullptr;     ///< the account behind `effects`; calibration alone where there are none
  const Explanation* nearest = nullptr;  ///< the best account tried, named or not
  double closed_share = 0;               ///< of the excess of calibration alone, by `nearest`
};

namespace detail {

inline std::vector<Estimate> estimates(const Inquiry& inquiry, const Explanation& account, std::size_t position) {
  const MapFit& fit = account.fit;
  const Index n = fit.t.size();
  const Matrix covariance = (fit.total().information + Matrix::Identity(n, n)).llt().solve(Matrix::Identity(n, n));
  const std::size_t own = inquiry.machine.effects.size() + position;
  const ThermalNetwork fitted = fit.network();
  const ThermalNetwork::AddedEffect& added = fitted.effects[own];
  const std::vector<EffectParameter> law = inquiry.library.at(added.effect).parameters(fitted, added);
  std::vector<Estimate> result;
  for (std::size_t k = 0; k < law.size(); ++k) {
    Estimate one{law[k].name, law[k].unit, added.value(law[k].name), law[k].fixed ? 0.0 : -1.0};
    for (Index j = 0; j < n; ++j) {
      const Parameter& parameter = fit.parameter(j);
      if (parameter.kind != Parameter::Kind::effect || parameter.item != own || parameter.part != k) continue;
      // Less than a tenth of the prior's variance gone: the data do not pin it.
      if (covariance(j, j) < 0.9)
        one.standard_error = std::abs(parameter.slope(fit.t(j))) * std::sqrt(covariance(j, j));
    }
    result.push_back(std::move(one));
  }
  return result;
}

/// Entry for effect `position` of the best account, with rivals that could take its part.
inline FoundEffect found_effect(const Inquiry& inquiry, const std::vector<Explanation>& accounts,
                                const std::vector<Marginal>& ranked, double known, const JudgingOptions& options) {
  const Marginal& first = ranked.front();
  const Explanation& account = accounts[first.leader];
  const ThermalNetwork::AddedEffect& added = account.effects[first.position];
  FoundEffect result;
  result.effect = added.effect;
  result.location = added.location;
  result.driver = added.driver;
  result.confidence = known * first.probability;
  result.parameters = estimates(inquiry, account, first.position);
  result.same_place.assign(first.places.begin() + 1, first.places.end());
  for (std::size_t i = 1; i < ranked.size(); ++i) {
    if (known * ranked[i].probability < options.listed) continue;
    const ThermalNetwork::AddedEffect& rival = accounts[ranked[i].leader].effects[ranked[i].position];
    result.alternatives.push_back({rival.effect, rival.location, rival.driver, known * ranked[i].probability});
  }
  return result;
}

/// A thermometer whose offset is beyond its tolerance: log odds of a fault against the tail of the tolerance.
inline const Explanation* faulty_offset(const Investigation& found, double least_odds) {
  const Explanation* result = nullptr;
  double best = least_odds;
  for (const Explanation& one : found.single) {
    if (one.effects[0].effect != "sensor-offset") continue;
    const double odds = one.fit.log_evidence - found.calibrated.fit.log_evidence -
                        std::log(static_cast<double>(std::max<std::size_t>(1, found.seen.channels.size())));
    if (odds > best) best = odds, result = &one;
  }
  return result;
}

}  // namespace detail

/// From what was tried to a verdict.
///
/// A gap is real when its held-out excess is more than a right machine leaves, or when an effect explains far better
/// what calibration only absorbs, both in evidence and in held-out score. It is explained when the best account closes
/// most of that excess on batches it has not seen; accounts share the probability by their held-out scores. A second
/// effect is named only when it closes most of what the first leaves.
inline Judgement judge(const Inquiry& inquiry, const Investigation& found, const JudgingOptions& options = {}) {
  Judgement result;
  result.best = result.nearest = &found.calibrated;
  const double before = excess_of(misfit_of(found.seen, found.calibrated.held.residual));
  const double placed =
      found.placed.residual.empty() ? before : excess_of(misfit_of(found.seen, found.placed.residual));
  const double gain = found.single.empty()
                          ? 0
                          : std::min(found.single[0].held.log_score - found.calibrated.held.log_score,
                                     found.single[0].fit.log_evidence - found.calibrated.fit.log_evidence);
  if (before <= options.least_excess && gain < options.least_gain) {
    if (const Explanation* offset = detail::faulty_offset(found, options.offset_odds)) {
      const double odds = std::exp(offset->fit.log_evidence - found.calibrated.fit.log_evidence -
                                   std::log(static_cast<double>(found.seen.channels.size())));
      FoundEffect one;
      one.effect = "sensor-offset";
      one.location = offset->effects[0].location;
      one.confidence = odds / (1 + odds);
      one.parameters = detail::estimates(inquiry, *offset, 0);
      result.effects = {one};
      result.verdict = Verdict::effect;
      result.best = result.nearest = offset;
      result.closed_share = 1;
      return result;
    }
    result.verdict = placed <= options.least_excess ? Verdict::none : Verdict::miscalibration;
    return result;
  }
  if (found.single.empty()) return result;

  const auto excess = [&](const Explanation& one) { return excess_of(misfit_of(found.seen, one.held.residual)); };
  const Explanation& single = found.single.front();
  const double after_one = excess(single);
  bool two = false;
  if (!found.several.empty() && after_one > options.least_excess) {
    const Explanation& pair = found.several.front();
    const double gained = pair.held.log_score - single.held.log_score;
    two = options.score_power * gained > options.offset_odds && excess(pair) < (1 - options.second_closes) * after_one;
  }
  const std::vector<Explanation>& accounts = two ? found.several : found.single;
  const double after = excess(accounts.front());
  result.nearest = &accounts.front();
  result.closed_share = before > options.least_excess ? 1 - after / before : 1;
  const double known = probability_known(result.closed_share, options);
  const std::vector<double> weight = probabilities(accounts, options.score_power);
  if (known < 0.5) return result;

  const std::vector<ThermalNetwork::AddedEffect>& leading = accounts.front().effects;
  if (!two) {
    result.effects = {
        detail::found_effect(inquiry, accounts, marginals(accounts, weight, "", options.listed), known, options)};
  } else if (leading[0].effect == leading[1].effect && leading[0].driver == leading[1].driver) {
    // One effect, stronger in one part of the machine than in another: its place is both parts.
    FoundEffect one{
        leading[0].effect, leading[0].location + "+" + leading[1].location, leading[0].driver, known, {}, {}, {}};
    one.parameters = detail::estimates(inquiry, accounts.front(), 0);
    result.effects = {std::move(one)};
  } else {
    // Each of the pair with what could take its part beside the other.
    for (const auto& other : {leading[1], leading[0]}) {
      std::vector<double> share(accounts.size(), 0.0);
      for (std::size_t i = 0; i < accounts.size(); ++i)
        for (const auto& one : accounts[i].effects)
          if (one.effect == other.effect) share[i] = weight[i];
      double sum = 0;
      for (const double one : share) sum += one;
      for (double& one : share) one /= sum;
      result.effects.push_back(detail::found_effect(
          inquiry, accounts, marginals(accounts, share, other.effect, options.listed), known, options));
    }
  }
  result.best = &accounts.front();
  const bool rivals = std::any_of(result.effects.begin(), result.effects.end(),
                                  [](const FoundEffect& one) { return !one.alternatives.empty(); });
  result.verdict = rivals ? Verdict::ambiguous : Verdict::effect;
  return result;
}

}  // namespace thermfit
