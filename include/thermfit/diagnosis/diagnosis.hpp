#pragma once

/// What a diagnosis says, as codes and numbers: the members of `thermfit-diagnosis/1`, in the same order and with the
/// same names. No algorithm and no sentence lives here; diagnosis/diagnose.hpp fills it, a report puts it into words.

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/fitted_batch.hpp"
#include "thermfit/network/schedule.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// What stood for the simulator.
enum class SimulatorKind {
  network,  ///< a machine file: effects were added to it
  outputs   ///< somebody else's, of which only the outputs were at hand
};

/// What a diagnosis decides.
enum class Verdict {
  none,            ///< the machine as given is already at the noise
  miscalibration,  ///< moving the parameters the machine has closes the gap
  effect,          ///< one or several effects explain it and their rivals do not
  ambiguous,       ///< several explanations remain above 5 %
  unknown          ///< the gap is real and nothing in the catalogue closes it on held-out batches
};

/// The word of the document for it.
inline const char* word_of(Verdict verdict) {
  constexpr std::array<const char*, 5> words{"none", "miscalibration", "effect", "ambiguous", "unknown"};
  return words[static_cast<std::size_t>(verdict)];
}

/// From `low` to `high`, in the unit that its user names.
struct Interval {
  double low = 0;   ///< may be infinite, as `high`
  double high = 0;  ///< never below `low`
};

/// A fitted number. `standard_error` is negative when the data do not pin it.
struct Estimate {
  std::string name;            ///< key of the parameter in the machine document: "power_W"
  std::string unit;            ///< "W"; empty for a pure number
  double value = 0;            ///< in `unit`
  double standard_error = -1;  ///< in `unit`; 0 for a number that is chosen, not fitted
};

/// An explanation that was not chosen.
struct Rival {
  std::string effect;     ///< name in the library
  std::string location;   ///< where it acts
  std::string driver;     ///< empty where the effect has none
  double confidence = 0;  ///< probability, 0…1
};

/// An effect that is named, at its place, with what could be in its stead.
struct FoundEffect {
  std::string effect;                   ///< name in the library
  std::string location;                 ///< where it acts
  std::string driver;                   ///< empty where the effect has none
  double confidence = 0;                ///< calibrated probability, 0…1, of effect and place together
  std::vector<Estimate> parameters;     ///< of its law; where no network is known, also how large it shows
  std::vector<Rival> alternatives;      ///< strongest first; all of them above 5 %
  std::vector<std::string> same_place;  ///< places that cannot be told from `location` on these data
  std::string meaning;                  ///< what the effect says of itself, Effect::meaning()
  bool against_as_given = false;        ///< calibration can do the same: it counts against the machine as given
  double closes = 0;                    ///< share of the squared gap beyond expectation, on held-out batches
};

/// Why an explanation that was tried was dropped.
enum class RuledOutBy {
  no_shrink,    ///< the held-out gap does not shrink
  share,        ///< it closes `value` of the held-out gap, the best account `best` (NaN where none is named)
  calibration,  ///< no better than calibration: `value` nats
  evidence,     ///< `value` nats behind the best
  strength,     ///< fits only with `value` times the strength of its law
  sign,         ///< the thermometers respond with the wrong sign
  elsewhere,    ///< other thermometers than its own respond most
  same_sign,    ///< both ends of a heat exchange respond with the same sign
  remains       ///< not ruled out: closes most, the share `value` (0: not known), but leaves too much for a name
};

/// An effect that was tried and dropped, at the place where it fitted best.
struct RuledOut {
  std::string effect;                                      ///< name in the library
  std::string location;                                    ///< where it fitted best
  RuledOutBy by = RuledOutBy::no_shrink;                   ///< why
  double value = 0;                                        ///< what RuledOutBy says of it
  double best = std::numeric_limits<double>::quiet_NaN();  ///< see RuledOutBy::share
};

/// rms of measured minus simulated on batches not used for fitting, at the levels of the diagnosis.
struct GapLevels {
  double as_simulated = 0;  ///< the simulator as given
  double calibrated = 0;    ///< its parameters moved
  double with_effect = 0;   ///< and the effects named added; as calibrated where none is
  double noise = 0;         ///< of the readings, which no model predicts
};

/// The gap of one channel over all batches.
struct ChannelGap {
  std::string channel;  ///< name of its column
  std::string unit;     ///< um or K
  GapLevels rms;        ///< in `unit`
};

/// The gap of one batch.
struct BatchGap {
  std::string batch;  ///< its name
  GapLevels rms;      ///< of the displacement output, or of all temperatures where the machine has none
};

/// Accuracy and robustness of a compensation model trained on simulated batches and scored on real ones, um: eq. (10),
/// (12), (13), for the simulator as given, calibrated, with the effect. Empty `points` means it was not computed.
struct Transfer {
  std::vector<std::string> points;  ///< temperature columns that the model uses
  std::array<double, 3> S_mean{};   ///< um, by level
  std::array<double, 3> S_std{};    ///< um, by level
};

/// How large the gap is, and how much of it the effect closes.
struct Gap {
  std::string output;                        ///< empty: all temperatures together
  std::string unit;                          ///< um or K
  GapLevels rms;                             ///< over all batches, in `unit`
  double shrink_percent = 0;                 ///< 100 (1 - with_effect / calibrated)
  Interval shrink_ci95_percent;              ///< from resampling whole batches
  double shrink_of_explainable_percent = 0;  ///< noise subtracted in square
  Transfer transfer;                         ///< what the gap costs a compensation model
  std::vector<BatchGap> per_batch;           ///< in the order of Diagnosis::batches
  std::vector<ChannelGap> per_sensor;        ///< of every temperature compared; with a network, of displacements too
  bool held_out = true;                      ///< false: too few batches, the figures are those of the fit itself
};

/// A part of the square of the gap that the calibrated machine leaves, 0…1.
struct NamedShare {
  std::string name;  ///< of a stage or a place
  double share = 0;  ///< 0…1
};

/// `factor` with either a `level` ("warm-up", a batch name, "on") or a range of a numeric input.
struct ConditionShare {
  std::string factor;        ///< an input, the ambient column, "phase" or "batch"
  std::string level;         ///< empty where it is a range
  bool is_range = false;     ///< `range` counts, not `level`
  bool settable = false;     ///< an input, held at levels, which an experiment can set; no temperature
  Interval range;            ///< of the values of the factor, in its unit
  double share = 0;          ///< of the square of the gap, 0…1; those of one factor add up to 1
  double rms = 0;            ///< of the gap under this condition, in the unit of the output
  double share_of_time = 0;  ///< of all samples; a share far above it is where the gap lies
};

/// The part of the gap that changes with periods in one band.
struct PeriodShare {
  Interval period_min;  ///< minutes; infinity to infinity for an offset that lasts the whole batch
  double share = 0;     ///< of the square of the gap, 0…1
};

/// Exact split of the displacement gap by feeding measured temperatures into the expansion sum.
struct ChainSplit {
  bool known = false;          ///< false where no displacement or too few sensed nodes
  double total_um = 0;         ///< rms of measured minus simulated displacement
  double temperature_um = 0;   ///< rms of the part that temperatures carry
  double expansion_um = 0;     ///< rms of the part that remains with true temperatures
  double um_per_K_sensed = 0;  ///< share of the expansion coefficients' magnitude on nodes that have a sensor, 0…1
};

/// Where the gap lies that the calibrated machine leaves: in the chain, on the machine, in conditions and in time.
struct Where {
  std::vector<NamedShare> stages;          ///< heat, boundary, conduction, expansion, measurement, initial
  std::vector<NamedShare> places;          ///< effect-free estimate, strongest first
  std::vector<ConditionShare> conditions;  ///< by input, ambient, phase and batch
  std::vector<PeriodShare> frequency;      ///< by period, shortest first; bands without content are left out
  ChainSplit chain;                        ///< temperatures or what is made of them
  bool agrees = true;                      ///< the effect-free place is one the first effect can act on
  std::string free_place{};                ///< where it is not: the place that explains most without assuming an effect
  std::string effect_place{};              ///< and the one at which the effect acts
};

/// What the residual of one channel looks like.
struct RemainingLook {
  /// What is left in the channel.
  enum class Kind {
    too_few,         ///< samples to say
    noise,           ///< hardly larger than the noise estimate
    shaped,          ///< one or several of the three below
    louder_noise,    ///< white, but larger than the noise estimate
    slow_unrecorded  ///< slow changes that follow nothing recorded
  };
  std::string channel;        ///< empty: the output of the gap
  Kind kind = Kind::too_few;  ///< the first that fits
  double offset_share = 0;    ///< of the square: one value a batch; 0 where it is less than a third
  double trend_share = 0;     ///< of the square: a straight line in time; 0 where it is less than a third
  std::string follows;        ///< the recorded course it follows; empty: none
  double correlation = 0;     ///< with it
  double lag_min = 0;         ///< behind it
  double noise = 0;           ///< the noise estimate, in the unit of the gap
};

/// What is left after the best explanation.
struct Remaining {
  bool white = false;                ///< by the cumulated periodogram of the output's residual
  double unexplained = 0;            ///< sqrt(with_effect^2 - noise^2), never negative, in the unit of the gap
  std::vector<RemainingLook> looks;  ///< of the output of the gap; without one, of every temperature
};

/// What to measure next: to tell explanations apart, to locate a gap without a name, or to pin a parameter.
struct NextExperiment {
  /// What the plan cannot do, or needs besides.
  enum class Remark {
    none,               ///< nothing to add
    nothing_separates,  ///< no schedule tells the first two of `separates` apart well; a thermometer there would
    not_foreseeable,    ///< without the network the probability of confusion cannot be given
    thermometer_near,   ///< add one near `subject`, where the gap lies most
    not_pinned          ///< the parameter `subject` is not pinned by these data
  };
  std::vector<Rival> separates;    ///< the explanations it tells apart
  std::vector<PlannedBlock> plan;  ///< in the order in which to run it; empty: nothing to propose
  double expected_confidence = 0;  ///< after the plan, 0…1; NaN where it cannot be foreseen, as the next two
  double confusion_before = 0;     ///< probability that the strongest rival is mistaken for the truth
  double confusion_after = 0;      ///< the same after the plan
  Remark remark = Remark::none;    ///< at most one
  std::string subject;             ///< a place or a parameter, as `remark` says
};

/// How far a parameter of the machine moved in calibration.
struct CalibrationMove {
  std::string parameter;  ///< "capacity of head_front"
  std::string unit;       ///< of `from` and `to`; empty for a pure number
  double from = 0;        ///< as given
  double to = 0;          ///< calibrated
  double prior_sds = 0;   ///< that it moved, in prior deviations, signed
  bool pinned = true;     ///< the data, not the prior, decide it
};

/// What the verdict rests on: the account that comes nearest, named or not.
struct Support {
  std::size_t candidates = 0;  ///< effects at places that were tried
  std::vector<Rival> nearest;  ///< effects of the account; empty where nothing was worth a closer look
  double gain_nats = 0;        ///< of its evidence over calibration alone
  double rival = 0;            ///< share of it that another effect would reach in its stead
  double closes = 0;           ///< share of the squared gap beyond expectation, on held-out batches
  double leaves = 0;           ///< squared gap beyond expectation, in units of what is expected
};

/// A fault of the data: of one side by itself, or seen where the two sides are laid beside each other.
struct DataProblem {
  /// What is wrong.
  enum class Kind {
    not_measured,   ///< thermometers of the machine file that the batches lack
    not_modelled,   ///< thermometers of the batches that the machine file lacks; left out
    not_simulated,  ///< channels of the batches that the simulator's output lacks; left out
    not_paired,     ///< a batch without a simulated counterpart; left out
    resampled,      ///< sampling differs: simulated values are read off at measured times
    finding,        ///< of a rule on single batches (findings/): stuck, spike, gap, …
    left_out,       ///< cells that are no readings: read off between their neighbours instead
    unit,           ///< `names` are written in `unit`, not in degC or um
    factor,         ///< `names` move `figure` times as much as on the other side: counts?
    sign,           ///< `names` have the other sign: errors here, corrections there
    swapped,        ///< each of `names` holds what belongs to the next, the last what belongs to the first
    copied,         ///< the second of `names` holds the first once more
    clock_unit,     ///< times are `figure` times too long
    clock_offset,   ///< everything measured comes `figure` seconds later than simulated
    datum,          ///< the probe of `names` counts from another zero in each of `batches`, `figure` um at most, each
                    ///< in the note; left free
    warm_start      ///< `batches` do not start in equilibrium, `channel` of `batch` stands `figure` K off the room
  };
  /// The column of which side it is.
  enum class Side {
    measured,   ///< of the batches
    simulated,  ///< of the simulator
    either      ///< the data cannot tell
  };
  Kind kind = Kind::finding;           ///< says which of the others are filled
  std::vector<std::string> names;      ///< channels, or a batch
  std::string batch;                   ///< of a finding
  std::string channel;                 ///< of a finding; `time` for the clock
  std::string rule;                    ///< of a finding: "stuck"
  std::string note;                    ///< of a finding: what it means, in a few words
  Side side = Side::measured;          ///< of a difference between the sides
  bool certain = false;                ///< nothing else within belief does that: no effect is named on top of it
  double figure = 0;                   ///< see Kind
  double nats = 0;                     ///< log of how much more probable it makes the data than all else within belief
  std::string unit{};                  ///< see Kind
  std::vector<std::string> batches{};  ///< in which it is so; empty: in all
};

/// What was done about a warm start, as DataProblem::rule says it.
constexpr const char* starts_were_fitted = "fitted";

/// What these data do not allow to say.
struct WeakerClaim {
  /// What is missing, and what it forbids.
  enum class Kind {
    one_batch,        ///< nothing can be judged on data not used for fitting
    few_batches,      ///< held-out figures rest on few
    constant_input,   ///< `subject` never changes
    lone_input,       ///< `subject` is on in `batch` alone
    no_network,       ///< no power, no place between the thermometers, no machine with the effect
    no_ambient,       ///< effects of the room cannot be told apart
    no_displacement,  ///< expansion and probe were not looked at
    gap_beside        ///< a gap without a name remains in `names`
  };
  Kind kind = Kind::one_batch;     ///< says which of the others are filled
  std::string subject;             ///< an input
  std::string batch;               ///< of a lone input
  std::vector<std::string> names;  ///< channels with a gap that no effect explains
  std::size_t batches = 0;         ///< in the campaign
};

/// Why a simulator disagrees with measured batches: the verdict, what it rests on, and what to do next.
struct Diagnosis {
  SimulatorKind simulator = SimulatorKind::network;  ///< decides how much can be said
  std::string machine;                               ///< its name; empty where the simulator was not a network
  std::vector<std::string> batches;                  ///< names of those compared
  Verdict verdict = Verdict::unknown;                ///< `effects` is empty unless it is `effect` or `ambiguous`
  bool unlike_sides = false;  ///< the sides are not written down alike (data_problems): nothing else was looked for
  std::vector<FoundEffect> effects;    ///< named: strongest first
  std::vector<FoundEffect> parts;      ///< act beyond doubt, at that place by that driver, but more remains: no names
  std::vector<FoundEffect> suspected;  ///< the best account, or one more beside the named, short of evidence: no names
  Gap gap;                             ///< how large, level by level
  Where where;                         ///< on the machine and in time
  Remaining remaining;                 ///< after the best explanation, channel by channel
  NextExperiment next_experiment;      ///< to decide what is left open
  std::vector<RuledOut> ruled_out;     ///< each effect once
  Support support;                     ///< numbers behind the verdict
  std::vector<CalibrationMove> calibration;  ///< largest move first
  std::vector<FittedBatch> fitted_batches;   ///< starts and rooms, where the machine's rules leave them open
  std::vector<DataProblem> data_problems;    ///< seen on the way
  std::vector<WeakerClaim> weaker_claims;    ///< what the data do not allow to say
  std::vector<std::pair<std::string, double>> judged_by;  ///< the numbers that decided, by name
  /// The machine calibrated, with the effects found; without nodes where the simulator was not a network.
  ThermalNetwork with_effects;
};

}  // namespace thermfit
