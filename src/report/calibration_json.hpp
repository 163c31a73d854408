#pragma once

#include "report/calibration_text.hpp"

namespace thermfit::cli {

/// The result as `thermfit-calibration/1`.
std::string calibration_json(const Calibration& calibration, const MachineRecord& seen,
                             const CalibrationVerdict& verdict);

}  // namespace thermfit::cli
