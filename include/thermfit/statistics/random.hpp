#pragma once

/// Random numbers that are the same on every machine.

#include <cstdint>

namespace thermfit {

/// Uniform in -1 … 1, the next of a stream that `state` is the seed and then the counter of (splitmix64 of Steele, Lea
/// & Flood 2014 without its last shift, which moves digits past the ninth only). Does not allocate.
inline double symmetric_uniform(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15ULL);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1;
}

}  // namespace thermfit
