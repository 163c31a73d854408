#pragma once

#include "thermfit/diagnosis/judgement/thresholds.hpp"

namespace thermfit {

/// The numbers between the outputs of a simulator and a verdict on them. Set on the withheld cases and generated
/// campaigns (tests/blind); gaps are rms, in units of the noise of a single sample where `_noises`.
struct OutputThresholds {
  double decisive_nats = 60;          ///< evidence over calibration that a named effect must have …
  double further = 2;                 ///< … and a further one, times this: a first leaves the mismatch of its trace
  int most_effects = 3;               ///< named at most
  double least_softness_nats = 3;     ///< differences of evidence below this decide nothing, …
  double softness_share = .03;        ///< … nor below this share of it: traces are approximations
  double most_certain = .99;          ///< no probability is told above it
  double known_from = -.3;            ///< log odds that a trace is the cause and no imitation: this …
  double known_by_share = 3.7;        ///< … and this times the share of its gap that it closes …
  double known_like_lumping = 2.2;    ///< … less this where lags alone shape it
  double least_named = 1. / 3;        ///< probability from which an effect is named
  double suspected_from = -7.5;       ///< log odds of the best account that is not decisive: this …
  double suspected_by_gain = 1.3;     ///< … and this times log(1 + nats) …
  double suspected_by_share = 2.6;    ///< … and this times the share that it closes
  double least_suspected = .1;        ///< probability from which it is told
  double none_below_noises = 1.7;     ///< as simulated: no gap
  double closed_below_noises = 2;     ///< calibrated: closed by calibration …
  double nearly_closed_noises = 4;    ///< … or below this, if calibration
  double calibration_left = .4;       ///< leaves no more than this share
  double left_per_channel = 15;       ///< squared noises beyond one, a channel: too much is left …
  double left_share = .3;             ///< … if it is more than this share of what calibration leaves
  double helps_displacement = .8;     ///< a further effect must lower the gap of the displacement to this share …
  double helps_thermometer = .5;      ///< … or that of its own thermometer to this
  double fault_leaves = .67;          ///< a faulty thermometer beside a gap without a name: of its own gap at most
  double placement_tolerance_K = .5;  ///< what a thermometer may be off because of where it sits
  double loosest = .5;                ///< calibration is as loose as the median channel needs, but no looser
};

/// All of them, in the order of the fields. Allocates.
inline NamedNumbers named_numbers(const OutputThresholds& of) {
  return {{"decisive_nats", of.decisive_nats},
          {"further", of.further},
          {"most_effects", static_cast<double>(of.most_effects)},
          {"least_softness_nats", of.least_softness_nats},
          {"softness_share", of.softness_share},
          {"most_certain", of.most_certain},
          {"known_from", of.known_from},
          {"known_by_share", of.known_by_share},
          {"known_like_lumping", of.known_like_lumping},
          {"least_named", of.least_named},
          {"suspected_from", of.suspected_from},
          {"suspected_by_gain", of.suspected_by_gain},
          {"suspected_by_share", of.suspected_by_share},
          {"least_suspected", of.least_suspected},
          {"none_below_noises", of.none_below_noises},
          {"closed_below_noises", of.closed_below_noises},
          {"nearly_closed_noises", of.nearly_closed_noises},
          {"calibration_left", of.calibration_left},
          {"left_per_channel", of.left_per_channel},
          {"left_share", of.left_share},
          {"helps_displacement", of.helps_displacement},
          {"helps_thermometer", of.helps_thermometer},
          {"fault_leaves", of.fault_leaves},
          {"placement_tolerance_K", of.placement_tolerance_K},
          {"loosest", of.loosest}};
}

}  // namespace thermfit
