#pragma once

/// What the evidence names, before it is asked to prove itself on batches it has not seen.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/judgement/closure.hpp"
#include "thermfit/diagnosis/judgement/marginals.hpp"
#include "thermfit/diagnosis/judgement/offset_fault.hpp"
#include "thermfit/diagnosis/search/search.hpp"

namespace thermfit {

/// What the evidence names, and what it rests on.
struct Naming {
  std::vector<FoundEffect> effects;  ///< empty where nothing is named
  AccountIndex best;                 ///< the account behind `effects`; calibration alone where there are none
  AccountIndex nearest;              ///< the best account tried, named or not
  Support support;                   ///< of `nearest`
  bool real = false;                 ///< calibration leaves what no right machine would
  double odds = -std::numeric_limits<double>::infinity();  ///< log odds that there is an effect, by the evidence and
                                                           ///< the price of the search
};

namespace detail {

/// A variance that the data shrink by less than a tenth of the prior's is not pinned by them.
constexpr double pinned_variance = 0.9;

/// Parameters of effect `position` of an account with their standard errors.
template <typename Scalar = double>
std::vector<Estimate> estimates(const SearchContext& context, const Account& account, std::size_t position) {
  const MapFit& fit = account.fit;
  const MatrixX<Scalar> covariance = fit.covariance();
  const std::size_t own = context.machine.effects.size() + position;
  const ThermalNetwork fitted = fit.network();
  const ThermalNetwork::AddedEffect& added = fitted.effects[own];
  const std::vector<EffectParameter> law = context.library.at(added.effect).parameters(fitted, added);
  std::vector<Estimate> result;
  for (std::size_t k = 0; k < law.size(); ++k) {
    Estimate one{law[k].name, law[k].unit, added.value(law[k].name), law[k].fixed ? 0.0 : -1.0};
    for (Index j = 0; j < covariance.rows(); ++j) {
      const Parameter& parameter = fit.parameter(j);
      if (parameter.kind != Parameter::Kind::effect || parameter.item != own || parameter.part != k) continue;
      if (covariance(j, j) < pinned_variance)
        one.standard_error = std::abs(parameter.slope(fit.coordinates(j))) * std::sqrt(covariance(j, j));
    }
    result.push_back(std::move(one));
  }
  return result;
}

/// An entry of the diagnosis for effect `position` of an account.
template <typename Scalar = double>
FoundEffect found_in(const SearchContext& context, const Account& account, std::size_t position, double confidence) {
  const ThermalNetwork::AddedEffect& added = account.effects[position];
  const Effect& effect = context.library.at(added.effect);
  FoundEffect result;
  result.effect = added.effect;
  result.location = added.location;
  result.driver = added.driver;
  result.confidence = confidence;
  result.parameters = estimates<Scalar>(context, account, position);
  result.meaning = effect.meaning();
  result.against_as_given = effect.calibration_does_the_same();
  return result;
}

/// What `account` closes of what `before` leaves.
template <typename Scalar = double>
Closure closure_by(const SearchContext& context, const Account& before, const Account& account,
                   const Thresholds& thresholds) {
  const bool moves_heat =
      std::any_of(account.effects.begin(), account.effects.end(), [&](const ThermalNetwork::AddedEffect& one) {
        const Stage stage = context.library.at(one.effect).stage();
        return stage != Stage::expansion && stage != Stage::measurement;
      });
  return moves_heat ? closure_of_heat<Scalar>(context.seen, before.held, account.held, thresholds)
                    : closure_of<Scalar>(context.seen, before.held, account.held);
}

template <typename Scalar = double>
Support support_of(const SearchContext& context, const SearchResult& found, const Account& nearest,
                   const Thresholds& thresholds) {
  Support result;
  result.candidates = found.screened.size();
  result.gain_nats = nearest.fit.log_evidence - found.calibrated.fit.log_evidence;
  for (const ThermalNetwork::AddedEffect& one : nearest.effects)
    result.nearest.push_back({one.effect, one.location, one.driver, 0});
  const Closure closure = closure_by<Scalar>(context, found.calibrated, nearest, thresholds);
  result.closes = closure.share;
  result.leaves = closure.left;
  return result;
}

/// Plausibility of the best account with this effect alone, wherever it acts.
inline double alone(const std::vector<Account>& single, const ThermalNetwork::AddedEffect& effect) {
  double result = -std::numeric_limits<double>::infinity();
  for (const Account& one : single)
    if (one.effects[0].effect == effect.effect && one.effects[0].driver == effect.driver)
      result = std::max(result, plausibility(one));
  return result;
}

/// Probability that the best account of two is right about its second effect: it must gain more than the search and the
/// form of the first one's law account for, and close what the first leaves as the first is asked to close the gap.
template <typename Scalar = double>
double probability_of_second(const SearchContext& context, const SearchResult& found, const Thresholds& thresholds) {
  if (found.several.empty()) return 0;
  const Account &single = found.single.front(), &pair = found.several.front();
  const double gained = plausibility(pair) - plausibility(single) - price_of_search(found.screened.size()) -
                        thresholds.law_tolerance * (plausibility(single) - plausibility(found.calibrated));
  const Closure closure = closure_by<Scalar>(context, single, pair, thresholds);
  return logistic(gained) * probability_known(closure.share, closure.left, thresholds);
}

/// Entry for the strongest of `ranked` effects, with rivals that could take its part.
template <typename Scalar = double>
FoundEffect found_with_rivals(const SearchContext& context, const std::vector<Account>& accounts,
                              const std::vector<Marginal>& ranked, double known, const Thresholds& thresholds) {
  const Marginal& first = ranked.front();
  FoundEffect result = found_in<Scalar>(context, accounts[first.leader], first.position, known * first.probability);
  result.same_place.assign(first.places.begin() + 1, first.places.end());
  for (std::size_t i = 1; i < ranked.size(); ++i) {
    if (known * ranked[i].probability < thresholds.listed) continue;
    const ThermalNetwork::AddedEffect& rival = accounts[ranked[i].leader].effects[ranked[i].position];
    result.alternatives.push_back({rival.effect, rival.location, rival.driver, known * ranked[i].probability});
  }
  return result;
}

/// Each of a pair with what could take its part beside the other; first the one that explains more alone.
template <typename Scalar = double>
std::vector<FoundEffect> found_pair(const SearchContext& context, const SearchResult& found, double known,
                                    double second, const Thresholds& thresholds) {
  const std::vector<Account>& accounts = found.several;
  const std::vector<double> weight = probabilities(accounts);
  const std::vector<ThermalNetwork::AddedEffect>& leading = accounts.front().effects;
  if (leading[0].effect == leading[1].effect && leading[0].driver == leading[1].driver) {
    // One effect, stronger in one part of the machine than in another: its place is both parts.
    FoundEffect one = found_in<Scalar>(context, accounts.front(), 0, known);
    one.location += "+" + leading[1].location;
    return {std::move(one)};
  }
  std::vector<FoundEffect> result;
  const bool as_listed = alone(found.single, leading[0]) >= alone(found.single, leading[1]);
  for (const auto& other : {leading[as_listed], leading[!as_listed]}) {
    std::vector<double> share(accounts.size(), 0.0);
    for (std::size_t i = 0; i < accounts.size(); ++i)
      for (const auto& one : accounts[i].effects)
        if (one.effect == other.effect) share[i] = weight[i];
    double sum = 0;
    for (const double one : share) sum += one;
    for (double& one : share) one /= sum;
    const double own = result.empty() ? 1 : second;
    result.push_back(found_with_rivals<Scalar>(
        context, accounts, marginals(accounts, share, other.effect, thresholds.listed), known * own, thresholds));
  }
  return result;
}

/// Names a faulty offset where the data and the number of thermometers and effects allow.
template <typename Scalar = double>
void name_offset(const SearchContext& context, const SearchResult& found, Naming& result) {
  const OffsetFault fault = offset_fault<Scalar>(context, found.calibrated.fit);
  if (fault.sensor < 0) return;
  const std::string& column = context.machine.sensors[static_cast<std::size_t>(fault.sensor)].column;
  const auto account = std::find_if(found.single.begin(), found.single.end(), [&](const Account& one) {
    return one.effects[0].effect == fault.effect && one.effects[0].location == column;
  });
  const double odds = fault.odds - price_of_search(found.seen.channels.size() * context.library.all().size());
  if (odds < 0 || account == found.single.end()) return;
  result.effects = {found_in<Scalar>(context, *account, 0, logistic(odds))};
  result.best = result.nearest = {AccountIndex::List::single, static_cast<std::size_t>(account - found.single.begin())};
}

}  // namespace detail

/// A gap is real when some channel leaves on held-out batches far more than a right machine would, or when an effect
/// explains what calibration only absorbs so much better that the number of candidates tried does not account for it.
/// It is explained when the best account closes most of it on batches it has not seen; accounts share the probability
/// by their evidence. A second effect is named only when it is more probable than not. Allocates.
template <typename Scalar = double>
Naming named_by_evidence(const SearchContext& context, const SearchResult& found, const Thresholds& thresholds) {
  Naming result;
  result.support.candidates = found.screened.size();
  result.real = gap_is_real<Scalar>(found.seen, found.calibrated.held.residual, thresholds);
  if (found.single.empty()) return result;
  result.support = detail::support_of<Scalar>(context, found, found.single.front(), thresholds);
  result.odds = plausibility(found.single[0]) - plausibility(found.calibrated) - price_of_search(found.screened.size());
  if (!result.real && result.odds < 0) {
    detail::name_offset<Scalar>(context, found, result);
    return result;
  }
  const double second = detail::probability_of_second<Scalar>(context, found, thresholds);
  const bool two = second > thresholds.least_second;
  const std::vector<Account>& accounts = two ? found.several : found.single;
  result.nearest = {two ? AccountIndex::List::several : AccountIndex::List::single, 0};
  result.support = detail::support_of<Scalar>(context, found, accounts.front(), thresholds);
  const double known =
      probability_known(result.support.closes, result.support.leaves, thresholds) * logistic(result.odds);
  if (known < thresholds.least_known) return result;
  result.best = result.nearest;
  if (two)
    result.effects = detail::found_pair<Scalar>(context, found, known, second, thresholds);
  else
    result.effects = {detail::found_with_rivals<Scalar>(
        context, accounts, marginals(accounts, probabilities(accounts), "", thresholds.listed), known, thresholds)};
  return result;
}

}  // namespace thermfit
