#pragma once

#include <cstddef>

namespace thermfit {

/// Shape `k` of the course of a room over a batch at `share` (0…1) of it: Legendre polynomial of x = 2 share - 1. The
/// first is a level, the second a drift, 2 K from end to end. Pure numbers. Does not allocate.
inline double room_shape(std::size_t k, double share) {
  const double x = 2 * share - 1;
  double before = 1, now = x;
  if (k == 0) return 1;
  for (std::size_t j = 1; j < k; ++j) {
    const double n = static_cast<double>(j), next = ((2 * n + 1) * x * now - n * before) / (n + 1);
    before = now;
    now = next;
  }
  return now;
}

}  // namespace thermfit
