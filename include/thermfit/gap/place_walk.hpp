#pragma once

/// From the places that the catalogue lists to the one that the data ask for.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/effects/place.hpp"
#include "thermfit/gap/explanation.hpp"

namespace thermfit::detail {

inline void best_first(std::vector<Explanation>& explanations) {
  std::stable_sort(explanations.begin(), explanations.end(),
                   [](const Explanation& a, const Explanation& b) { return plausibility(a) > plausibility(b); });
}

/// Adds an account of one effect, most plausible first; of two with the same effect at the same place the better stays.
inline void keep_better(std::vector<Explanation>& accounts, Explanation&& account) {
  const auto known = std::find_if(accounts.begin(), accounts.end(), [&](const Explanation& one) {
    return same_place(one.effects[0], account.effects[0]);
  });
  if (known == accounts.end())
    accounts.push_back(std::move(account));
  else if (plausibility(account) > plausibility(*known))
    *known = std::move(account);
  best_first(accounts);
}

/// Walks from place to place: the catalogue's list of places is coarse.
class PlaceWalk {
 public:
  /// Over the accounts, most plausible first, of which the leader's effect `position` is to find its place; it becomes
  /// the last effect of the accounts tried.
  /// `screened` is what the catalogue lists; the machine alone has `own` coordinates.
  PlaceWalk(const Inquiry& inquiry, const std::vector<Screened>& screened, Index own,
            std::vector<Explanation>& accounts, std::size_t position, const MapFitOptions& refit)
      : inquiry_(inquiry), screened_(screened), own_(own), accounts_(accounts), position_(position), refit_(refit) {}

  /// At most `most_steps` steps to the best set of nodes, or pair, around the leader; at each, all nodes whose coming
  /// or going helped are tried together too.
  void run(int most_steps) {
    for (int step = 0; step < most_steps; ++step) {
      leader_ = accounts_.front();
      std::vector<Screened> near;
      for (const std::string& place : places_beside(inquiry_.machine, moving().location))
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
    return std::any_of(screened_.begin(), screened_.end(), [&](const Screened& one) {
      return one.added.effect == moving().effect && one.added.driver == moving().driver && one.added.location == place;
    });
  }
  /// Sets of nodes for an effect that takes sets; single nodes and pairs as the catalogue lists them.
  bool allowed(const std::string& place) const {
    const bool set = place == "all" || place.find('+') != std::string::npos;
    const bool takes_sets = std::any_of(screened_.begin(), screened_.end(), [&](const Screened& one) {
      return one.added.effect == moving().effect && one.added.location.find('+') != std::string::npos;
    });
    return (set && takes_sets && inquiry_.library.accepts(inquiry_.machine, at(place).added)) || listed(place);
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
    one.start = leader_.fit.t.head(own_);
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
      const std::vector<Index> before = nodes_at(inquiry_.machine, moving().location);
      const std::vector<Index> after = nodes_at(inquiry_.machine, place);
      if (++helped == 1) nodes = before;
      for (Index i = 0; i < inquiry_.machine.node_count(); ++i) {
        const bool was = std::count(before.begin(), before.end(), i) > 0,
                   is = std::count(after.begin(), after.end(), i) > 0;
        if (!was && is) nodes.push_back(i);
        if (was && !is) nodes.erase(std::remove(nodes.begin(), nodes.end(), i), nodes.end());
      }
    }
    if (nodes.empty()) return {"", 0};
    std::sort(nodes.begin(), nodes.end());
    return {place_of(inquiry_.machine, nodes), helped};
  }

  const Inquiry& inquiry_;
  const std::vector<Screened>& screened_;
  const Index own_;
  std::vector<Explanation>& accounts_;
  std::size_t position_;
  const MapFitOptions& refit_;
  Explanation leader_;
};

}  // namespace thermfit::detail
