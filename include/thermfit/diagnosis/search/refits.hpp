#pragma once

/// Which of the screened candidates deserve the full refit, and the refit.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "thermfit/diagnosis/search/account.hpp"
#include "thermfit/diagnosis/search/screen.hpp"

namespace thermfit {

/// What a candidate must promise to be refitted.
struct FinalistRules {
  std::size_t strongest = 7;  ///< so many, before one of each further effect is added
  double least_gain = 5;      ///< nats
  double least_share = 0.06;  ///< of the strongest candidate's gain, beyond the `strongest`
  std::ptrdiff_t of_one = 3;  ///< places of one effect: its other places are reached from these
};

/// The strongest, and the strongest of every effect that promises anything, so that a family whose linear promise
/// misleads is not lost. `screened` and the result: strongest first.
inline std::vector<Candidate> finalists(const std::vector<Candidate>& screened, const FinalistRules& rules) {
  std::vector<Candidate> result;
  std::map<std::string, std::ptrdiff_t> taken;
  for (const Candidate& one : screened) {
    if (!std::isfinite(one.gain) || one.gain < rules.least_gain) continue;
    std::ptrdiff_t& known = taken[one.added.effect];
    const bool weak =
        result.size() >= rules.strongest && (known > 0 || one.gain < rules.least_share * screened.front().gain);
    if (weak || known >= rules.of_one) continue;
    ++known;
    result.push_back(one);
  }
  return result;
}

namespace detail {

/// The `count`-th largest figure of the accounts.
template <class Figure>
double largest_of(const std::vector<Account>& accounts, std::size_t count, Figure figure) {
  std::vector<double> figures;
  for (const Account& one : accounts) figures.push_back(figure(one));
  std::sort(figures.rbegin(), figures.rend());
  return figures[std::min(count, figures.size()) - 1];
}

/// Log odds against the best beyond which an account is not worth more steps.
constexpr double hopeless_nats = 20;
/// Iterations that every finalist gets before the weak are left behind.
constexpr int brief_iterations = 3;

}  // namespace detail

/// Refits every one of `chosen` on top of `kept` effects: a few steps for all, then to the end for the `to_the_end`
/// that have come furthest and the half as many whose next step, taken for the held-out batches, promises most; none
/// that promises e^20 times less than the best. In the order of `chosen`.
template <typename Scalar = double>
std::vector<Account> refits(const SearchContext& context, const std::vector<Candidate>& chosen,
                            const std::vector<ThermalNetwork::AddedEffect>& kept, const MapFit& base,
                            const MapFitOptions& how, std::size_t to_the_end = 5) {
  std::vector<Account> result(chosen.size());
  MapFitOptions brief = onward_from<Scalar>(base, how, 0);
  brief.most_iterations = detail::brief_iterations;
  in_parallel(chosen.size(), context.threads, [&](std::size_t i) {
    std::vector<ThermalNetwork::AddedEffect> effects = kept;
    effects.push_back(chosen[i].added);
    MapFitOptions own = brief;
    own.start = chosen[i].start;
    result[i] = explained_by<Scalar>(context, effects, own);
  });
  if (result.empty()) return result;
  const auto evidence = [](const Account& one) { return one.fit.log_evidence; };
  const auto score = [](const Account& one) { return one.held.log_score; };
  const double reached = detail::largest_of(result, to_the_end, evidence);
  const double promised =
      to_the_end < 2 ? std::numeric_limits<double>::infinity() : detail::largest_of(result, to_the_end / 2, score);
  const double hopeless = detail::largest_of(result, 1, score) - detail::hopeless_nats / evidence_power;
  in_parallel(chosen.size(), context.threads, [&](std::size_t i) {
    Account& one = result[i];
    if (one.fit.converged || one.held.log_score < hopeless) return;
    if (one.fit.log_evidence < reached && one.held.log_score < promised) return;
    one = explained_by<Scalar>(context, one.effects, onward_from<Scalar>(one.fit, how, one.fit.coordinates.size()));
  });
  return result;
}

}  // namespace thermfit
