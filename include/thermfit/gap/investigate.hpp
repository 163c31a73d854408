#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/gap/explanation.hpp"

namespace thermfit {

/// How hard to look.
struct SearchOptions {
  std::size_t strongest = 7;  ///< candidates that get the full refit, before one of each family is added
  std::size_t restarted = 4;  ///< of them get a second start where the best leaves much
  std::size_t most_effects = 2;
  unsigned threads = 0;    ///< 0: all cores
  double far = 2;          ///< times what is expected: a channel beyond it asks for a second effect
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
  std::vector<Explanation> single;   ///< refitted candidates, best held-out score first
  std::vector<Explanation> several;  ///< with two and more effects, best held-out score first
};

namespace detail {

inline void best_first(std::vector<Explanation>& explanations) {
  std::stable_sort(explanations.begin(), explanations.end(),
                   [](const Explanation& a, const Explanation& b) { return a.held.log_score > b.held.log_score; });
}

/// Places that share a node with `place` and have a neighbour of its other nodes instead: where the linear screening
/// may have been off by one.
inline bool beside(const ThermalNetwork& network, const std::string& place, const std::string& other) {
  const auto nodes_of = [&](const std::string& name) {
    std::vector<Index> nodes;
    for (Index i = 0; i < network.node_count(); ++i) {
      const std::string& node = network.nodes[static_cast<std::size_t>(i)].name;
      for (std::size_t at = name.find(node); at != std::string::npos; at = name.find(node, at + 1)) {
        const std::size_t end = at + node.size();
        const bool begins = at == 0 || name[at - 1] == '-' || name[at - 1] == '+';
        const bool ends = end == name.size() || name[end] == '-' || name[end] == '+';
        if (begins && ends) nodes.push_back(i);
      }
    }
    return nodes;
  };
  const std::vector<Index> here = nodes_of(place), there = nodes_of(other);
  if (here.empty() || here.size() != there.size() || here.size() > 2) return false;
  std::vector<Index> gone, come;
  for (const Index i : here)
    if (std::find(there.begin(), there.end(), i) == there.end()) gone.push_back(i);
  for (const Index i : there)
    if (std::find(here.begin(), here.end(), i) == here.end()) come.push_back(i);
  return gone.size() == 1 && come.size() == 1 && network.find_link(gone[0], come[0]) >= 0;
}

}  // namespace detail

/// Tries the whole catalogue on a campaign: calibration alone; every candidate screened; the finalists refitted
/// together with calibration; the places beside the best; then a second effect on top of the best, with a swap of the
/// first.
inline Investigation investigate(const ThermalNetwork& network, const Campaign& campaign, const EffectLibrary& library,
                                 const std::vector<ThermalNetwork::AddedEffect>& candidates,
                                 const SearchOptions& options = {}) {
  Investigation result;
  result.machine = with_complete_effects(with_placements(network), library);
  result.seen = observations_of(result.machine, campaign);
  result.folds = folds_of(result.seen.batches());
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
  result.calibrated = explained_by(inquiry, {}, {}, {}, coarse);

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
    // Second starts, from the means of the priors: for the places beside the leader, where calibration may have settled
    // in the wrong valley, and for the next best where the leader leaves much.
    say("trying other starts and the places beside", 0.6);
    const Explanation& leader = result.single.front();
    const ThermalNetwork::AddedEffect& best = leader.effects[0];
    const bool open = excess_of(misfit_of(result.seen, leader.held.residual)) > 1;
    std::vector<ThermalNetwork::AddedEffect> again;
    for (std::size_t i = 0; open && i < std::min(options.restarted, result.single.size()); ++i)
      again.push_back(result.single[i].effects[0]);
    for (const Screened& one : result.screened) {
      if (one.added.effect != best.effect || one.added.driver != best.driver ||
          !detail::beside(result.machine, best.location, one.added.location))
        continue;
      ThermalNetwork::AddedEffect near = one.added;
      near.parameters = best.parameters;
      again.push_back(std::move(near));
    }
    std::vector<Explanation> tried(again.size());
    in_parallel(again.size(), options.threads,
                [&](std::size_t i) { tried[i] = explained_by(inquiry, {again[i]}, {}, {}, refit); });
    for (Explanation& one : tried) {
      const auto known = std::find_if(result.single.begin(), result.single.end(), [&](const Explanation& other) {
        return same_place(other.effects[0], one.effects[0]);
      });
      if (known == result.single.end())
        result.single.push_back(std::move(one));
      else if (one.fit.log_posterior > known->fit.log_posterior)
        *known = std::move(one);
    }
    detail::best_first(result.single);
  }

  // A second effect, where the best single one leaves some channel far from what can be expected. Where it leaves only
  // little, a boundary or a start that differs from part to part of the machine may still be two places of one effect.
  const Vector left = result.single.empty() ? Vector() : misfit_of(result.seen, result.single[0].held.residual);
  if (options.most_effects > 1 && left.size() > 0 && excess_of(left) > 1) {
    const std::string leading = result.single[0].effects[0].effect;
    const Stage stage = library.at(leading).stage();
    const bool far = left.maxCoeff() > options.far * options.far;
    const bool spread = stage == Stage::boundary || stage == Stage::initial;
    say("looking for a second effect", 0.7);
    const auto add_to = [&](const Explanation& first, std::size_t strongest) {
      const ScreeningBase base(result.seen, first.fit, library, result.machine.effects.size());
      std::vector<ThermalNetwork::AddedEffect> others;
      for (const Screened& one : result.screened)
        if (!same_place(one.added, first.effects[0]) && (far || one.added.effect == leading))
          others.push_back(one.added);
      std::vector<Screened> screened = screen(base, library, others, options.threads);
      std::vector<Explanation> pairs =
          refits(inquiry, finalists(screened, strongest, 3, 0.3), first.effects, first.fit, refit, 3);
      for (Explanation& pair : pairs) result.several.push_back(std::move(pair));
      detail::best_first(result.several);
    };
    if (far || spread) add_to(result.single[0], 5);
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
  say("judging", 0.95);
  return result;
}

}  // namespace thermfit
