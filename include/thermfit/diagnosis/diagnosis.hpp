#pragma once

/// What a diagnosis says, as codes and numbers: the members of `thermfit-diagnosis/1`, in the same order and with the
/// same names. No algorithm and no sentence lives here; diagnosis/diagnose.hpp fills it, a report puts it into words.

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/network/schedule.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// What stood for the simulator.
enum class SimulatorKind {
  network,  ///< a machine file: effects were added to it
  outputs   ///< somebody else's, of which only the outputs were at hand
};

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

struct Interval {
  double low = 0, high = 0;
};

/// A fitted number. `standard_error` is negative when the data do not pin it.
struct Estimate {
  std::string name;
  std::string unit;
  double value = 0;
  double standard_error = -1;
};

/// An explanation that was not chosen.
struct Rival {
  std::string effect, location, driver;
  double confidence = 0;  ///< probability, 0…1
};

struct FoundEffect {
  std::string effect, location, driver;  ///< `driver` is empty where the effect has none
  double confidence = 0;                 ///< calibrated probability, 0…1, of effect and place together
  std::vector<Estimate> parameters;
  std::vector<Rival> alternatives;      ///< strongest first; all of them above 5 %
  std::vector<std::string> same_place;  ///< places that cannot be told from `location` on these data
  std::string meaning;                  ///< what the effect says of itself, Effect::meaning()
  bool against_as_given = false;        ///< calibration can do the same: it counts against the machine as given
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
  remains       ///< comes nearest, but leaves too much on batches left out
};

struct RuledOut {
  std::string effect, location;
  RuledOutBy by = RuledOutBy::no_shrink;
  double value = 0;
  double best = std::numeric_limits<double>::quiet_NaN();
};

/// rms of measured minus simulated on batches not used for fitting, at the levels of the diagnosis.
struct GapLevels {
  double as_simulated = 0, calibrated = 0, with_effect = 0, noise = 0;
};

struct ChannelGap {
  std::string channel, unit;
  GapLevels rms;
};

struct BatchGap {
  std::string batch;
  GapLevels rms;  ///< of the displacement output, or of all temperatures where the machine has none
};

/// Accuracy and robustness of a compensation model trained on simulated batches and scored on real ones, um: eq. (10),
/// (12), (13), for the simulator as given, calibrated, with the effect. Empty `points` means it was not computed.
struct Transfer {
  std::vector<std::string> points;
  std::array<double, 3> S_mean{}, S_std{};
};

struct Gap {
  std::string output;  ///< empty: all temperatures together
  std::string unit;    ///< um or K
  GapLevels rms;
  double shrink_percent = 0;                 ///< 100 (1 - with_effect / calibrated)
  Interval shrink_ci95_percent;              ///< from resampling whole batches
  double shrink_of_explainable_percent = 0;  ///< noise subtracted in square
  Transfer transfer;
  std::vector<BatchGap> per_batch;
  std::vector<ChannelGap> per_sensor;
  bool held_out = true;  ///< false: too few batches, the figures are those of the fit itself
};

/// A part of the square of the gap that the calibrated machine leaves, 0…1.
struct NamedShare {
  std::string name;
  double share = 0;
};

/// `factor` with either a `level` ("warm-up", a batch name, "on") or a range of a numeric input.
struct ConditionShare {
  std::string factor, level;
  bool is_range = false;
  Interval range;
  double share = 0;
  double rms = 0;            ///< of the gap under this condition, in the unit of the output
  double share_of_time = 0;  ///< of all samples; a share far above it is where the gap lies
};

struct PeriodShare {
  Interval period_min;  ///< minutes
  double share = 0;
};

/// Exact split of the displacement gap by feeding measured temperatures into the expansion sum.
struct ChainSplit {
  bool known = false;          ///< false where no displacement or too few sensed nodes
  double total_um = 0;         ///< rms of measured minus simulated displacement
  double temperature_um = 0;   ///< rms of the part that temperatures carry
  double expansion_um = 0;     ///< rms of the part that remains with true temperatures
  double um_per_K_sensed = 0;  ///< share of the expansion coefficients' magnitude on nodes that have a sensor, 0…1
};

struct Where {
  std::vector<NamedShare> stages;  ///< heat, boundary, conduction, expansion, measurement, initial
  std::vector<NamedShare> places;  ///< effect-free estimate, strongest first
  std::vector<ConditionShare> conditions;
  std::vector<PeriodShare> frequency;
  ChainSplit chain;
  bool agrees = true;          ///< the effect-free place is one the first effect can act on
  std::string free_place{};    ///< where it is not: the place that explains most without assuming an effect
  std::string effect_place{};  ///< and the one at which the effect acts
};

/// What the residual of one channel looks like.
struct RemainingLook {
  enum class Kind {
    too_few,  ///< samples to say
    noise,
    shaped,          ///< one or several of the three below
    louder_noise,    ///< white, but larger than the noise estimate
    slow_unrecorded  ///< slow changes that follow nothing recorded
  };
  std::string channel;  ///< empty: the output of the gap
  Kind kind = Kind::too_few;
  double offset_share = 0;  ///< of the square: one value a batch; 0 where it is less than a third
  double trend_share = 0;   ///< of the square: a straight line in time; 0 where it is less than a third
  std::string follows;      ///< the recorded course it follows; empty: none
  double correlation = 0;   ///< with it
  double lag_min = 0;       ///< behind it
  double noise = 0;         ///< the noise estimate, in the unit of the gap
};

/// What is left after the best explanation.
struct Remaining {
  bool white = false;      ///< by the cumulated periodogram of the output's residual
  double unexplained = 0;  ///< sqrt(with_effect^2 - noise^2), never negative, in the unit of the gap
  std::vector<RemainingLook> looks;
};

struct NextExperiment {
  enum class Remark {
    none,
    nothing_separates,  ///< no schedule tells the first two of `separates` apart well; a thermometer there would
    not_foreseeable,    ///< without the network the probability of confusion cannot be given
    thermometer_near,   ///< add one near `subject`, where the gap lies most
    not_pinned          ///< the parameter `subject` is not pinned by these data
  };
  std::vector<Rival> separates;  ///< the explanations it tells apart
  std::vector<PlannedBlock> plan;
  double expected_confidence = 0;  ///< after the plan, 0…1
  double confusion_before = 0;     ///< probability that the strongest rival is mistaken for the truth
  double confusion_after = 0;
  Remark remark = Remark::none;
  std::string subject;
};

/// How far a parameter of the machine moved in calibration.
struct CalibrationMove {
  std::string parameter;  ///< "capacity of head_front"
  std::string unit;
  double from = 0, to = 0;
  double prior_sds = 0;  ///< signed
  bool pinned = true;    ///< the data, not the prior, decide it
};

/// What the verdict rests on: the account that comes nearest, named or not.
struct Support {
  std::size_t candidates = 0;  ///< effects at places that were tried
  std::vector<Rival> nearest;  ///< effects of the account; empty where nothing was worth a closer look
  double gain_nats = 0;        ///< of its evidence over calibration alone
  double closes = 0;           ///< share of the squared gap beyond expectation, on held-out batches
  double leaves = 0;           ///< squared gap beyond expectation, in units of what is expected
};

/// A fault of the data seen on the way.
struct DataProblem {
  enum class Kind {
    not_measured,   ///< thermometers of the machine file that the batches lack
    not_modelled,   ///< thermometers of the batches that the machine file lacks; left out
    not_simulated,  ///< channels of the batches that the simulator's output lacks; left out
    not_paired,     ///< a batch without a simulated counterpart; left out
    resampled,      ///< sampling differs: simulated values are read off at measured times
    finding         ///< of a rule on single batches (findings/): stuck, spike, gap, …
  };
  Kind kind = Kind::finding;
  std::vector<std::string> names;  ///< channels, or a batch
  std::string batch, channel;      ///< of a finding
  std::string rule, note;          ///< of a finding
};

/// What these data do not allow to say.
struct WeakerClaim {
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
  Kind kind = Kind::one_batch;
  std::string subject, batch;
  std::vector<std::string> names;
  std::size_t batches = 0;
};

struct Diagnosis {
  SimulatorKind simulator = SimulatorKind::network;
  std::string machine;
  std::vector<std::string> batches;
  Verdict verdict = Verdict::unknown;
  std::vector<FoundEffect> effects;  ///< strongest first
  Gap gap;
  Where where;
  Remaining remaining;
  NextExperiment next_experiment;
  std::vector<RuledOut> ruled_out;
  Support support;
  std::vector<CalibrationMove> calibration;  ///< largest move first
  std::vector<DataProblem> data_problems;
  std::vector<WeakerClaim> weaker_claims;
  std::vector<std::pair<std::string, double>> judged_by;  ///< the numbers that decided, by name
  /// The machine calibrated, with the effects found; without nodes where the simulator was not a network.
  ThermalNetwork with_effects;
};

}  // namespace thermfit
