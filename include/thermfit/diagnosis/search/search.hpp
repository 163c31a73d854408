#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/batch_numbers.hpp"
#include "thermfit/calibration/machine_record.hpp"
#include "thermfit/calibration/misfit.hpp"
#include "thermfit/calibration/start_tolerance.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/search/place_walk.hpp"

namespace thermfit {

/// How hard to look.
struct SearchOptions {
  std::size_t strongest = 7;     ///< candidates that get the full refit, before one of each family is added
  std::size_t restarted = 4;     ///< of them get a second start where the best leaves much
  int most_steps = 3;            ///< from place to place around the best
  std::size_t most_effects = 2;  ///< in one account
  unsigned threads = 0;          ///< 0: all cores
  double second_from = 4;  ///< misfit of a channel, (rms / expected)^2, beyond which a second effect is sought at once
  double tolerance = 1.5;  ///< nats at which a refit of a candidate stops
  int most_iterations = 18;                                             ///< of a refit of a candidate
  std::function<void(const std::string& step, double share)> progress;  ///< told each step; `share` of all is done, 0…1
};

/// Which account of a SearchResult.
struct AccountIndex {
  /// The members of a SearchResult of these names.
  enum class List { calibrated, single, several };
  List list = List::calibrated;  ///< in which it is
  std::size_t index = 0;         ///< in the list; of no meaning for `calibrated`, which is one account
};

/// Everything a verdict is built from: the accounts of a campaign, tried and judged on held-out batches.
struct SearchResult {
  MachineRecord seen;         ///< what the campaign says
  ThermalNetwork machine;     ///< as given, with placements
  Folds folds;                ///< batches left out together; empty: too few to leave any out
  ChannelResiduals as_given;  ///< of the machine as given, sensors where it says they are
  MapFit placed;              ///< only the sensors moved: what the machine as given leaves once they sit where they sit
  Account calibrated;         ///< without effects
  std::vector<Candidate> screened;  ///< all candidates, strongest first
  std::vector<Account> single;      ///< refitted candidates, most plausible first
  std::vector<Account> several;     ///< with two and more effects, most plausible first

  /// The account; `which` must be one that there is.
  const Account& at(AccountIndex which) const {
    return which.list == AccountIndex::List::calibrated ? calibrated
           : which.list == AccountIndex::List::single   ? single[which.index]
                                                        : several[which.index];
  }
};

namespace detail {

/// Fills a SearchResult, step by step.
template <typename Scalar = double>
class CatalogueSearch {
 public:
  CatalogueSearch(const ThermalNetwork& network, const Campaign& campaign, const EffectLibrary& library,
                  const std::vector<ThermalNetwork::AddedEffect>& candidates, const SearchOptions& options)
      : library_(library), candidates_(candidates), options_(options) {
    found_.machine = with_complete_effects(with_placements(network), library);
    found_.seen = observations_of(found_.machine, campaign);
    found_.machine.uncertainty.start_share = start_share_sd(found_.machine, found_.seen);
    found_.machine = with_batch_numbers_that_pay<Scalar>(found_.machine, found_.seen, library);
    found_.folds = folds_of(found_.machine, found_.seen);
    thorough_.tolerance = 0.3;
    thorough_.most_iterations = 40;
    refit_.tolerance = options.tolerance;
    refit_.most_iterations = options.most_iterations;
    thorough_.fit_prior_scale = refit_.fit_prior_scale = true;
  }

  SearchResult run() {
    say("calibrating", 0);
    place_sensors();
    found_.calibrated = explained_by<Scalar>(context_, {}, thorough_);
    try_all(true);
    // From a valley that is better by a good part of what the leader gained, the effects look different: once more.
    const double good_part = std::max(5.0, 0.1 * gain_of_leader());
    if (drop_effects() > good_part) {
      try_all(false);
      drop_effects();
    }
    if (!found_.single.empty()) {
      say("trying the places beside", 0.6);
      PlaceWalk<Scalar>(context_, found_.screened, own(), found_.single, 0, refit_).run(options_.most_steps);
      drop_effects();
    }
    add_second();
    if (!found_.several.empty() && plausibility(found_.several[0]) > plausibility(found_.single[0]))
      for (const std::size_t position : {std::size_t{1}, std::size_t{0}})
        PlaceWalk<Scalar>(context_, found_.screened, own(), found_.several, position, refit_).run(2);
    say("judging", 0.95);
    return std::move(found_);
  }

 private:
  void say(const std::string& step, double share) const {
    if (options_.progress) options_.progress(step, share);
  }

  /// Coordinates of the machine alone.
  Index own() const { return found_.calibrated.fit.coordinates.size(); }

  double gain_of_leader() const {
    return found_.single.empty() ? 0 : found_.single[0].fit.log_evidence - found_.calibrated.fit.log_evidence;
  }

  /// What the machine as given leaves, and what it leaves once the sensors sit where they sit.
  void place_sensors() {
    found_.as_given = residuals_of(found_.seen, simulate(found_.machine, found_.seen.excitations, library_));
    if (!found_.machine.effects.empty()) return;
    ThermalNetwork sensors_only = found_.machine;
    ThermalNetwork::Uncertainty& sd = sensors_only.uncertainty;
    sd.capacity = sd.ambient = sd.conductance = sd.power = sd.um_per_K = 0;
    MapFitOptions coarse;
    coarse.tolerance = 1.5;
    coarse.most_iterations = 25;
    found_.placed = map_fit(found_.seen, sensors_only, library_, coarse);
  }

  /// Screens all candidates on top of calibration and refits the finalists; at first also from other starts, where the
  /// leader leaves much.
  void try_all(bool first) {
    say("screening " + std::to_string(candidates_.size()) + " candidates", first ? 0.1 : 0.5);
    refit_.prior_scale = found_.calibrated.fit.prior_scale;
    found_.screened = screened_on(found_.calibrated, candidates_);
    FinalistRules rules;
    rules.strongest = options_.strongest;
    const std::vector<Candidate> chosen = finalists(found_.screened, rules);
    say("refitting " + std::to_string(chosen.size()) + " finalists", first ? 0.25 : 0.55);
    for (Account& one : refits<Scalar>(context_, chosen, {}, found_.calibrated.fit, refit_))
      keep_better(found_.single, std::move(one));
    if (!first || found_.single.empty()) return;
    say("trying other starts", 0.4);
    const bool open = excess_of(misfit_of<Scalar>(found_.seen, found_.single.front().held.residual)) > 1;
    std::vector<Account> restarted(open ? std::min(options_.restarted, found_.single.size()) : 0);
    in_parallel(restarted.size(), options_.threads, [&](std::size_t i) {
      restarted[i] = explained_by<Scalar>(context_, {found_.single[i].effects[0]}, refit_);
    });
    for (Account& one : restarted) keep_better(found_.single, std::move(one));
  }

  std::vector<Candidate> screened_on(const Account& account,
                                     const std::vector<ThermalNetwork::AddedEffect>& candidates) {
    const ScreeningBase<Scalar> base(found_.seen, account.fit, library_, found_.machine.effects.size());
    return screen(base, library_, candidates, options_.threads);
  }

  /// Calibration alone from where the best account of every effect has left it: what a better valley gains is no
  /// effect's. Returns by how many nats it was better.
  double drop_effects() {
    std::vector<const Account*> best;
    for (const Account& one : found_.single)
      if (std::none_of(best.begin(), best.end(),
                       [&](const Account* other) { return other->effects[0].effect == one.effects[0].effect; }))
        best.push_back(&one);
    std::vector<Account> dropped(best.size());
    in_parallel(dropped.size(), options_.threads, [&](std::size_t i) {
      dropped[i] = explained_by<Scalar>(context_, {}, onward_from<Scalar>(best[i]->fit, thorough_, own()));
    });
    const double before = found_.calibrated.fit.log_evidence;
    for (Account& one : dropped)
      if (one.fit.log_evidence > found_.calibrated.fit.log_evidence) found_.calibrated = std::move(one);
    return found_.calibrated.fit.log_evidence - before;
  }

  /// A second effect on top of a first that is worth its name: what promises more than the number of candidates
  /// accounts for, and anything where the first leaves some channel far from what can be expected. Then the swap: the
  /// second is held and the first looked for anew.
  void add_second() {
    const double by_chance = price_of_search(candidates_.size());
    if (options_.most_effects < 2 || found_.single.empty()) return;
    if (plausibility(found_.single[0]) - plausibility(found_.calibrated) <= by_chance) return;
    say("looking for a second effect", 0.7);
    const double left = misfit_of<Scalar>(found_.seen, found_.single[0].held.residual).maxCoeff();
    FinalistRules rules;
    rules.least_gain = left > options_.second_from ? 3 : by_chance / evidence_power;
    rules.least_share = 0.3;
    rules.strongest = 5;
    add_to(found_.single[0], rules);
    if (found_.several.empty()) return;
    rules.strongest = 4;
    const ThermalNetwork::AddedEffect second = found_.several[0].effects[1];
    const auto alone = std::find_if(found_.single.begin(), found_.single.end(),
                                    [&](const Account& one) { return same_place(one.effects[0], second); });
    if (alone != found_.single.end()) {
      add_to(*alone, rules);
      return;
    }
    const MapFit& base = found_.calibrated.fit;
    MapFitOptions how = onward_from<Scalar>(base, refit_, own());
    how.prior_scale = refit_.prior_scale;
    found_.single.push_back(explained_by<Scalar>(context_, {second}, how));
    add_to(found_.single.back(), rules);
    best_first(found_.single);
  }

  /// Accounts of `first` with another effect.
  void add_to(const Account& first, const FinalistRules& rules) {
    std::vector<ThermalNetwork::AddedEffect> others;
    for (const Candidate& one : found_.screened)
      if (!same_place(one.added, first.effects[0])) others.push_back(one.added);
    const std::vector<Candidate> screened = screened_on(first, others);
    for (Account& pair : refits<Scalar>(context_, finalists(screened, rules), first.effects, first.fit, refit_, 3)) {
      pair.steps = first.steps;
      found_.several.push_back(std::move(pair));
    }
    best_first(found_.several);
  }

  const EffectLibrary& library_;
  const std::vector<ThermalNetwork::AddedEffect>& candidates_;
  const SearchOptions& options_;
  SearchResult found_;
  const SearchContext context_{found_.seen, found_.machine, library_, found_.folds, options_.threads};
  MapFitOptions thorough_, refit_;  ///< of calibration, of an account
};

}  // namespace detail

/// Tries `candidates` on a campaign: calibration alone; every candidate screened; the finalists refitted together with
/// calibration; the places around the best; then a second effect on top of the best, with a swap of the first. Throws
/// Error on a campaign that cannot drive the network. Allocates.
template <typename Scalar = double>
SearchResult search(const ThermalNetwork& network, const Campaign& campaign, const EffectLibrary& library,
                    const std::vector<ThermalNetwork::AddedEffect>& candidates, const SearchOptions& options = {}) {
  return detail::CatalogueSearch<Scalar>(network, campaign, library, candidates, options).run();
}

THERMFIT_COMPILED_TEMPLATE(SearchResult search<double>(const ThermalNetwork&, const Campaign&, const EffectLibrary&,
                                                       const std::vector<ThermalNetwork::AddedEffect>&,
                                                       const SearchOptions&));

}  // namespace thermfit
