#pragma once

/// What a diagnosis says, as plain data: the members of `thermfit-diagnosis/1`, in the same order and with the same
/// names. No algorithm lives here; diagnosis/diagnose.hpp and diagnosis/outputs/diagnose_outputs.hpp fill it,
/// io/json/diagnosis.hpp and the text report print it.

#include <array>
#include <string>
#include <vector>

namespace thermfit {

enum class Verdict {
  none,            ///< the machine as given is already at the noise
  miscalibration,  ///< moving the parameters the machine has closes the gap
  effect,          ///< one or several effects explain it and their rivals do not
  ambiguous,       ///< several explanations remain above 5 %
  unknown          ///< the gap is real and nothing in the catalogue closes it on held-out batches
};

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
};

/// An explanation that was tried and dropped, and why.
struct RuledOut {
  std::string effect, location;
  std::string reason;  ///< "shrinks the held-out gap by 3 % only"
};

/// rms of measured minus simulated on batches not used for fitting, at the stages of the diagnosis.
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
  std::string output, unit;
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
  bool agrees = true;      ///< the effect-free place is one the winning effect can act on
  std::string difference;  ///< said in words where the two views differ
};

/// What is left after the best explanation.
struct Remaining {
  bool white = false;         ///< by the cumulated periodogram of the output's residual
  double unexplained_um = 0;  ///< sqrt(with_effect^2 - noise^2), never negative
  std::string looks_like;     ///< in words: the input it follows, an offset per batch, slow drift, "noise"
};

struct PlannedBlock {
  std::string schedule;  ///< from the menu: "speed stair", "cool-down", …
  std::string how;       ///< settings in words
  double machine_hours = 0;
};

struct NextExperiment {
  std::vector<std::string> separates;  ///< names of the explanations it tells apart
  std::vector<PlannedBlock> plan;
  double expected_confidence = 0;  ///< after the plan, 0…1
  double confusion_before = 0;     ///< probability that the strongest rival is mistaken for the truth
  double confusion_after = 0;
  std::string why;
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

/// A fault of the data seen on the way: stuck sensor, gaps, an input that never changes.
struct DataProblem {
  std::string place, what;
};

struct Diagnosis {
  std::string machine;
  std::vector<std::string> batches;
  Verdict verdict = Verdict::unknown;
  std::vector<FoundEffect> effects;  ///< strongest first
  Gap gap;
  Where where;
  Remaining remaining;
  NextExperiment next_experiment;
  std::vector<RuledOut> ruled_out;
  Support grounds;
  std::vector<CalibrationMove> calibration;  ///< largest move first
  std::vector<DataProblem> data_problems;
  std::vector<std::string> weaker_claims;  ///< what these data do not allow to say, and why
  std::string mode = "network";            ///< "network" or "paired"
};

}  // namespace thermfit
