#pragma once

/// From the places that the catalogue lists to the one that the data ask for.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/search/refits.hpp"
#include "thermfit/effects/place.hpp"

namespace thermfit::detail {

/// Adds an account of one effect, most plausible first; of two with the same effect at the same place the better stays.
inline void keep_better(std::vector<Account>& accounts, Account&& account) {
  const auto known = std::find_if(accounts.begin(), accounts.end(),
                                  [&](const Account& one) { return same_place(one.effects[0], account.effects[0]); });
  if (known == accounts.end())
    accounts.push_back(std::move(account));
  else if (plausibility(account) > plausibility(*known))
    *known = std::move(account);
  best_first(accounts);
}

/// Walks from place to place: the catalogue's list of places is coarse.
template <typename Scalar = double>
class PlaceWalk {
 public:
  /// Over the accounts, most plausible first, of which the leader's effect `position` is to find its place; it becomes
  /// the last effect of the accounts tried.
  /// `screened` is what the catalogue lists; the machine alone has `own` coordinates.
  PlaceWalk(const SearchContext& context, const std::vector<Candidate>& screened, Index own,
            std::vector<Account>& accounts, std::size_t position, const MapFitOptions& refit)
      : context_(context), screened_(screened), own_(own), accounts_(accounts), position_(position), refit_(refit) {}

  /// At most `most_steps` steps to the best set of nodes, or pair, around the leader; at each, all nodes whose coming
  /// or going helped are tried together too.
  void run(int most_steps) {
    for (int step = 0; step < most_steps; ++step) {
      leader_ = accounts_.front();
      std::vector<Candidate> near;
      for (const std::string& place : places_beside(context_.machine, moving().location))
        if (allowed(place) && !tried(place)) near.push_back(at(place));
      std::vector<Account> reached = refitted(near, 1, 2);
      const auto [place, steps] = together(reached);
      if (steps > 1 && !tried(place))
        for (Account& one : refitted({at(place)}, steps, 1)) reached.push_back(std::move(one));
      for (Account& one : reached) accounts_.push_back(std::move(one));
      best_first(accounts_);
      if (same_place(accounts_.front().effects.back(), moving())) break;
      position_ = leader_.effects.size() - 1;
    }
  }

 private:
  const ThermalNetwork::AddedEffect& moving() const { return leader_.effects[position_]; }

  bool listed(const std::string& place) const {
    return std::any_of(screened_.begin(), screened_.end(), [&](const Candidate& one) {
      return one.added.effect == moving().effect && one.added.driver == moving().driver && one.added.location == place;
    });
  }
  /// Sets of nodes for an effect that takes sets; single nodes and pairs as the catalogue lists them.
  bool allowed(const std::string& place) const {
    const bool set = place == "all" || place.find('+') != std::string::npos;
    const bool takes_sets = std::any_of(screened_.begin(), screened_.end(), [&](const Candidate& one) {
      return one.added.effect == moving().effect && one.added.location.find('+') != std::string::npos;
    });
    return (set && takes_sets && context_.library.accepts(context_.machine, at(place).added)) || listed(place);
  }
  bool tried(const std::string& place) const {
    ThermalNetwork::AddedEffect moved = moving();
    moved.location = place;
    return std::any_of(accounts_.begin(), accounts_.end(), [&](const Account& one) {
      return one.effects.size() == leader_.effects.size() &&
             std::any_of(one.effects.begin(), one.effects.end(),
                         [&](const auto& effect) { return same_place(effect, moved); });
    });
  }
  Candidate at(const std::string& place) const {
    Candidate one;
    one.added = moving();
    one.added.location = place;
    const VectorX<Scalar>& coordinates = leader_.fit.coordinates;
    one.start = coordinates.head(own_);
    return one;
  }
  std::vector<Account> refitted(const std::vector<Candidate>& chosen, int steps, std::size_t to_the_end) const {
    std::vector<ThermalNetwork::AddedEffect> kept = leader_.effects;
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(position_));
    std::vector<Account> result = refits<Scalar>(context_, chosen, kept, leader_.fit, refit_, to_the_end);
    for (Account& one : result) one.steps = listed(one.effects.back().location) ? 0 : leader_.steps + steps;
    return result;
  }
  /// The place that takes all single steps that helped, and how many they are.
  std::pair<std::string, int> together(const std::vector<Account>& reached) const {
    int helped = 0;
    std::vector<Index> nodes;
    for (const Account& one : reached) {
      const std::string& place = one.effects.back().location;
      if (plausibility(one) <= plausibility(leader_) || (place != "all" && place.find('+') == std::string::npos))
        continue;
      const std::vector<Index> before = nodes_at(context_.machine, moving().location);
      const std::vector<Index> after = nodes_at(context_.machine, place);
      if (++helped == 1) nodes = before;
      for (Index i = 0; i < context_.machine.node_count(); ++i) {
        const bool was = std::count(before.begin(), before.end(), i) > 0,
                   is = std::count(after.begin(), after.end(), i) > 0;
        if (!was && is) nodes.push_back(i);
        if (was && !is) nodes.erase(std::remove(nodes.begin(), nodes.end(), i), nodes.end());
      }
    }
    if (nodes.empty()) return {"", 0};
    std::sort(nodes.begin(), nodes.end());
    return {place_of(context_.machine, nodes), helped};
  }

  const SearchContext& context_;
  const std::vector<Candidate>& screened_;
  const Index own_;
  std::vector<Account>& accounts_;
  std::size_t position_;
  const MapFitOptions& refit_;
  Account leader_;
};

}  // namespace thermfit::detail
