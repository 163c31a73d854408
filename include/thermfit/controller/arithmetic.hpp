#pragma once

/// Comparisons that NaN fails. Everything in controller/ rests on them, so flags that break them are refused here.
/// Fixed sizes, no heap, no exceptions, no Eigen: a model is constant data that a linker can place in flash.

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || defined(_M_FP_FAST)
#error "thermfit: the controller needs comparisons that NaN fails; build it without -ffast-math / -ffinite-math-only"
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

namespace thermfit {

/// Whether `lowest <= value <= highest`; false for NaN anywhere.
template <class Scalar>
constexpr bool within(Scalar value, Scalar lowest, Scalar highest) noexcept {
  return lowest <= value && value <= highest;
}

/// Whether `value` is a number: neither NaN nor infinite.
template <class Scalar>
constexpr bool is_finite(Scalar value) noexcept {
  return within(value, std::numeric_limits<Scalar>::lowest(), std::numeric_limits<Scalar>::max());
}

/// `value` without its sign; NaN stays NaN.
template <class Scalar>
constexpr Scalar magnitude(Scalar value) noexcept {
  return value < 0 ? -value : value;
}

/// `count` and `more`; stays at the largest number there is instead of beginning again.
constexpr std::uint32_t counted(std::uint32_t count, std::uint32_t more) noexcept {
  const std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
  return count < most - more ? count + more : most;
}

/// Where fnv1a() begins.
constexpr std::uint32_t fnv1a_begin = 2166136261u;

/// FNV-1a, 32 bits: the digest of what came before and of `size` more bytes.
inline std::uint32_t fnv1a(std::uint32_t before, const void* bytes, std::size_t size) noexcept {
  for (std::size_t k = 0; k < size; ++k) before = (before ^ static_cast<const unsigned char*>(bytes)[k]) * 16777619u;
  return before;
}

}  // namespace thermfit
