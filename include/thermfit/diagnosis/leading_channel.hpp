#pragma once

#include <cstddef>

namespace thermfit {

/// The channel that a gap is told for where it is told for one: the first displacement, else the temperature of largest
/// `size(c)`. `is_displacement(c)` and `size(c)` take a channel 0 … `channels` - 1; there is one at least.
template <class IsDisplacement, class Size>
std::size_t leading_channel(std::size_t channels, IsDisplacement is_displacement, Size size) {
  std::size_t largest = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    if (is_displacement(c)) return c;
    if (c > 0 && size(c) > size(largest)) largest = c;
  }
  return largest;
}

}  // namespace thermfit
