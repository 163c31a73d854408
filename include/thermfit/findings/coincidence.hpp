#pragma once

/// Whether other channels move when one does: then the machine did something, and no sensor is at fault.

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit {

/// When a channel counts as moving.
struct CoincidenceLimits {
  Index near_rows = 1;     ///< rows before and after, within which another channel may move …
  Index around_rows = 8;   ///< … more than within so many rows around, …
  double over_around = 3;  ///< … so many times the mean there
  double least_share =
      0.02;  ///< of a move over several rows, in the same unit or not: less in another is no part of it
};

/// Whether the slope of `column` changes between rows `first` and `last` by more than `least` (in its unit per row) and
/// far more than in the rows around. Rows without a number do not count. Does not allocate.
inline bool moves_between(const Eigen::Ref<const Vector>& column, Index first, Index last, double least,
                          const CoincidenceLimits& limits = {}) {
  double inside = 0, around = 0, count = 0;
  const Index from = std::max<Index>(1, first - limits.around_rows),
              to = std::min(column.size() - 2, last + limits.around_rows);
  for (Index row = from; row <= to; ++row) {
    const double bend = std::abs(column(row - 1) - 2 * column(row) + column(row + 1));
    if (std::isnan(bend)) continue;
    if (row >= first - limits.near_rows && row <= last + limits.near_rows) {
      inside = std::max(inside, bend);
    } else {
      around += bend;
      ++count;
    }
  }
  return inside > least && inside * count > limits.over_around * around;
}

/// Whether `column` moves by more than `least` between rows `first` and `last` beyond what it does in as many rows
/// before and after. Does not allocate.
inline bool leaves_its_course(const Eigen::Ref<const Vector>& column, Index first, Index last, double least) {
  const Index width = last - first;
  if (first < width || last + width >= column.size()) return false;
  const double before = column(first) - column(first - width), after = column(last + width) - column(last);
  return std::abs(column(last) - column(first) - (before + after) / 2) > least;
}

}  // namespace thermfit
