#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/gap/investigate.hpp"

namespace thermfit {

/// The few numbers between scores and probabilities. They were set by hand on development cases, among them some of
/// data/withheld, and are not calibrated yet: read a confidence as an order, not as a frequency.
struct JudgingOptions {
  /// Log scores count by this power: lumping errors repeat from batch to batch, so nats of held-out score are not worth
  /// what they would be if the model were exact (a coarsened likelihood).
  double score_power = 0.1;
  double least_excess = 1;      ///< below it a gap is what a right machine leaves
  double least_gain = 100;      ///< nats of score and evidence that make an effect credible below that
  double half_closed = 0.55;    ///< share of the excess that an effect closes at which known and unknown are even
  double closing_width = 0.07;  ///< of the logistic curve around it
  double second_closes = 0.5;   ///< share of what one effect leaves that a second must close to be named
  double listed = 0.05;         ///< rivals above this probability are listed
  double offset_odds = 3;       ///< log odds beyond which an offset is a fault and not a tolerance
};

/// Probabilities of several accounts of the same campaign, from their held-out scores.
inline std::vector<double> probabilities(const std::vector<Explanation>& accounts, double score_power) {
  std::vector<double> result;
  double best = -INFINITY, sum = 0;
  for (const Explanation& one : accounts) best = std::max(best, one.held.log_score);
  for (const Explanation& one : accounts) {
    result.push_back(std::exp(score_power * (one.held.log_score - best)));
    sum += result.back();
  }
  for (double& one : result) one /= sum;
  return result;
}

/// Probability that what was found is the cause rather than the nearest thing in the catalogue to an unknown one, from
/// the share of the excess that it closes on held-out batches.
inline double probability_known(double closed_share, const JudgingOptions& options) {
  return 1 / (1 + std::exp(-(closed_share - options.half_closed) / options.closing_width));
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
inline std::vector<Marginal> marginals(const std::vector<Explanation>& accounts, const std::vector<double>& weight,
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
