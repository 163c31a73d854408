#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "thermfit/constants.hpp"
#include "thermfit/number.hpp"

namespace thermfit {

/// What a unit measures, told by thermfit in s, degC or um.
enum class Quantity { time, temperature, length };

/// A unit as a way to thermfit's own: `canonical = (value - zero) * numerator / denominator` in s, degC or um.
/// Two factors, so that 212 degF is 100 degC and 0.1 h is 360 s to the last digit.
struct Unit {
  Quantity quantity;  ///< what it measures
  double zero,        ///< value in this unit that is 0 in thermfit's own
      numerator,      ///< of the factor from this unit to thermfit's own
      denominator;    ///< of the same; never 0

  /// A value in this unit, in s, degC or um. Does not allocate.
  double to_canonical(double value) const { return (value - zero) * numerator / denominator; }
  /// Whether it is thermfit's own, so that values stay as they are. Does not allocate.
  bool is_canonical() const { return zero == 0 && numerator == denominator; }
};

namespace detail {

struct NamedUnit {
  std::string_view name;
  Unit unit;
};

inline constexpr std::array<NamedUnit, 45> unit_table{{
    {"s", {Quantity::time, 0, 1, 1}},
    {"sec", {Quantity::time, 0, 1, 1}},
    {"second", {Quantity::time, 0, 1, 1}},
    {"seconds", {Quantity::time, 0, 1, 1}},
    {"ms", {Quantity::time, 0, 1, 1000}},
    {"us", {Quantity::time, 0, 1, 1e6}},
    {"min", {Quantity::time, 0, 60, 1}},
    {"minute", {Quantity::time, 0, 60, 1}},
    {"minutes", {Quantity::time, 0, 60, 1}},
    {"h", {Quantity::time, 0, 3600, 1}},
    {"hour", {Quantity::time, 0, 3600, 1}},
    {"hours", {Quantity::time, 0, 3600, 1}},
    {"d", {Quantity::time, 0, 86400, 1}},
    {"day", {Quantity::time, 0, 86400, 1}},
    {"days", {Quantity::time, 0, 86400, 1}},
    {"degC", {Quantity::temperature, 0, 1, 1}},
    {"°C", {Quantity::temperature, 0, 1, 1}},
    {"℃", {Quantity::temperature, 0, 1, 1}},
    {"C", {Quantity::temperature, 0, 1, 1}},
    {"deg C", {Quantity::temperature, 0, 1, 1}},
    {"Celsius", {Quantity::temperature, 0, 1, 1}},
    {"celsius", {Quantity::temperature, 0, 1, 1}},
    {"degF", {Quantity::temperature, 32, 5, 9}},
    {"°F", {Quantity::temperature, 32, 5, 9}},
    {"℉", {Quantity::temperature, 32, 5, 9}},
    {"F", {Quantity::temperature, 32, 5, 9}},
    {"deg F", {Quantity::temperature, 32, 5, 9}},
    {"Fahrenheit", {Quantity::temperature, 32, 5, 9}},
    {"K", {Quantity::temperature, ice_point_K, 1, 1}},
    {"kelvin", {Quantity::temperature, ice_point_K, 1, 1}},
    {"Kelvin", {Quantity::temperature, ice_point_K, 1, 1}},
    {"um", {Quantity::length, 0, 1, 1}},
    {"µm", {Quantity::length, 0, 1, 1}},  // micro sign
    {"μm", {Quantity::length, 0, 1, 1}},  // Greek mu
    {"micron", {Quantity::length, 0, 1, 1}},
    {"microns", {Quantity::length, 0, 1, 1}},
    {"nm", {Quantity::length, 0, 1, 1000}},
    {"mm", {Quantity::length, 0, 1000, 1}},
    {"cm", {Quantity::length, 0, 10000, 1}},
    {"m", {Quantity::length, 0, 1e6, 1}},
    {"in", {Quantity::length, 0, 25400, 1}},
    {"inch", {Quantity::length, 0, 25400, 1}},
    {"mil", {Quantity::length, 0, 25.4, 1}},
    {"thou", {Quantity::length, 0, 25.4, 1}},
    {"microinch", {Quantity::length, 0, 254, 10000}},
}};

}  // namespace detail

/// The unit that `text` names, also with a factor before it (`0.1 um`, as some controls count); nothing when unknown.
inline std::optional<Unit> find_unit(std::string_view text) {
  for (const auto& [name, unit] : detail::unit_table)
    if (name == text) return unit;
  const std::size_t blank = text.find(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  const auto factor = parse_number(text.substr(0, blank));
  if (!factor || *factor <= 0) return std::nullopt;
  for (const auto& [name, unit] : detail::unit_table)
    if (name == text.substr(blank + 1))
      return Unit{unit.quantity, unit.zero / *factor, unit.numerator * *factor, unit.denominator};
  return std::nullopt;
}

/// The usual spellings of the units of a quantity, for messages.
inline std::string_view unit_names(Quantity quantity) {
  switch (quantity) {
    case Quantity::time:
      return "us, ms, s, min, h, d";
    case Quantity::temperature:
      return "degC, °C, C, degF, °F, F, K";
    case Quantity::length:
      break;
  }
  return "um, µm, nm, mm, cm, m, in, mil, microinch, or with a factor as in 0.1 um";
}

}  // namespace thermfit
