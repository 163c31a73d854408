#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/judgement/posterior.hpp"

namespace thermfit {

/// The verdict with what it rests on.
struct Judgement {
  Verdict verdict = Verdict::unknown;
  std::vector<FoundEffect> effects;  ///< empty for none, miscalibration and unknown
  const Account* best = nullptr;     ///< the account behind `effects`; calibration alone where there are none
  const Account* nearest = nullptr;  ///< the best account tried, named or not
  Support grounds;                   ///< of `nearest`
  double odds = -INFINITY;           ///< log odds that there is an effect, by the evidence and the price of the search
};

namespace detail {

inline std::vector<Estimate> estimates(const SearchContext& inquiry, const Account& account, std::size_t position) {
  const MapFit& fit = account.fit;
  const Index n = fit.coordinates.size();
  const Matrix covariance = fit.covariance();
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
        one.standard_error = std::abs(parameter.slope(fit.coordinates(j))) * std::sqrt(covariance(j, j));
    }
    result.push_back(std::move(one));
  }
  return result;
}

/// What `account` closes of what `before` leaves.
inline Closure closure_by(const SearchContext& inquiry, const Account& before, const Account& account,
                          const JudgingOptions& options) {
  const bool moves_heat =
      std::any_of(account.effects.begin(), account.effects.end(), [&](const ThermalNetwork::AddedEffect& one) {
        const Stage stage = inquiry.library.at(one.effect).stage();
        return stage != Stage::expansion && stage != Stage::measurement;
      });
  return moves_heat ? closure_of_heat(inquiry.seen, before.held, account.held, options)
                    : closure_of(inquiry.seen, before.held, account.held);
}

inline Support grounds_of(const SearchContext& inquiry, const SearchResult& found, const Account& nearest,
                          const JudgingOptions& options) {
  Support result;
  result.candidates = found.screened.size();
  result.gain_nats = nearest.fit.log_evidence - found.calibrated.fit.log_evidence;
  for (const ThermalNetwork::AddedEffect& one : nearest.effects)
    result.nearest.push_back({one.effect, one.location, one.driver, 0});
  const Closure closure = closure_by(inquiry, found.calibrated, nearest, options);
  result.closes = closure.share;
  result.leaves = closure.left;
  return result;
}

/// Plausibility of the best account with this effect alone, wherever it acts.
inline double alone(const std::vector<Account>& single, const ThermalNetwork::AddedEffect& effect) {
  double result = -INFINITY;
  for (const Account& one : single)
    if (one.effects[0].effect == effect.effect && one.effects[0].driver == effect.driver)
      result = std::max(result, plausibility(one));
  return result;
}

/// Probability that the best account of two is right about its second effect: it must gain more than the search and the
/// form of the first one's law account for, and close what the first leaves as the first is asked to close the gap.
inline double probability_of_second(const SearchContext& inquiry, const SearchResult& found,
                                    const JudgingOptions& options) {
  const Account &single = found.single.front(), &pair = found.several.front();
  const double gained = plausibility(pair) - plausibility(single) - price_of_search(found.screened.size()) -
                        options.law_tolerance * (plausibility(single) - plausibility(found.calibrated));
  const Closure closure = closure_by(inquiry, single, pair, options);
  return logistic(gained) * probability_known(closure.share, closure.left, options);
}

/// Entry for effect `position` of the best account, with rivals that could take its part.
inline FoundEffect found_effect(const SearchContext& inquiry, const std::vector<Account>& accounts,
                                const std::vector<Marginal>& ranked, double known, const JudgingOptions& options) {
  const Marginal& first = ranked.front();
  const Account& account = accounts[first.leader];
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

/// The thermometer whose offset is least like a tolerance, and the log odds of a fault against it.
struct OffsetFault {
  Index sensor = -1;
  double odds = -INFINITY;
};

/// From the offset that the data alone ask for, m with variance v in units of the tolerance: log N(m; 0, v + 1 + r^2) /
/// N(m; 0, v + 1), r the prior size of a fault over the tolerance. No refit: an offset is linear.
inline OffsetFault offset_fault(const SearchContext& inquiry, const MapFit& fit) {
  OffsetFault result;
  const Index n = fit.coordinates.size();
  const Matrix covariance = fit.covariance();
  for (Index j = 0; j < n; ++j) {
    const Parameter& one = fit.parameter(j);
    if (one.kind != Parameter::Kind::sensor_offset || !(covariance(j, j) < 1)) continue;
    const double precision = 1 / covariance(j, j) - 1, asked = fit.coordinates(j) / (precision * covariance(j, j));
    ThermalNetwork::AddedEffect fault{"sensor-offset", inquiry.machine.sensors[one.item].column, "", {}};
    const double size = inquiry.library.at(fault.effect).parameters(inquiry.machine, fault)[0].sd / one.sd;
    const double tolerated = 1 / precision + 1, faulty = tolerated + size * size;
    const double odds = 0.5 * (std::log(tolerated / faulty) + asked * asked * (1 / tolerated - 1 / faulty));
    if (odds > result.odds) result = {static_cast<Index>(one.item), odds};
  }
  return result;
}

/// Names a faulty offset where the data and the number of thermometers and effects allow.
inline bool name_offset(const SearchContext& inquiry, const SearchResult& found, Judgement& result) {
  const OffsetFault fault = offset_fault(inquiry, found.calibrated.fit);
  if (fault.sensor < 0) return false;
  const std::string& column = inquiry.machine.sensors[static_cast<std::size_t>(fault.sensor)].column;
  const auto account = std::find_if(found.single.begin(), found.single.end(), [&](const Account& one) {
    return one.effects[0].effect == "sensor-offset" && one.effects[0].location == column;
  });
  const double odds = fault.odds - price_of_search(found.seen.channels.size() * inquiry.library.all().size());
  if (odds < 0 || account == found.single.end()) return false;
  FoundEffect one;
  one.effect = "sensor-offset";
  one.location = column;
  one.confidence = logistic(odds);
  one.parameters = estimates(inquiry, *account, 0);
  result.effects = {one};
  result.verdict = Verdict::effect;
  result.best = result.nearest = &*account;
  return true;
}

}  // namespace detail

/// `none` or `miscalibration`, where there is no effect: calibration was needed when it closes most of what is left
/// once the sensors sit where they sit. What lumping leaves, it does not.
inline Verdict verdict_of_calibration(const SearchResult& found, const JudgingOptions& options) {
  const ChannelResiduals& calibrated = found.calibrated.held.residual;
  const double placed =
      excess_of(misfit_of(found.seen, found.placed.residual.empty() ? calibrated : found.placed.residual));
  const double left = excess_of(misfit_of(found.seen, calibrated));
  const bool needed = placed > options.least_excess && left < (1 - options.calibration_helps) * placed;
  return needed ? Verdict::miscalibration : Verdict::none;
}

/// From what was tried to a verdict.
///
/// A gap is real when some channel leaves on held-out batches far more than a right machine would, or when an effect
/// explains what calibration only absorbs so much better that the number of candidates tried does not account for it.
/// It is explained when the best account closes most of it on batches it has not seen; accounts share the probability
/// by their evidence. A second effect is named only when it is more probable than not.
inline Judgement judge(const SearchContext& inquiry, const SearchResult& found, const JudgingOptions& options = {}) {
  Judgement result;
  result.best = result.nearest = &found.calibrated;
  result.grounds.candidates = found.screened.size();
  if (!found.single.empty()) result.grounds = detail::grounds_of(inquiry, found, found.single.front(), options);
  const bool real = gap_is_real(found.seen, found.calibrated.held.residual, options);
  if (!found.single.empty())
    result.odds =
        plausibility(found.single[0]) - plausibility(found.calibrated) - price_of_search(found.screened.size());
  if (!real && result.odds < 0) {
    if (detail::name_offset(inquiry, found, result)) return result;
    result.verdict = verdict_of_calibration(found, options);
    return result;
  }
  if (found.single.empty()) return result;

  const double second = found.several.empty() ? 0 : detail::probability_of_second(inquiry, found, options);
  const bool two = second > 0.5;
  const std::vector<Account>& accounts = two ? found.several : found.single;
  result.nearest = &accounts.front();
  result.grounds = detail::grounds_of(inquiry, found, accounts.front(), options);
  const double known = probability_known(result.grounds.closes, result.grounds.leaves, options) * logistic(result.odds);
  const std::vector<double> weight = probabilities(accounts);
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
    // Each of the pair with what could take its part beside the other; first the one that explains more alone.
    const bool as_listed = detail::alone(found.single, leading[0]) >= detail::alone(found.single, leading[1]);
    for (const auto& other : {leading[as_listed], leading[!as_listed]}) {
      std::vector<double> share(accounts.size(), 0.0);
      for (std::size_t i = 0; i < accounts.size(); ++i)
        for (const auto& one : accounts[i].effects)
          if (one.effect == other.effect) share[i] = weight[i];
      double sum = 0;
      for (const double one : share) sum += one;
      for (double& one : share) one /= sum;
      const double own = result.effects.empty() ? 1 : second;
      result.effects.push_back(detail::found_effect(
          inquiry, accounts, marginals(accounts, share, other.effect, options.listed), known * own, options));
    }
  }
  result.best = &accounts.front();
  const bool rivals = std::any_of(result.effects.begin(), result.effects.end(),
                                  [](const FoundEffect& one) { return !one.alternatives.empty(); });
  result.verdict = rivals ? Verdict::ambiguous : Verdict::effect;
  return result;
}

}  // namespace thermfit
