#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/statistics/quantiles.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Squares of a residual by batch, of one channel or of several together.
struct BatchSquares {
  Vector sum;    ///< by batch
  Vector count;  ///< values by batch

  /// Over all batches, in the unit of the residual; 0 without values. Does not allocate.
  template <typename Scalar = double>
  double rms() const {
    const VectorX<Scalar>&squares = sum, &counts = count;
    return counts.sum() > 0 ? std::sqrt(squares.sum() / counts.sum()) : 0;
  }
  /// NaN for a batch without values.
  double rms(Index batch) const { return count(batch) > 0 ? std::sqrt(sum(batch) / count(batch)) : std::nan(""); }
};

/// 1 - with_effect / calibrated, in percent; 0 where there is nothing to shrink.
inline double shrink_percent(double calibrated, double with_effect) {
  return calibrated > 0 ? 100 * (1 - with_effect / calibrated) : 0;
}

/// The same with the noise taken off in square: the part of the closable gap that was closed.
inline double shrink_of_explainable_percent(double calibrated, double with_effect, double noise) {
  const double closable = calibrated * calibrated - noise * noise;
  if (closable <= 0) return 0;
  return 100 * std::clamp((calibrated * calibrated - with_effect * with_effect) / closable, -1.0, 1.0);
}

/// Interval of the shrink from drawing whole batches with replacement: samples of a batch are not independent, batches
/// nearly are. Expanded percentiles of `draws` resamples (Hesterberg 2015): the resamples of n batches scatter by
/// sqrt((n - 1) / n) too little, and what scatter n batches show is itself uncertain as Student's t says.
template <typename Scalar = double>
Interval shrink_interval(const BatchSquares& calibrated, const BatchSquares& with_effect, double coverage,
                         std::uint64_t seed, int draws = 2000) {
  const Index n = calibrated.sum.size();
  const double middle = shrink_percent(calibrated.rms(), with_effect.rms());
  if (n < 2) return {-std::numeric_limits<double>::infinity(), 100};
  std::mt19937_64 random(seed);
  std::vector<double> shrinks;
  for (int d = 0; d < draws; ++d) {
    double before = 0, after = 0;
    for (Index k = 0; k < n; ++k) {
      const Index b = static_cast<Index>(random() % static_cast<std::uint64_t>(n));
      before += calibrated.sum(b);
      after += with_effect.sum(b);
    }
    if (before > 0) shrinks.push_back(100 * (1 - std::sqrt(after / before)));
  }
  if (shrinks.empty()) return {0, 0};
  std::sort(shrinks.begin(), shrinks.end());
  const double tail = (1 - coverage) / 2, degrees = static_cast<double>(n - 1);
  const double wider = std::sqrt((degrees + 1) / degrees) * t_quantile(tail, degrees) / normal_quantile(tail);
  const auto at = [&](double share) {
    const double value = shrinks[static_cast<std::size_t>(share * static_cast<double>(shrinks.size() - 1))];
    return std::min(100.0, middle + wider * (value - middle));
  };
  return {at(tail), at(1 - tail)};
}

}  // namespace thermfit
