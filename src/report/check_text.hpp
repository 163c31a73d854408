#pragma once

/// What `thermfit check` found, as tables for people.

#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"

namespace thermfit::cli {

struct CheckedBatch {
  Batch batch;
  std::vector<Finding> findings;
};

/// An overview of the batches, then the findings, a line a kind and channel with the worst first, or all of them, a
/// line each, and a line that counts them.
std::string check_text(const std::vector<CheckedBatch>& checked, bool all = false);

}  // namespace thermfit::cli
