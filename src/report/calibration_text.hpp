#pragma once

#include <string>
#include <vector>

#include "cli/console.hpp"
#include "thermfit/calibration/calibrate.hpp"

namespace thermfit::cli {

/// One parameter in its own unit, and how far it moved in prior standard deviations.
struct CalibratedParameter {
  const Parameter& parameter;
  double moved, value, standard_error;
};
CalibratedParameter calibrated(const Calibration& calibration, std::size_t parameter);

/// What a calibration says of one parameter: "not known from these data", "only together with …", "at its bound".
std::string identified_in_words(const Calibration& calibration, std::size_t parameter);

/// The result in words: channels before and after, what moved, what the data do not know. `all`: every parameter.
void print_calibration(const Calibration& calibration, const MachineRecord& seen, bool all, Console& console);

}  // namespace thermfit::cli
