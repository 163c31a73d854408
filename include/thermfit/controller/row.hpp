#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace thermfit {

/// A size known only at run time; include dynamic_row.hpp to use it (host only).
constexpr int dynamic_size = -1;

namespace detail {

/// No values; std::array of none is as large as a value in some libraries, this never.
template <class T>
struct EmptyRow {
  static constexpr std::size_t size() noexcept { return 0; }
  static constexpr bool empty() noexcept { return true; }
  static constexpr T* begin() noexcept { return nullptr; }
  static constexpr T* end() noexcept { return nullptr; }
  T& operator[](std::size_t i) const noexcept { return begin()[i]; }  // never called: there is no such i
};

template <class T, int Size>
struct RowStorage {
  static_assert(Size >= 0, "include thermfit/controller/dynamic_row.hpp for sizes known at run time");
  using type = std::array<T, static_cast<std::size_t>(Size)>;
};

template <class T>
struct RowStorage<T, 0> {
  using type = EmptyRow<T>;
};

/// A fixed row has its size already; a dynamic one takes it.
template <class T>
constexpr void set_size(EmptyRow<T>&, std::size_t) noexcept {}
template <class T, std::size_t Size>
constexpr void set_size(std::array<T, Size>&, std::size_t) noexcept {}
template <class DynamicRow>
void set_size(DynamicRow& row, std::size_t size) {
  row.resize(size);
}

}  // namespace detail

/// `Size` values side by side: std::array, std::vector for dynamic_size, nothing for 0. What runs on a controller is
/// fixed; the host runs the very same code on models read from a file.
template <class T, int Size>
using Row = typename detail::RowStorage<T, Size>::type;

}  // namespace thermfit
