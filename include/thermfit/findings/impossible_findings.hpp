#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"

namespace thermfit {

/// What a machine can have. Instruments write other numbers where they have no reading: -999.9, 9.9E37, -127.
struct PossibleReadings {
  double lowest_degC = -100;      ///< no machine works in less …
  double highest_degC = 1000;     ///< … or in more; kelvin fits in between
  double largest_error_um = 1e7;  ///< ten metres
};

/// Numbers of a channel that no machine can have, rows in a row together; they are set to NaN in `values`, so that
/// nothing else is judged by them. Allocates.
inline std::vector<Finding> impossible_findings(Eigen::Ref<Vector> values, bool is_error, const std::string& name,
                                                const PossibleReadings& limits = {}) {
  std::vector<Finding> findings;
  for (Index row = 0; row < values.size(); ++row) {
    const double value = values(row), lowest = is_error ? -limits.largest_error_um : limits.lowest_degC,
                 highest = is_error ? limits.largest_error_um : limits.highest_degC;
    if (std::isnan(value) || (lowest <= value && value <= highest)) continue;
    values(row) = std::nan("");
    if (!findings.empty() && findings.back().last_row == row - 1) {
      findings.back().last_row = row;
      continue;
    }
    findings.push_back({FindingRule::impossible, name, row, row, value, value < lowest ? lowest : highest,
                        is_error ? "um" : "degC",
                        "no machine has that: what the instrument writes without a reading?"});
  }
  return findings;
}

}  // namespace thermfit
