#pragma once

#include <algorithm>

namespace thermfit {

/// The climates a model was trained in, degC: a batch's climate is the mean of its temperatures where it starts.
template <typename Scalar = double>
struct ClimateRange {
  Scalar lowest = 0;   ///< of the coldest batch
  Scalar highest = 0;  ///< of the warmest
  Scalar mean = 0;     ///< over batches

  /// What rises are multiplied by in a batch of `climate_degC`: clipped to the range, less the mean, K.
  Scalar factor(Scalar climate_degC) const { return std::clamp(climate_degC, lowest, highest) - mean; }

  /// How far `climate_degC` lies beyond the range, K; 0 within.
  Scalar beyond_K(Scalar climate_degC) const {
    return std::max(Scalar(0), std::max(lowest - climate_degC, climate_degC - highest));
  }
};

}  // namespace thermfit
