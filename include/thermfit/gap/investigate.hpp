#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/effects/place.hpp"
#include "thermfit/gap/explanation.hpp"

namespace thermfit {

/// How hard to look.
struct SearchOptions {
  std::size_t strongest = 7;  ///< candidates that get the full refit, before one of each family is added
  std::size_t restarted = 4;  ///< of them get a second start where the best leaves much
  int most_steps = 3;         ///< from place to place around the best
  std::size_t most_effects = 2;
  unsigned threads = 0;    ///< 0: all cores
  double far = 2;          ///< times what is expected: a channel beyond it asks for a second effect at once
  double tolerance = 1.5;  ///< nats at which a refit of a candidate stops
  int most_iterations = 14;
  std::function<void(const std::string& step, double share)> progress;
};

/// Everything a verdict is built from: the accounts of a campaign, tried and judged on held-out batches.
struct Investigation {
  MachineRecord seen;
  ThermalNetwork machine;  ///< as given, with placements
  Folds folds;
  ChannelResiduals as_given;  ///< of the machine as given, sensors where it says they are
  MapFit placed;              ///< only the sensors moved: what the machine as given leaves once they sit where they sit
  Explanation calibrated;
  std::vector<Screened> screened;    ///< all candidates, strongest first
  std::vector<Explanation> single;   ///< refitted candidates, most plausible first
  std::vector<Explanation> several;  ///< with two and more effects, most plausible first
};

namespace detail {

inline void best_first(std::vector<Explanation>& explanations) {
  std::stable_sort(explanations.begin(), explanations.end(),
                   [](const Explanation& a, const Explanation& b) { return plausibility(a) > plausibility(b); });
}

/// Walks from place to place: the catalogue's list of places is coarse.
class PlaceWalk {
 public:
  /// Over the accounts, most plausible first, of which the leader's effect `position` is to find its place; it becomes
  /// the last effect of the accounts tried.
  PlaceWalk(const Inquiry& inquiry, const Investigation& found, std::vector<Explanation>& accounts,
            std::size_t position, const MapFitOptions& refit)
      : inquiry_(inquiry), found_(found), accounts_(accounts), position_(position), refit_(refit) {}

  /// At most `most_steps` steps to the best set of nodes, or pair, around the leader; at each, all nodes whose coming
  /// or going helped are tried together too.
  void run(int most_steps) {
    for (int step = 0; step < most_steps; ++step) {
      leader_ = accounts_.front();
      std::vector<Screened> near;
      for (const std::string& place : places_beside(found_.machine, moving().location))
        if (allowed(place) && !tried(place)) near.push_back(at(place));
      std::vector<Explanation> reached = refitted(near, 1, 2);
      const auto [place, steps] = together(reached);
      if (steps > 1 && !tried(place))
        for (Explanation& one : refitted({at(place)}, steps, 1)) reached.push_back(std::move(one));
      for (Explanation& one : reached) accounts_.push_back(std::move(one));
      best_first(accounts_);
      if (same_place(accounts_.front().effects.back(), moving())) break;
      position_ = leader_.effects.size() - 1;
    }
  }

 private:
  const ThermalNetwork::AddedEffect& moving() const { return leader_.effects[position_]; }

  bool listed(const std::string& place) const {
    return std::any_of(found_.screened.begin(), found_.screened.end(), [&](const Screened& one) {
      return one.added.effect == moving().effect && one.added.driver == moving().driver && one.added.location == place;
    });
  }
  /// Sets of nodes for an effect that takes sets; single nodes and pairs as the catalogue lists them.
  bool allowed(const std::string& place) const {
    const bool set = place == "all" || place.find('+') != std::string::npos;
    const bool takes_sets = std::any_of(found_.screened.begin(), found_.screened.end(), [&](const Screened& one) {
      return one.added.effect == moving().effect && one.added.location.find('+') != std::string::npos;
    });
    return (set && takes_sets) || listed(place);
  }
  bool tried(const std::string& place) const {
    ThermalNetwork::AddedEffect moved = moving();
    moved.location = place;
    return std::any_of(accounts_.begin(), accounts_.end(), [&](const Explanation& one) {
      return one.effects.size() == leader_.effects.size() &&
             std::any_of(one.effects.begin(), one.effects.end(),
                         [&](const auto& effect) { return same_place(effect, moved); });
    });
  }
  Screened at(const std::string& place) const {
    Screened one;
    one.added = moving();
    one.added.location = place;
    one.start = leader_.fit.t.head(found_.calibrated.fit.t.size());
    return one;
  }
  std::vector<Explanation> refitted(const std::vector<Screened>& chosen, int steps, std::size_t to_the_end) const {
    std::vector<ThermalNetwork::AddedEffect> kept = leader_.effects;
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(position_));
    std::vector<Explanation> result = refits(inquiry_, chosen, kept, leader_.fit, refit_, to_the_end);
    for (Explanation& one : result) one.steps = listed(one.effects.back().location) ? 0 : leader_.steps + steps;
    return result;
  }
  /// The place that takes all single steps that helped, and how many they are.
  std::pair<std::string, int> together(const std::vector<Explanation>& reached) const {
    int helped = 0;
    std::vector<Index> nodes;
    for (const Explanation& one : reached) {
      const std::string& place = one.effects.back().location;
      if (plausibility(one) <= plausibility(leader_) || (place != "all" && place.find('+') == std::string::npos))
        continue;
      const std::vector<Index> before = nodes_at(found_.machine, moving().location);
      const std::vector<Index> after = nodes_at(found_.machine, place);
      if (++helped == 1) nodes = before;
      for (Index i = 0; i < found_.machine.node_count(); ++i) {
        const bool was = std::count(before.begin(), before.end(), i) > 0,
                   is = std::count(after.begin(), after.end(), i) > 0;
        if (!was && is) nodes.push_back(i);
        if (was && !is) nodes.erase(std::remove(nodes.begin(), nodes.end(), i), nodes.end());
      }
    }
    if (nodes.empty()) return {"", 0};
    std::sort(nodes.begin(), nodes.end());
    return {place_of(found_.machine, nodes), helped};
  }

  const Inquiry& inquiry_;
  const Investigation& found_;
  std::vector<Explanation>& accounts_;
  std::size_t position_;
  const MapFitOptions& refit_;
  Explanation leader_;
};

}  // namespace detail

/// Tries the whole catalogue on a campaign: calibration alone; every candidate screened; the finalists refitted
/// together with calibration; the places around the best; then a second effect on top of the best, with a swap of the
/// first.
inline Investigation investigate(const ThermalNetwork& network, const Campaign& campaign, const EffectLibrary& library,
                                 const std::vector<ThermalNetwork::AddedEffect>& candidates,
                                 const SearchOptions& options = {}) {
  Investigation result;
  result.machine = with_complete_effects(with_placements(network), library);
  result.seen = observations_of(result.machine, campaign);
  result.folds = folds_of(result.machine, result.seen);
  const Inquiry inquiry{result.seen, result.machine, library, result.folds, options.threads};
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
  result.calibrated = explained_by(inquiry, {}, {}, {}, thorough);

  say("screening " + std::to_string(candidates.size()) + " candidates", 0.1);
  MapFitOptions refit;
  refit.tolerance = options.tolerance;
  refit.most_iterations = options.most_iterations;
  {
    const ScreeningBase base(result.seen, result.calibrated.fit, library, result.machine.effects.size());
    result.screened = screen(base, library, candidates, options.threads);
  }
  const std::vector<Screened> chosen = finalists(result.screened, options.strongest, 5, 0.06);
  say("refitting " + std::to_string(chosen.size()) + " finalists", 0.35);
  result.single = refits(inquiry, chosen, {}, result.calibrated.fit, refit);
  detail::best_first(result.single);

  if (!result.single.empty()) {
    // Second starts, from the means of the priors, where the leader leaves much: calibration may have settled in the
    // wrong valley.
    say("trying other starts and the places beside", 0.6);
    const bool open = excess_of(misfit_of(result.seen, result.single.front().held.residual)) > 1;
    std::vector<Explanation> again(open ? std::min(options.restarted, result.single.size()) : 0);
    in_parallel(again.size(), options.threads,
                [&](std::size_t i) { again[i] = explained_by(inquiry, {result.single[i].effects[0]}, {}, {}, refit); });
    for (std::size_t i = 0; i < again.size(); ++i)
      if (again[i].fit.log_posterior > result.single[i].fit.log_posterior) result.single[i] = std::move(again[i]);
    detail::best_first(result.single);
    detail::PlaceWalk(inquiry, result, result.single, 0, refit).run(options.most_steps);
  }

  // A second effect on top of a first that is worth its name: what promises more than the number of candidates accounts
  // for, and anything where the first leaves some channel far from what can be expected.
  const double by_chance = std::log(static_cast<double>(std::max<std::size_t>(1, candidates.size())));
  if (options.most_effects > 1 && !result.single.empty() &&
      plausibility(result.single[0]) - plausibility(result.calibrated) > by_chance) {
    const double left = misfit_of(result.seen, result.single[0].held.residual).maxCoeff();
    const double least_gain = left > options.far * options.far ? 3 : by_chance / evidence_power;
    say("looking for a second effect", 0.7);
    const auto add_to = [&](const Explanation& first, std::size_t strongest) {
      const ScreeningBase base(result.seen, first.fit, library, result.machine.effects.size());
      std::vector<ThermalNetwork::AddedEffect> others;
      for (const Screened& one : result.screened)
        if (!same_place(one.added, first.effects[0])) others.push_back(one.added);
      std::vector<Screened> screened = screen(base, library, others, options.threads);
      std::vector<Explanation> pairs =
          refits(inquiry, finalists(screened, strongest, least_gain, 0.3), first.effects, first.fit, refit, 3);
      for (Explanation& pair : pairs) {
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
                                      [&](const Explanation& one) { return same_place(one.effects[0], second); });
      if (alone != result.single.end()) {
        add_to(*alone, 4);
      } else {
        Explanation only = explained_by(inquiry, {second}, result.calibrated.fit.t, result.calibrated.fit.noise, refit);
        add_to(only, 4);
        result.single.push_back(std::move(only));
        detail::best_first(result.single);
      }
    }
  }
  if (!result.several.empty() && plausibility(result.several[0]) > plausibility(result.single[0]))
    for (const std::size_t position : {1, 0})
      detail::PlaceWalk(inquiry, result, result.several, position, refit).run(2);
  say("judging", 0.95);
  return result;
}

}  // namespace thermfit
