#pragma once

/// Both sides of a gap, channel by channel, before anything explains it.

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "thermfit/lazy.hpp"
#include "thermfit/statistics/residual_noise.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// What one column says on either side, sample by sample.
struct SideChannel {
  std::string name;           ///< of the column
  bool displacement = false;  ///< um, else degC
  SeriesByBatch measured;     ///< NaN where a value is missing
  SeriesByBatch simulated;    ///< at the same samples
  double noise = 0;           ///< of a single reading: white, or what rounding leaves
  bool absolute = false;      ///< a displacement whose zero is part of what is measured
};

/// The measured and the simulated campaign beside each other.
struct Sides {
  std::vector<std::string> batches;   ///< names
  std::vector<Vector> time_s;         ///< by batch
  std::vector<SideChannel> channels;  ///< temperatures, then displacements
  bool computed = false;              ///< simulated by a network: columns that are equal are thermometers of one node
  double largest_um_per_K = 0;        ///< of the simulated parts; 0 where that is not known
  /// How a channel may differ from what is simulated although nothing is wrong with the data: samples of all batches
  /// below each other x directions, each as far as one prior standard deviation moves it. Dear: asked on suspicion.
  std::function<Matrix(std::size_t channel)> belief;
};

/// Values of some batches below each other. Allocates.
template <typename Scalar = double>
VectorX<Scalar> stacked(const SeriesByBatch& series, const std::vector<std::size_t>& batches) {
  Index rows = 0;
  for (const std::size_t b : batches) rows += series[b].size();
  VectorX<Scalar> result(rows);
  rows = 0;
  for (const std::size_t b : batches) {
    result.segment(rows, series[b].size()) = series[b];
    rows += series[b].size();
  }
  return result;
}

}  // namespace thermfit
