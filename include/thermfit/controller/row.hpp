#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace thermfit {

/// A size known only at run time; include dynamic_row.hpp to use it (host only).
constexpr int dynamic_size = -1;

namespace detail {

template <class T, int Size>
struct RowStorage {
  static_assert(Size >= 0, "include thermfit/controller/dynamic_row.hpp for sizes known at run time");
  using type = std::array<T, static_cast<std::size_t>(Size)>;
};

/// A fixed row has its size already; a dynamic one takes it.
template <class T, std::size_t Size>
constexpr void set_size(std::array<T, Size>&, std::size_t) noexcept {}
template <class DynamicRow>
void set_size(DynamicRow& row, std::size_t size) {
  row.resize(size);
}

}  // namespace detail

/// `Size` values side by side: std::array, and std::vector for dynamic_size. What runs on a controller is fixed; the
/// host runs the very same code on models read from a file.
template <class T, int Size>
using Row = typename detail::RowStorage<T, Size>::type;

}  // namespace thermfit
