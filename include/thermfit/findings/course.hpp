#pragma once

/// The course of a channel: which readings lie on it, and where it breaks.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit {

/// What a course allows.
struct CourseLimits {
  double step = 0;           ///< a step that leaves the mean of the slopes before and after by less is part of it …
  double over_steps = 4;     ///< … as is one of at most so many times the slope before or after, in its direction
  std::size_t longest = 5;   ///< readings in a row that may lie off it
  double known_break = 0.9;  ///< a break that is known to have a cause counts as so many readings off the course
};

/// Readings that are no part of a course, and where it goes on from another level.
struct SeriesCourse {
  /// From one reading of the course to the next.
  struct Break {
    std::size_t from;  ///< the last reading before
    std::size_t to;    ///< the first one after
  };
  std::vector<std::size_t> off;  ///< readings off the course, increasing
  std::vector<Break> breaks;     ///< increasing
};

namespace detail {

/// Whether the step from reading i to j belongs to a course that comes from h and goes on to k.
inline bool belongs(const std::vector<double>& x, const std::vector<Index>& rows, std::size_t h, std::size_t i,
                    std::size_t j, std::size_t k, const CourseLimits& limits) {
  const auto span = [&](std::size_t a, std::size_t b) { return static_cast<double>(rows[b] - rows[a]); };
  const double step = x[j] - x[i], length = span(i, j);
  const double before = (x[i] - x[h]) / span(h, i), after = (x[k] - x[j]) / span(j, k);
  if (std::abs(step) <= limits.step) return true;
  if (j > i + 1) {  // a bridge over readings that are off goes between what both sides say
    const auto [low, high] = std::minmax(before, after);
    return step >= length * low - limits.step && step <= length * high + limits.step;
  }
  if (std::abs(step - length * (before + after) / 2) <= limits.step) return true;
  const double along = step > 0 ? std::max(before, after) : -std::min(before, after);
  return std::abs(step) <= limits.over_steps * length * along;
}

}  // namespace detail

/// The course through readings `x` of `rows` (both increasing in time) that costs least: one for every reading left off
/// it, at most `longest` in a row, and half a reading more than `longest` for every break, less (`known_break`) for one
/// that `known(i, j)` has a cause.
///
/// Hence a few readings in a row, alternate ones or a burst of different ones that the course comes back from are off
/// it, and a step that stays is a break. The first and last two readings are taken to be part of it. By dynamic
/// programming over the last two readings of the course, only around steps that do not belong. Allocates.
template <class Known>
SeriesCourse series_course(const std::vector<double>& x, const std::vector<Index>& rows, const CourseLimits& limits,
                           Known&& known) {
  SeriesCourse course;
  const std::size_t count = x.size(), reach = limits.longest + 1;
  if (count < 4) return course;
  const double break_cost = static_cast<double>(limits.longest) + 0.5;
  std::vector<double> cost;          // of the best course that ends with the step to reading j over g readings …
  std::vector<std::size_t> earlier;  // … and how many readings the step before it spans
  for (std::size_t next = 1, done = 0; next + 2 < count;) {
    if (detail::belongs(x, rows, next - 1, next, next + 1, next + 2, limits)) {
      ++next;
      continue;
    }
    // From well before the first step that does not belong to well after the last of those close together.
    const std::size_t margin = reach + 2, first = next > margin ? next - margin : 0, told = done;
    std::size_t last = std::min(count - 1, next + 1 + margin);
    for (std::size_t i = next + 1; i + 2 < count && i <= last; ++i)
      if (!detail::belongs(x, rows, i - 1, i, i + 1, i + 2, limits)) last = std::min(count - 1, i + 1 + margin);
    next = done = last;
    const std::size_t length = last - first + 1;
    cost.assign(length * reach, HUGE_VAL);
    earlier.assign(length * reach, 0);
    const auto at = [&](std::size_t j, std::size_t gap) { return (j - first) * reach + gap - 1; };
    for (std::size_t gap = 1; gap <= reach && first + gap <= last; ++gap)
      cost[at(first + gap, gap)] = static_cast<double>(gap - 1);
    for (std::size_t j = first + 1; j < last; ++j)
      for (std::size_t gap = 1; gap <= reach && first + gap <= j; ++gap) {
        const double so_far = cost[at(j, gap)];
        if (so_far == HUGE_VAL) continue;
        const std::size_t i = j - gap, before = earlier[at(j, gap)];
        for (std::size_t ahead = 1; ahead <= reach && j + ahead <= last; ++ahead) {
          const std::size_t k = j + ahead;
          double total = so_far + static_cast<double>(ahead - 1);
          if (before > 0 && !detail::belongs(x, rows, i - before, i, j, k, limits))
            total += known(i, j) ? limits.known_break : break_cost;
          if (total >= cost[at(k, ahead)]) continue;
          cost[at(k, ahead)] = total;
          earlier[at(k, ahead)] = gap;
        }
      }
    std::size_t gap = 1;
    for (std::size_t g = 2; g <= reach && first + g <= last; ++g)
      if (cost[at(last, g)] < cost[at(last, gap)]) gap = g;
    std::vector<std::size_t> path{last};
    for (std::size_t j = last; j > first;) {
      const std::size_t before = earlier[at(j, gap)];
      j -= gap;
      path.push_back(j);
      gap = before;
    }
    std::reverse(path.begin(), path.end());
    for (std::size_t p = 1; p < path.size(); ++p) {
      for (std::size_t r = path[p - 1] + 1; r < path[p]; ++r)
        if (r > told) course.off.push_back(r);
      if (path[p - 1] >= told && p >= 2 && p + 1 < path.size() &&
          !detail::belongs(x, rows, path[p - 2], path[p - 1], path[p], path[p + 1], limits))
        course.breaks.push_back({path[p - 1], path[p]});
    }
  }
  return course;
}

}  // namespace thermfit
