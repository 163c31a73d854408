#pragma once

/// Whether a recorded course was set by somebody, or measured.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit {

/// Values of a course and how it gets from one to the next, whole batches.
struct HeldLevels {
  std::vector<double> values;  ///< of every sample
  std::vector<double> jumps;   ///< sizes of the steps that change something
  std::size_t steps = 0;       ///< from a sample to the next
};

/// Adds one batch. Allocates.
inline void count_held(HeldLevels& levels, const Eigen::Ref<const Vector>& course) {
  for (Index k = 0; k < course.size(); ++k) {
    levels.values.push_back(course(k));
    if (k == 0) continue;
    ++levels.steps;
    if (course(k) != course(k - 1)) levels.jumps.push_back(std::abs(course(k) - course(k - 1)));
  }
}

/// Levels that may be those of a switch or a stair, however they follow each other.
constexpr std::size_t levels_of_a_stair = 12;

/// Whether somebody sets this course, so that an experiment can: it has few levels, or stays on each for a while and
/// leaves it by more than the least step there is. What is measured (a temperature, a speed by its encoder) moves with
/// nearly every sample, or by its reading step. Allocates.
inline bool is_set(HeldLevels levels) {
  std::vector<double>& values = levels.values;
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() <= levels_of_a_stair) return true;
  if (2 * levels.jumps.size() > levels.steps) return false;
  double least = values.back() - values.front();
  for (std::size_t k = 1; k < values.size(); ++k) least = std::min(least, values[k] - values[k - 1]);
  const auto median = levels.jumps.begin() + static_cast<std::ptrdiff_t>(levels.jumps.size() / 2);
  std::nth_element(levels.jumps.begin(), median, levels.jumps.end());
  return *median > 2 * least;
}

}  // namespace thermfit
