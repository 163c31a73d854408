#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/diagnosis/search/search.hpp"

namespace thermfit {

/// The few numbers between what was measured and probabilities: fitted by logistic regression on generated campaigns
/// and the withheld cases, and checked by leaving each case out (tests/blind/README.md).
struct JudgingOptions {
  /// Misfit, (rms / expected)^2, beyond which a gap is real: of a temperature, where the place of the thermometer
  /// within its part counts, and of a displacement, which adds up all parts.
  double real_from_temperature = 9, real_from_displacement = 2;
  double least_excess = 1;         ///< below it, summed over channels, sensors only had to be placed
  double calibration_helps = 0.5;  ///< share of it that calibration must close, or none was needed
  double known_by_share = 3;       ///< log odds that the cause is known: this times the share that it closes …
  double known_by_left = 1.6;      ///< … less this times log(1 + what it leaves)
  double beyond_doubt = 7;         ///< log odds of an effect (a thousand to one) that need no gap to be seen shrinking
  double law_tolerance = 0.05;     ///< share of its evidence that the form of a law may be short of, no second effect
  double listed = 0.05;            ///< rivals above this probability are listed
};

inline double logistic(double odds) { return 1 / (1 + std::exp(-odds)); }

/// Probabilities of several accounts of the same campaign.
inline std::vector<double> probabilities(const std::vector<Account>& accounts) {
  std::vector<double> result;
  double best = -INFINITY, sum = 0;
  for (const Account& one : accounts) best = std::max(best, plausibility(one));
  for (const Account& one : accounts) {
    result.push_back(std::exp(plausibility(one) - best));
    sum += result.back();
  }
  for (double& one : result) one /= sum;
  return result;
}

/// What an account does on held-out batches to the gap that calibration leaves. Channels weigh by the log score that
/// the account gains in them: a wandering thermometer elsewhere on the machine speaks neither for nor against it.
struct Closure {
  double share = 1;  ///< of the squared gap beyond expectation that it closes; 1 where there was nothing to close
  double left = 0;   ///< squared gap beyond expectation that it leaves, in units of what is expected
};

inline Closure closure_of(const MachineRecord& seen, const HeldOut& before, const HeldOut& after) {
  const Vector gained = (after.by_channel - before.by_channel).cwiseMax(0);
  if (!(gained.sum() > 0)) return {0, excess_of(misfit_of(seen, after.residual))};
  const Vector from = (misfit_of(seen, before.residual).array() - 1).max(0);
  const Vector to = (misfit_of(seen, after.residual).array() - 1).max(0);
  Closure result{0, 0};
  for (Index c = 0; c < gained.size(); ++c) {
    const double weight = gained(c) / gained.sum();
    result.share += weight * (from(c) > 0 ? std::clamp(1 - to(c) / from(c), 0.0, 1.0) : 1.0);
    result.left += weight * to(c);
  }
  return result;
}

/// Whether this is more than a right machine would leave of a channel.
inline bool is_real(const ObservedChannel& channel, double misfit, const JudgingOptions& options) {
  return misfit > (channel.displacement ? options.real_from_displacement : options.real_from_temperature);
}

/// Whether calibration leaves what no right machine would.
inline bool gap_is_real(const MachineRecord& seen, const ChannelResiduals& calibrated, const JudgingOptions& options) {
  const Vector misfit = misfit_of(seen, calibrated);
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    if (is_real(seen.channels[c], misfit(static_cast<Index>(c)), options)) return true;
  return false;
}

/// The same for an account of how heat moves through the machine, which must also close what is really open (
/// gap_is_real), wherever that is: the worse of both counts. Channels with a real gap weigh by it.
inline Closure closure_of_heat(const MachineRecord& seen, const HeldOut& before, const HeldOut& after,
                               const JudgingOptions& options) {
  Closure result = closure_of(seen, before, after);
  const Vector from = misfit_of(seen, before.residual), to = misfit_of(seen, after.residual);
  double excess = 0, share = 0, left = 0;
  for (std::size_t k = 0; k < seen.channels.size(); ++k) {
    const Index c = static_cast<Index>(k);
    if (!is_real(seen.channels[k], from(c), options)) continue;
    const double weight = from(c) - 1, remains = std::max(0.0, to(c) - 1);
    excess += weight;
    share += std::max(0.0, weight - remains);
    left += weight * remains;
  }
  if (excess <= 0) return result;
  return {std::min(result.share, share / excess), std::max(result.left, left / excess)};
}

/// Probability that what was found is the cause rather than the nearest thing in the catalogue to an unknown one.
inline double probability_known(double closes, double leaves, const JudgingOptions& options) {
  return logistic(options.known_by_share * closes - options.known_by_left * std::log1p(leaves));
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
inline std::vector<Marginal> marginals(const std::vector<Account>& accounts, const std::vector<double>& weight,
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
