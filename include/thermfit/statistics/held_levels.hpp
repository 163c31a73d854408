#pragma once

/// Whether a recorded course was set by somebody, or measured.

#include "thermfit/types.hpp"

namespace thermfit {

/// Steps of a course, and how many of them change nothing.
struct HeldLevels {
  double steps = 0;  ///< from a sample to the next, whole batches
  double held = 0;   ///< without any change

  /// Whether it is set: most samples repeat the one before. What is measured (a temperature, a speed by its encoder)
  /// moves nearly always, and nobody can switch it. A course without steps counts as set.
  bool is_set() const { return 2 * held >= steps; }
};

/// Adds the steps of one batch. Does not allocate.
inline void count_held(HeldLevels& levels, const Eigen::Ref<const Vector>& course) {
  for (Index k = 1; k < course.size(); ++k) {
    ++levels.steps;
    levels.held += course(k) == course(k - 1);
  }
}

}  // namespace thermfit
