#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/held_out.hpp"
#include "thermfit/diagnosis/search/screen.hpp"

namespace thermfit {

/// One account of a campaign: the machine calibrated together with some effects (none: calibration only).
struct Account {
  std::vector<ThermalNetwork::AddedEffect> effects;  ///< with fitted values
  MapFit fit;
  HeldOut held;
  int steps = 0;  ///< between its place and one that the catalogue lists
};

/// Evidence counts by this power: lumping errors repeat from batch to batch, so its nats are not worth what they would
/// be if the model were exact (a coarsened likelihood, Miller and Dunson 2019).
constexpr double evidence_power = 0.15;

/// Log probability of an account up to a constant: its evidence, and for every step off the listed places the number of
/// nodes that the step could have taken.
inline double plausibility(const Account& one) {
  return evidence_power * one.fit.log_evidence -
         one.steps * std::log(static_cast<double>(std::max<std::size_t>(2, one.fit.prior.nodes.size())));
}

/// What looking at many places costs the best of them: the log of how many there were.
inline double price_of_search(std::size_t candidates) {
  return std::log(static_cast<double>(std::max<std::size_t>(1, candidates)));
}

/// What stays the same while accounts of one campaign are compared.
struct SearchContext {
  const MachineRecord& seen;
  const ThermalNetwork& machine;  ///< as given, with placements
  const EffectLibrary& library;
  Folds folds;
  unsigned threads = 0;
};

inline bool same_place(const ThermalNetwork::AddedEffect& a, const ThermalNetwork::AddedEffect& b) {
  return a.effect == b.effect && a.location == b.location && a.driver == b.driver;
}

/// Fits the machine with `effects` from where the screening left them. `start` holds the working coordinates of the
/// machine and of all effects but those at the end that have none yet.
inline Account explained_by(const SearchContext& inquiry, const std::vector<ThermalNetwork::AddedEffect>& effects,
                            const Vector& start, const std::vector<ResidualNoise>& noise, MapFitOptions options = {}) {
  ThermalNetwork network = inquiry.machine;
  network.effects.insert(network.effects.end(), effects.begin(), effects.end());
  network = with_complete_effects(std::move(network), inquiry.library);
  const std::vector<Parameter> parameters = calibration_parameters(network, inquiry.library);
  const Index count = static_cast<Index>(parameters.size()), given = std::min(count, start.size());
  options.noise = noise;
  options.start = Vector::Zero(count);
  options.start.head(given) = start.head(given);
  for (Index j = given; j < count; ++j) {
    const Parameter& one = parameters[static_cast<std::size_t>(j)];
    const double value = value_in(network, one);
    options.start(j) = one.logarithmic && value <= 0 ? -3 : one.coordinate(value);
  }
  Account result;
  result.fit = map_fit(inquiry.seen, network, inquiry.library, options);
  const ThermalNetwork fitted = result.fit.network();
  result.effects.assign(fitted.effects.end() - static_cast<std::ptrdiff_t>(effects.size()), fitted.effects.end());
  result.held = held_out(inquiry.seen, result.fit, inquiry.library, inquiry.folds);
  return result;
}

/// Which of the screened deserve the full refit: the strongest, at most `of_one` of each effect (its other places are
/// reached from these), and the strongest of every effect that promises anything, so that a family whose linear promise
/// misleads is not lost.
inline std::vector<Candidate> finalists(const std::vector<Candidate>& screened, std::size_t strongest,
                                        double least_gain, double least_share, std::ptrdiff_t of_one = 3) {
  std::vector<Candidate> result;
  std::map<std::string, std::ptrdiff_t> taken;
  for (const Candidate& one : screened) {
    if (!std::isfinite(one.gain) || one.gain < least_gain) continue;
    std::ptrdiff_t& known = taken[one.added.effect];
    const bool weak = result.size() >= strongest && (known > 0 || one.gain < least_share * screened.front().gain);
    if (weak || known >= of_one) continue;
    ++known;
    result.push_back(one);
  }
  return result;
}

/// Refits every one of `chosen` on top of `kept` effects: a few steps for all, then to the end for the `to_the_end`
/// that have come furthest and the half as many whose next step, taken for the held-out batches, promises most; none
/// that promises e^20 times less than the best.
inline std::vector<Account> refits(const SearchContext& inquiry, const std::vector<Candidate>& chosen,
                                   const std::vector<ThermalNetwork::AddedEffect>& kept, const MapFit& base,
                                   const MapFitOptions& options, std::size_t to_the_end = 5) {
  std::vector<Account> result(chosen.size());
  MapFitOptions brief = options;
  brief.most_iterations = 3;
  brief.prior_scale = base.prior_scale;
  in_parallel(chosen.size(), inquiry.threads, [&](std::size_t i) {
    std::vector<ThermalNetwork::AddedEffect> effects = kept;
    effects.push_back(chosen[i].added);
    result[i] = explained_by(inquiry, effects, chosen[i].start, base.noise, brief);
  });
  if (result.empty()) return result;
  const auto of_the_best = [&](std::size_t count, auto&& figure) {
    std::vector<double> figures;
    for (const Account& one : result) figures.push_back(figure(one));
    std::sort(figures.rbegin(), figures.rend());
    return figures[std::min(count, figures.size()) - 1];
  };
  const double reached = of_the_best(to_the_end, [](const Account& one) { return one.fit.log_evidence; });
  const double promised =
      to_the_end < 2 ? INFINITY : of_the_best(to_the_end / 2, [](const Account& one) { return one.held.log_score; });
  const double hopeless = of_the_best(1, [](const Account& one) { return one.held.log_score; }) - 20 / evidence_power;
  in_parallel(chosen.size(), inquiry.threads, [&](std::size_t i) {
    if (result[i].fit.converged) return;
    if (result[i].fit.log_evidence < reached && result[i].held.log_score < promised) return;
    if (result[i].held.log_score < hopeless) return;
    const Vector start = result[i].fit.coordinates;
    const std::vector<ResidualNoise> noise = result[i].fit.noise;
    MapFitOptions onward = options;
    onward.prior_scale = result[i].fit.prior_scale;
    result[i] = explained_by(inquiry, result[i].effects, start, noise, onward);
  });
  return result;
}

/// Mean square of each channel in units of what is expected of a right machine: noise and lumping tolerance.
inline Vector misfit_of(const MachineRecord& seen, const ChannelResiduals& residual) {
  Vector result = Vector::Zero(static_cast<Index>(seen.channels.size()));
  for (std::size_t c = 0; c < residual.size(); ++c) {
    const ObservedChannel& channel = seen.channels[c];
    double squares = 0, count = 0;
    for (const Vector& r : residual[c])
      for (Index k = 0; k < r.size(); ++k)
        if (!std::isnan(r(k))) squares += r(k) * r(k), ++count;
    const double expected = std::hypot(channel.floor, channel.bounds.least_slow);
    if (count > 0 && expected > 0) result(static_cast<Index>(c)) = squares / count / (expected * expected);
  }
  return result;
}

/// What is beyond expectation, summed over channels.
inline double excess_of(const Vector& misfit) { return (misfit.array() - 1).max(0).sum(); }

}  // namespace thermfit
