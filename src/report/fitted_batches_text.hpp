#pragma once

/// Numbers of single batches in words: their rooms and their starts.

#include <string>
#include <vector>

#include "thermfit/calibration/fitted_batch.hpp"

namespace thermfit::cli {

/// A table of rooms and starts by batch; empty where nothing was fitted.
std::string fitted_batches_text(const std::vector<FittedBatch>& batches);

}  // namespace thermfit::cli
