#pragma once

#include "report/check_text.hpp"

namespace thermfit::cli {

/// `thermfit-check/1`: per batch its clock, channels (range, mean, resolution, noise) and findings.
std::string check_json(const std::vector<CheckedBatch>& checked);

}  // namespace thermfit::cli
