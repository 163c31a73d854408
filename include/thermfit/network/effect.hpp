#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/error.hpp"
#include "thermfit/network/schedule.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

class ThermalSystem;
class OutputTraces;

/// Where in the chain from heat to reading an effect acts.
enum class Stage { heat, boundary, conduction, expansion, measurement, initial };

/// The word of documents and reports for it.
inline const char* word_of(Stage stage) {
  constexpr const char* words[] = {"heat", "boundary", "conduction", "expansion", "measurement", "initial"};
  return words[static_cast<int>(stage)];
}

/// One number of an effect's law: what is known of it before the data are seen.
struct EffectParameter {
  std::string name;          ///< key in the machine document, with its unit: "power_W"
  std::string unit;          ///< "W"; empty for a pure number
  double mean = 0;           ///< of the prior
  double sd = 1;             ///< of the prior: of the value, or of its logarithm where `logarithmic`
  bool logarithmic = false;  ///< positive, fitted as logarithm
  double lower = -std::numeric_limits<double>::infinity();  ///< the value never falls below it
  double upper = std::numeric_limits<double>::infinity();   ///< nor rises above it
  double null = 0;             ///< the value at which the effect vanishes; ignored where `shapes`
  bool shapes = false;         ///< only shapes the effect (an exponent, a coolant temperature): no value removes it
  bool fixed = false;          ///< a scale that is chosen, not fitted
  std::vector<double> starts;  ///< where to begin fitting; empty: at `mean`
};

/// A number that may have either sign, 0 without the effect.
inline EffectParameter linear_parameter(std::string name, std::string unit, double sd) {
  EffectParameter one;
  one.name = std::move(name);
  one.unit = std::move(unit);
  one.sd = sd;
  return one;
}

/// A number of at least 0, which is its value without the effect.
inline EffectParameter positive_parameter(std::string name, std::string unit, double sd) {
  EffectParameter one = linear_parameter(std::move(name), std::move(unit), sd);
  one.lower = 0;
  return one;
}

/// A number above 0, known by its order of magnitude; `sd` is of its logarithm. Towards 0 the effect vanishes.
inline EffectParameter log_parameter(std::string name, std::string unit, double mean, double sd) {
  EffectParameter one = positive_parameter(std::move(name), std::move(unit), sd);
  one.mean = mean;
  one.logarithmic = true;
  return one;
}

/// A number that only shapes the effect.
inline EffectParameter shape_parameter(std::string name, std::string unit, double mean, double sd, double lower,
                                       double upper) {
  EffectParameter one = linear_parameter(std::move(name), std::move(unit), sd);
  one.mean = mean;
  one.lower = lower;
  one.upper = upper;
  one.shapes = true;
  return one;
}

/// How late (s) something follows the room: 0, the usual assumption, is most probable.
inline EffectParameter room_lag_parameter(double sd, std::vector<double> starts) {
  EffectParameter one = shape_parameter("lag_s", "s", 0, sd, 0, std::numeric_limits<double>::infinity());
  one.starts = std::move(starts);
  return one;
}

/// Of a fitted lag (s): a lag of nothing is not a number that can be varied.
inline double at_least_a_second(double lag_s) { return 1 + lag_s; }

/// A scale that is chosen and not fitted.
inline EffectParameter fixed_parameter(std::string name, double value) {
  EffectParameter one = linear_parameter(std::move(name), "", 1);
  one.mean = value;
  one.fixed = true;
  return one;
}

/// What candidates() may use: the machine and what its data can show.
struct Setting {
  ThermalNetwork network;                    ///< the machine as given
  std::vector<std::string> inputs;           ///< input columns that vary within the campaign
  std::vector<std::string> constant_inputs;  ///< input columns that never change
  std::vector<std::string> on_off_inputs;    ///< those of `inputs` with exactly two values, one of them 0
  std::vector<double> largest;               ///< largest absolute value of each of `inputs`
  double shortest_batch_s = 0;               ///< duration; 0 where no batch has a clock
  double longest_batch_s = 0;                ///< the same
  double median_step_s = 0;                  ///< between samples, over all batches
  bool ambient_measured = false;             ///< a sensor mapped to ambient is in the data
  bool ambient_varies = false;               ///< and it moves within at least one batch

  /// Whether it is one of `on_off_inputs`.
  bool is_on_off(const std::string& input) const {
    for (const std::string& one : on_off_inputs)
      if (one == input) return true;
    return false;
  }
  /// Largest absolute value of an input; 1 where it is none of `inputs`.
  double largest_of(const std::string& input) const {
    for (std::size_t i = 0; i < inputs.size(); ++i)
      if (inputs[i] == input) return largest[i];
    return 1;
  }
};

/// One physical effect: its places, its parameters and its law, and how it is told, shown and recognised in outputs.
/// Stateless; the data of an effect that acts on a machine is a ThermalNetwork::AddedEffect. The catalogue is a list of
/// these, and users add their own. What has a body here may be left as it is.
class Effect {
 public:
  virtual ~Effect() = default;
  /// Key in documents and reports, lower case with hyphens; the same for ever.
  virtual std::string name() const = 0;
  /// Where in the chain it acts: what a diagnosis counts it under.
  virtual Stage stage() const = 0;
  /// Every place and driver where it can act on this machine, with parameters at their starting values.
  virtual std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const = 0;
  /// Its parameters for this place, in the order in which the law receives them. Throws Error on an unknown place.
  virtual std::vector<EffectParameter> parameters(const ThermalNetwork& network,
                                                  const ThermalNetwork::AddedEffect& added) const = 0;
  /// Adds its law to the system: see thermal_system.hpp for what can be added.
  virtual void act(ThermalSystem& system, const ThermalNetwork& network,
                   const ThermalNetwork::AddedEffect& added) const = 0;
  /// What it means for a reader who does not know its name, as a clause: "a hidden mass stores heat". Empty: it has
  /// nothing to say but its name.
  virtual std::string meaning() const { return {}; }
  /// The schedule that shows it by itself at `where`; a batch of the campaign lasts `batch_hours`.
  virtual PlannedBlock shown_by(const ThermalNetwork::AddedEffect& /*where*/, double batch_hours) const {
    return block_that_shows(ScheduleKind::cool_down, {}, 1.5 * batch_hours);
  }
  /// Adds what it would leave in the outputs of a simulator whose network is not known: see effects/output_traces.hpp.
  /// An effect without a trace is not looked for there.
  virtual void trace(OutputTraces& /*traces*/) const {}
  /// Whether calibration moves the same number, so that its gap counts against the machine as given.
  virtual bool calibration_does_the_same() const { return false; }
  /// What a search that assumes no effect calls the place where it acts: a node, a sensor, an output, `clock`, `start`.
  virtual std::string disturbs(const ThermalNetwork::AddedEffect& added) const { return added.location; }
};

/// The effects a simulation knows by name, in a fixed order.
class EffectLibrary {
 public:
  /// Appends an effect; of two of one name the first is found. Returns the library.
  EffectLibrary& add(std::shared_ptr<const Effect> effect) {
    effects_.push_back(std::move(effect));
    return *this;
  }
  /// In the order in which they were added.
  const std::vector<std::shared_ptr<const Effect>>& all() const { return effects_; }
  /// In the same order. Allocates.
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const auto& effect : effects_) result.push_back(effect->name());
    return result;
  }
  /// Null where no effect has this name; else valid as long as the library.
  const Effect* find(const std::string& name) const {
    for (const auto& effect : effects_)
      if (effect->name() == name) return effect.get();
    return nullptr;
  }
  /// Throws Error naming the known effects.
  const Effect& at(const std::string& name) const {
    if (const Effect* effect = find(name)) return *effect;
    std::string known;
    for (const auto& effect : effects_) known += (known.empty() ? "" : ", ") + effect->name();
    throw Error("effect", "'" + name + "' is not known", known, "add it to the library or correct the name");
  }
  /// Whether the effect can act at this place, from this driver.
  bool accepts(const ThermalNetwork& network, const ThermalNetwork::AddedEffect& added) const {
    try {
      at(added.effect).parameters(network, added);
      return true;
    } catch (const Error&) {
      return false;
    }
  }
  /// All candidates of all effects, in order.
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting& setting) const {
    std::vector<ThermalNetwork::AddedEffect> result;
    for (const auto& effect : effects_)
      for (auto& one : effect->candidates(setting)) result.push_back(std::move(one));
    return result;
  }

 private:
  std::vector<std::shared_ptr<const Effect>> effects_;
};

}  // namespace thermfit
