#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/machine_record.hpp"

namespace thermfit {

/// The few numbers between what was measured and probabilities: fitted by logistic regression on generated campaigns
/// and the withheld cases, and checked by leaving each case out (tests/blind/README.md).
struct Thresholds {
  /// Misfit, (rms / expected)^2, beyond which the gap of a temperature is real: the place of the thermometer within its
  /// part counts.
  double real_from_temperature = 9;
  double real_from_displacement = 2;  ///< the same of a displacement, which adds up all parts
  double least_excess = 1;            ///< below it, summed over channels, sensors only had to be placed
  double calibration_helps = 0.5;     ///< share of it that calibration must close, or none was needed
  double known_by_share = 3;          ///< log odds that the cause is known: this times the share that it closes …
  double known_by_left = 1.6;         ///< … less this times log(1 + what it leaves)
  double least_known = 0.5;           ///< probability from which the cause is named
  double least_second = 0.5;          ///< probability from which a second effect is named
  double beyond_doubt = 7;         ///< log odds of an effect (a thousand to one) that need no gap to be seen shrinking
  double law_tolerance = 0.05;     ///< share of its evidence that the form of a law may be short of, no second effect
  double suspected_from = -3.8;    ///< log odds of the best account that is not named: this …
  double suspected_by_gain = 1.1;  ///< … and this times log(1 + nats that it gains) …
  double suspected_by_left = 3.1;  ///< … less this times log(1 + what it leaves)
  double least_suspected = 0.1;    ///< probability from which it is told
  double part = 0.5;               ///< share of the gap that a part of the cause closes at least
  double listed = 0.05;            ///< rivals above this probability are listed
  double surely_shrinks = 20;      ///< percent by which the gap of some channel must shrink …
  double may_shrink = 40;          ///< … or that the upper end of its interval must reach
  double harm = 0.01;              ///< sum of log ratios by which displacements may be further off with the effect
  std::size_t proving_folds = 3;   ///< with fewer, what fits best is a suspicion
};

/// Numbers that decide, by the name of their field: what a diagnosis says that it was judged by.
using NamedNumbers = std::vector<std::pair<std::string, double>>;

/// All of them, in the order of the fields. Allocates.
inline NamedNumbers named_numbers(const Thresholds& of) {
  return {{"real_from_temperature", of.real_from_temperature},
          {"real_from_displacement", of.real_from_displacement},
          {"least_excess", of.least_excess},
          {"calibration_helps", of.calibration_helps},
          {"known_by_share", of.known_by_share},
          {"known_by_left", of.known_by_left},
          {"least_known", of.least_known},
          {"least_second", of.least_second},
          {"beyond_doubt", of.beyond_doubt},
          {"law_tolerance", of.law_tolerance},
          {"suspected_from", of.suspected_from},
          {"suspected_by_gain", of.suspected_by_gain},
          {"suspected_by_left", of.suspected_by_left},
          {"least_suspected", of.least_suspected},
          {"part", of.part},
          {"listed", of.listed},
          {"surely_shrinks", of.surely_shrinks},
          {"may_shrink", of.may_shrink},
          {"harm", of.harm},
          {"proving_folds", static_cast<double>(of.proving_folds)}};
}

/// Probability of log odds: 1 / (1 + e^-odds), 0…1.
inline double logistic(double odds) { return 1 / (1 + std::exp(-odds)); }

/// Whether this misfit is more than a right machine would leave of a channel.
inline bool is_real(const ObservedChannel& channel, double misfit, const Thresholds& thresholds) {
  return misfit > (channel.displacement ? thresholds.real_from_displacement : thresholds.real_from_temperature);
}

/// Probability that what was found is the cause rather than the nearest thing in the catalogue to an unknown one.
inline double probability_known(double closes, double leaves, const Thresholds& thresholds) {
  return logistic(thresholds.known_by_share * closes - thresholds.known_by_left * std::log1p(leaves));
}

}  // namespace thermfit
