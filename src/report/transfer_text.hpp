#pragma once

/// What the method `transfer` chose, in words.

#include <string>

#include "thermfit/robustness/transfer_left_out.hpp"

namespace thermfit::cli {

/// "lag 20 min, with the climate", "no lag, no climate", as chosen for one error; `lags_min` is what was chosen from.
std::string in_words(const TransferPenalties<>& penalties, const std::vector<double>& lags_min);

/// "S_mean 4.43 um, S_std 1.96 um".
std::string in_words(const MeanAndStd<>& figure);

}  // namespace thermfit::cli
