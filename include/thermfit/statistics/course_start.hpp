#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermfit {

/// Where a course of readings starts.
struct CourseStart {
  double value = 0;  ///< the first reading, or where the next ones come from when it is off; NaN of none
  double off = 0;    ///< how far the first reading is off those that follow; 0 where it is not, or may be a start
};

/// Where readings 1 to 4 come from: reading 1 less the median of their steps. Five readings or more. Does not allocate.
inline double course_taken_back(const std::vector<double>& readings) {
  const std::vector<double>& x = readings;
  std::array<double, 3> steps{x[2] - x[1], x[3] - x[2], x[4] - x[3]};
  std::sort(steps.begin(), steps.end());
  return x[1] - steps[1];
}

/// Start of `readings`, all finite, so that one bad reading is no start.
///
/// The first reading is off when it leaves the course of the next four, taken back to it, by more than `least`, and
/// gets to them against their course, or by a step `over_steps` times as large as each of the next seven. The course
/// taken back is the start then. Fewer than five readings: the first. Does not allocate.
inline CourseStart course_start(const std::vector<double>& readings, double least, double over_steps = 8) {
  const std::vector<double>& x = readings;
  if (x.empty()) return {std::nan(""), 0};
  if (x.size() < 5) return {x[0], 0};
  const double before = course_taken_back(x), trend = x[1] - before, first = x[1] - x[0], off = std::abs(x[0] - before);
  double largest = 0;
  for (std::size_t k = 2; k < 9 && k < x.size(); ++k) largest = std::max(largest, std::abs(x[k] - x[k - 1]));
  const bool outsized = x.size() > 9 && std::abs(first) > over_steps * largest;
  if (!(off > least) || (first * trend > 0 && !outsized)) return {x[0], 0};
  return {before, off};
}

}  // namespace thermfit
