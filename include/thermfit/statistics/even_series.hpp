#pragma once

/// A batch's channel as an evenly spaced, short series: what spectra and correlations work on.

#include <algorithm>

#include "thermfit/types.hpp"

namespace thermfit {

/// `values` at `time_s` (linear between samples), as means over `count` equal intervals of the batch.
///
/// The trapezoidal integral is exact for the broken line through the samples, so uneven sampling weighs by time, not by
/// rows. `time_s` must increase and hold at least two samples. Allocates the result.
inline Vector interval_means(const Vector& time_s, const Vector& values, Index count) {
  const Index rows = time_s.size();
  const double start = time_s(0), width = (time_s(rows - 1) - start) / static_cast<double>(count);
  Vector means(count);
  Index row = 1;
  double from = start, at = values(0);
  for (Index k = 0; k < count; ++k) {
    const double end = k + 1 == count ? time_s(rows - 1) : start + static_cast<double>(k + 1) * width;
    double area = 0;
    while (from < end) {
      const double to = std::min(end, time_s(row));
      const double slope = (values(row) - values(row - 1)) / (time_s(row) - time_s(row - 1));
      const double next = values(row - 1) + slope * (to - time_s(row - 1));
      area += .5 * (at + next) * (to - from);
      from = to;
      at = next;
      if (to >= time_s(row) && row + 1 < rows)
        ++row;
      else if (to >= time_s(row))
        break;
    }
    means(k) = area / width;
  }
  return means;
}

/// As many points as the batch has rows, but at most `most`: the grid the diagnosis looks at a batch on.
inline Index series_length(Index rows, Index most) { return std::min(rows, most); }

}  // namespace thermfit
