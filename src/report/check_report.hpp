#pragma once

/// What `thermfit check` found, as tables for people and as JSON for programs.

#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"

namespace thermfit::cli {

struct CheckedBatch {
  Batch batch;
  std::vector<Finding> findings;
};

/// An overview of the batches, then the findings, a line each, and a line that counts them.
std::string check_text(const std::vector<CheckedBatch>& checked);

/// `thermfit-check/1`: per batch its clock, channels (range, mean, resolution, noise) and findings.
std::string check_json(const std::vector<CheckedBatch>& checked);

}  // namespace thermfit::cli
