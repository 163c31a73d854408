#pragma once

/// Numbers to text and back without a locale: std::to_chars and std::from_chars only.

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace thermfit {

/// Shortest text that reads back to the same double; `nan`, `inf`, `-inf` where it is not finite. Allocates the text.
inline std::string exact_text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

/// `value` with `decimals` digits after the point; non-finite values read `nan`, `inf`, `-inf`. Never prints `-0`.
/// Allocates the text.
inline std::string fixed_text(double value, int decimals) {
  if (!std::isfinite(value)) return exact_text(value);
  char buffer[400];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr;
  std::string text(buffer, end);
  if (text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

/// `value` with `digits` significant digits, in the shorter of fixed and scientific notation. Allocates the text.
inline std::string general_text(double value, int digits) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits).ptr;
  return std::string(buffer, end);
}

/// The finite decimal number that `text` spells as a whole; nothing for blanks, trailing characters, hex, nan, inf or
/// a value no double holds. One leading '+' is allowed. Does not allocate.
inline std::optional<double> parse_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && (text.front() == '+' || text.front() == '-')) return std::nullopt;
  }
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace thermfit
