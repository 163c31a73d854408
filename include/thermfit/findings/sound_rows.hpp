#pragma once

#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"

namespace thermfit::detail {

/// Rows of a batch, one flag each, in which no temperature (nor error, where they count) is told to be no reading: a
/// spike or an impossible number. Allocates.
inline std::vector<bool> sound_rows(const Batch& batch, const std::vector<Finding>& findings, bool with_errors) {
  std::vector<bool> sound(static_cast<std::size_t>(batch.rows()), true);
  for (const Finding& one : findings) {
    if (one.rule != FindingRule::spike && one.rule != FindingRule::impossible) continue;
    if (!with_errors && batch.temperatures.find(one.channel) < 0) continue;
    for (Index row = one.first_row; row <= one.last_row; ++row) sound[static_cast<std::size_t>(row)] = false;
  }
  return sound;
}

}  // namespace thermfit::detail
