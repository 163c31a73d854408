#pragma once

#include "thermfit/controller/arithmetic.hpp"

namespace thermfit {

/// What one axis may do.
template <class Scalar>
struct OutputLimits {
  Scalar clamp_um = 0;          ///< the offset stays within ± this; > 0
  Scalar slew_um_per_step = 0;  ///< and moves at most this far in a step; > 0
};

/// `value` clamped to ± `bound`; NaN gives 0.
template <class Scalar>
constexpr Scalar clamped(Scalar value, Scalar bound) noexcept {
  if (within(value, -bound, bound)) return value;
  return value > bound ? bound : value < -bound ? -bound : Scalar(0);
}

/// One step from `current` towards `target`, at most `slew` long, never past it. With both in a clamp the result is,
/// rounding included, since rounding keeps order.
template <class Scalar>
constexpr Scalar slewed(Scalar current, Scalar target, Scalar slew) noexcept {
  const Scalar way = target - current;
  if (within(way, -slew, slew)) return target;
  return way > 0 ? current + slew : current - slew;
}

}  // namespace thermfit
