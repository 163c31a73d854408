#pragma once

/// Probabilities of accounts, and of the effects in them.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/search/account.hpp"

namespace thermfit {

/// Probabilities of several accounts of the same campaign.
inline std::vector<double> probabilities(const std::vector<Account>& accounts) {
  std::vector<double> result;
  double best = -std::numeric_limits<double>::infinity(), sum = 0;
  for (const Account& one : accounts) best = std::max(best, plausibility(one));
  for (const Account& one : accounts) {
    result.push_back(std::exp(plausibility(one) - best));
    sum += result.back();
  }
  for (double& one : result) one /= sum;
  return result;
}

/// One effect of an account with its rivals: the accounts marginalised over everything but the effect in question.
struct Marginal {
  std::size_t leader = 0;           ///< account that represents it
  std::size_t position = 0;         ///< of the effect in that account
  double probability = 0;           ///< of the effect with all places that count as the same
  std::vector<std::string> places;  ///< of the same effect, more than `listed` of the best place, best first
};

/// Sums the probabilities of accounts by effect (and driver), strongest first. One effect named `besides` is left out
/// of each account: what an account of two says about the other one.
template <typename Scalar = double>
std::vector<Marginal> marginals(const std::vector<Account>& accounts, const std::vector<double>& weight,
                                const std::string& besides, double listed) {
  struct Entry {
    std::string effect, driver;
    Marginal marginal;
    double best = 0;
  };
  std::vector<Entry> entries;
  std::vector<std::size_t> order(accounts.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weight[a] > weight[b]; });
  for (const std::size_t i : order)
    for (std::size_t k = 0, left_out = 0; weight[i] > 0 && k < accounts[i].effects.size(); ++k) {
      const ThermalNetwork::AddedEffect& one = accounts[i].effects[k];
      if (one.effect == besides && left_out++ == 0) continue;
      auto entry = std::find_if(entries.begin(), entries.end(), [&](const Entry& known) {
        return known.effect == one.effect && known.driver == one.driver;
      });
      if (entry == entries.end()) {
        entries.push_back({one.effect, one.driver, {i, k, 0, {}}, weight[i]});
        entry = entries.end() - 1;
      }
      entry->marginal.probability += weight[i];
      const bool listed_already = std::find(entry->marginal.places.begin(), entry->marginal.places.end(),
                                            one.location) != entry->marginal.places.end();
      if (!listed_already && weight[i] > listed * entry->best) entry->marginal.places.push_back(one.location);
    }
  std::vector<Marginal> result;
  for (Entry& entry : entries) result.push_back(std::move(entry.marginal));
  std::stable_sort(result.begin(), result.end(),
                   [](const Marginal& a, const Marginal& b) { return a.probability > b.probability; });
  return result;
}

}  // namespace thermfit
