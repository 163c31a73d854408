#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/start_tolerance.hpp"
#include "thermfit/diagnosis/search/place_walk.hpp"

namespace thermfit {

/// How hard to look.
struct SearchOptions {
  std::size_t strongest = 7;  ///< candidates that get the full refit, before one of each family is added
  std::size_t restarted = 4;  ///< of them get a second start where the best leaves much
  int most_steps = 3;         ///< from place to place around the best
  std::size_t most_effects = 2;
  unsigned threads = 0;    ///< 0: all cores
  double second_from = 4;  ///< misfit of a channel, (rms / expected)^2, beyond which a second effect is sought at once
  double tolerance = 1.5;  ///< nats at which a refit of a candidate stops
  int most_iterations = 18;
  std::function<void(const std::string& step, double share)> progress;
};

/// Everything a verdict is built from: the accounts of a campaign, tried and judged on held-out batches.
struct SearchResult {
  MachineRecord seen;
  ThermalNetwork machine;  ///< as given, with placements
  Folds folds;
  ChannelResiduals as_given;  ///< of the machine as given, sensors where it says they are
  MapFit placed;              ///< only the sensors moved: what the machine as given leaves once they sit where they sit
  Account calibrated;
  std::vector<Candidate> screened;  ///< all candidates, strongest first
  std::vector<Account> single;      ///< refitted candidates, most plausible first
  std::vector<Account> several;     ///< with two and more effects, most plausible first
};

/// Tries the whole catalogue on a campaign: calibration alone; every candidate screened; the finalists refitted
/// together with calibration; the places around the best; then a second effect on top of the best, with a swap of the
/// first.
inline SearchResult investigate(const ThermalNetwork& network, const Campaign& campaign, const EffectLibrary& library,
                                const std::vector<ThermalNetwork::AddedEffect>& candidates,
                                const SearchOptions& options = {}) {
  SearchResult result;
  result.machine = with_complete_effects(with_placements(network), library);
  result.seen = observations_of(result.machine, campaign);
  result.machine.uncertainty.start_share = start_share_sd(result.machine, result.seen);
  result.folds = folds_of(result.machine, result.seen);
  const SearchContext inquiry{result.seen, result.machine, library, result.folds, options.threads};
  const auto say = [&](const std::string& step, double share) {
    if (options.progress) options.progress(step, share);
  };

  say("calibrating", 0);
  result.as_given = residuals_of(result.seen, simulate(result.machine, result.seen.excitations, library));
  ThermalNetwork sensors_only = result.machine;
  ThermalNetwork::Uncertainty& sd = sensors_only.uncertainty;
  sd.capacity = sd.ambient = sd.conductance = sd.power = sd.um_per_K = 0;
  sensors_only.effects.clear();
  MapFitOptions coarse;
  coarse.tolerance = 1.5;
  coarse.most_iterations = 25;
  if (result.machine.effects.empty()) result.placed = map_fit(result.seen, sensors_only, library, coarse);
  MapFitOptions thorough;
  thorough.tolerance = 0.3;
  thorough.most_iterations = 40;
  thorough.fit_prior_scale = true;
  result.calibrated = explained_by(inquiry, {}, {}, {}, thorough);

  const Index own = result.calibrated.fit.coordinates.size();
  MapFitOptions refit;
  refit.tolerance = options.tolerance;
  refit.most_iterations = options.most_iterations;
  refit.fit_prior_scale = true;
  // Calibration alone from where the best account of every effect has left it: what a better valley gains is no
  // effect's. Whether it was better by more than `worth` nats.
  const auto drop_effects = [&](double worth) {
    std::vector<const Account*> best;
    for (const Account& one : result.single)
      if (std::none_of(best.begin(), best.end(),
                       [&](const Account* other) { return other->effects[0].effect == one.effects[0].effect; }))
        best.push_back(&one);
    std::vector<Account> dropped(best.size());
    in_parallel(dropped.size(), options.threads, [&](std::size_t i) {
      MapFitOptions onward = thorough;
      onward.prior_scale = best[i]->fit.prior_scale;
      dropped[i] = explained_by(inquiry, {}, best[i]->fit.coordinates.head(own), best[i]->fit.noise, onward);
    });
    const double before = result.calibrated.fit.log_evidence;
    for (Account& one : dropped)
      if (one.fit.log_evidence > result.calibrated.fit.log_evidence) result.calibrated = std::move(one);
    return result.calibrated.fit.log_evidence > before + worth;
  };
  for (bool again = true, first = true; again; first = false) {
    say("screening " + std::to_string(candidates.size()) + " candidates", first ? 0.1 : 0.5);
    refit.prior_scale = result.calibrated.fit.prior_scale;
    {
      const ScreeningBase base(result.seen, result.calibrated.fit, library, result.machine.effects.size());
      result.screened = screen(base, library, candidates, options.threads);
    }
    const std::vector<Candidate> chosen = finalists(result.screened, options.strongest, 5, 0.06);
    say("refitting " + std::to_string(chosen.size()) + " finalists", first ? 0.25 : 0.55);
    for (Account& one : refits(inquiry, chosen, {}, result.calibrated.fit, refit))
      detail::keep_better(result.single, std::move(one));
    if (first && !result.single.empty()) {
      // Second starts, from the means of the priors, where the leader leaves much.
      say("trying other starts", 0.4);
      const bool open = excess_of(misfit_of(result.seen, result.single.front().held.residual)) > 1;
      std::vector<Account> restarted(open ? std::min(options.restarted, result.single.size()) : 0);
      in_parallel(restarted.size(), options.threads, [&](std::size_t i) {
        restarted[i] = explained_by(inquiry, {result.single[i].effects[0]}, {}, {}, refit);
      });
      for (Account& one : restarted) detail::keep_better(result.single, std::move(one));
    }
    // From a valley that is better by a good part of what the leader gained, the effects look different: once more.
    const double gain =
        result.single.empty() ? 0 : result.single[0].fit.log_evidence - result.calibrated.fit.log_evidence;
    again = drop_effects(std::max(5.0, 0.1 * gain)) && first;
  }
  if (!result.single.empty()) {
    say("trying the places beside", 0.6);
    detail::PlaceWalk(inquiry, result.screened, own, result.single, 0, refit).run(options.most_steps);
    drop_effects(0);
  }

  // A second effect on top of a first that is worth its name: what promises more than the number of candidates accounts
  // for, and anything where the first leaves some channel far from what can be expected.
  const double by_chance = price_of_search(candidates.size());
  if (options.most_effects > 1 && !result.single.empty() &&
      plausibility(result.single[0]) - plausibility(result.calibrated) > by_chance) {
    const double left = misfit_of(result.seen, result.single[0].held.residual).maxCoeff();
    const double least_gain = left > options.second_from ? 3 : by_chance / evidence_power;
    say("looking for a second effect", 0.7);
    const auto add_to = [&](const Account& first, std::size_t strongest) {
      const ScreeningBase base(result.seen, first.fit, library, result.machine.effects.size());
      std::vector<ThermalNetwork::AddedEffect> others;
      for (const Candidate& one : result.screened)
        if (!same_place(one.added, first.effects[0])) others.push_back(one.added);
      std::vector<Candidate> screened = screen(base, library, others, options.threads);
      std::vector<Account> pairs =
          refits(inquiry, finalists(screened, strongest, least_gain, 0.3), first.effects, first.fit, refit, 3);
      for (Account& pair : pairs) {
        pair.steps = first.steps;
        result.several.push_back(std::move(pair));
      }
      detail::best_first(result.several);
    };
    add_to(result.single[0], 5);
    if (!result.several.empty()) {
      // Swap: hold the second effect and look for the first anew.
      const ThermalNetwork::AddedEffect second = result.several[0].effects[1];
      const auto alone = std::find_if(result.single.begin(), result.single.end(),
                                      [&](const Account& one) { return same_place(one.effects[0], second); });
      if (alone != result.single.end()) {
        add_to(*alone, 4);
      } else {
        Account only =
            explained_by(inquiry, {second}, result.calibrated.fit.coordinates, result.calibrated.fit.noise, refit);
        add_to(only, 4);
        result.single.push_back(std::move(only));
        detail::best_first(result.single);
      }
    }
  }
  if (!result.several.empty() && plausibility(result.several[0]) > plausibility(result.single[0]))
    for (const std::size_t position : {1, 0})
      detail::PlaceWalk(inquiry, result.screened, own, result.several, position, refit).run(2);
  say("judging", 0.95);
  return result;
}

}  // namespace thermfit
