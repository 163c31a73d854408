#pragma once

#include <string>
#include <vector>

#include "cli/console.hpp"
#include "thermfit/calibration/calibrate.hpp"
#include "thermfit/calibration/shortcomings.hpp"

namespace thermfit::cli {

/// One parameter in its own unit, and how far it moved in prior standard deviations.
struct CalibratedParameter {
  const Parameter& parameter;
  double moved, value, standard_error;
};
CalibratedParameter calibrated(const Calibration& calibration, std::size_t parameter);

/// What a calibration says of one parameter: "not known from these data", "only together with …", "at its bound".
std::string identified_in_words(const Calibration& calibration, std::size_t parameter);

/// Whether a calibration can be believed.
struct CalibrationVerdict {
  std::vector<Shortcoming> shortcomings;              ///< why not
  std::vector<ThermalNetwork::AddedEffect> suspects;  ///< what the machine may lack, most promising first

  /// Whether it failed: moving what the data do not know is told, but is no failure by itself.
  bool failed() const;
  /// Whether the calibrated machine must not replace the one given.
  bool spoilt() const;
};

/// One reason in words.
std::string shortcoming_in_words(const Shortcoming& one);
/// What a machine may lack, in words: "a link head-column".
std::string suspect_in_words(const ThermalNetwork::AddedEffect& one);

/// The result in words: what failed, channels before and after, what moved, what the data do not know. `all`: every
/// parameter.
void print_calibration(const Calibration& calibration, const MachineRecord& seen, const CalibrationVerdict& verdict,
                       bool all, Console& console);

}  // namespace thermfit::cli
