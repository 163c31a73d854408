#pragma once

#include <optional>
#include <string>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"

namespace thermfit {

/// Rows from which on equal numbers are no accident: a few rows may well agree.
constexpr Index fewest_copied_rows = 10;

/// The first batch before the `b`th that holds the same numbers (by Batch::digest), or nullptr; nullptr for a batch
/// without digest or of fewer than fewest_copied_rows. Does not allocate.
inline const Batch* copied_from(const Campaign& campaign, std::size_t b) {
  if (campaign[b].rows() < fewest_copied_rows || campaign[b].digest.empty()) return nullptr;
  for (std::size_t earlier = 0; earlier < b; ++earlier)
    if (campaign[earlier].digest == campaign[b].digest) return &campaign[earlier];
  return nullptr;
}

/// That the `b`th batch is copied from another, or nothing. Allocates the finding.
inline std::optional<Finding> copy_finding(const Campaign& campaign, std::size_t b) {
  const Batch* original = copied_from(campaign, b);
  if (original == nullptr) return std::nullopt;
  return Finding{FindingRule::copy,
                 "all",
                 0,
                 campaign[b].rows() - 1,
                 0,
                 0,
                 "",
                 "holds the numbers of " + original->name + " once more"};
}

}  // namespace thermfit
