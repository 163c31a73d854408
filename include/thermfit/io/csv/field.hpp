#pragma once

/// One line of CSV as fields, and what a field can be: missing, a number, or something else.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/number.hpp"

namespace thermfit::detail {

/// A field without its quotes and the blanks around it.
struct CsvField {
  std::string_view text;
  std::size_t column;  ///< of its first byte in the line, from 1
  bool quoted = false;

  /// The text with doubled quotes undone.
  std::string name() const {
    std::string result(text);
    if (!quoted) return result;
    for (std::size_t i = result.find("\"\""); i != std::string::npos; i = result.find("\"\"", i + 1))
      result.erase(i, 1);
    return result;
  }
};

struct CsvFieldError {
  std::size_t column;
  const char* found;
  const char* remedy;
};

/// A carriage return counts too: files with CR LF that were pasted beside each other have some inside their lines.
inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

inline std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Splits a line without its end; a blank as separator stands for any number of blanks and tabs. A quoted field ends on
/// its line; quotes elsewhere are errors.
inline std::optional<CsvFieldError> split_line(std::string_view line, char separator, std::vector<CsvField>& fields) {
  fields.clear();
  if (separator == ' ') line = trim(line);
  std::size_t at = 0;
  const auto blank = [&](std::size_t i) {
    return i < line.size() && is_blank(line[i]) && (line[i] != separator || separator == ' ');
  };
  for (;;) {
    std::size_t begin = at;
    while (blank(begin)) ++begin;
    if (begin < line.size() && line[begin] == '"') {
      std::size_t end = begin + 1;
      while (end < line.size() && (line[end] != '"' || (end + 1 < line.size() && line[end + 1] == '"')))
        end += line[end] == '"' ? 2 : 1;
      if (end >= line.size())
        return CsvFieldError{begin + 1, "a quote that is opened here and never closed",
                             "close the field on its line; a quote inside a field is written \"\""};
      fields.push_back({line.substr(begin + 1, end - begin - 1), begin + 1, true});
      at = end + 1;
      while (blank(at)) ++at;
      if (at < line.size() && line[at] != separator && !(separator == ' ' && is_blank(line[at - 1])))
        return CsvFieldError{at + 1, "text behind a closing quote", "write a quote inside a field as \"\""};
    } else {
      at = std::min(separator == ' ' ? line.find_first_of(" \t", begin) : line.find(separator, begin), line.size());
      std::size_t end = at;
      while (end > begin && is_blank(line[end - 1])) --end;
      const std::string_view text = line.substr(begin, end - begin);
      const std::size_t quote = text.find('"');
      if (quote != std::string_view::npos)
        return CsvFieldError{begin + quote + 1, "a quote inside a field",
                             "put the whole field in quotes and double the quote inside"};
      fields.push_back({text, begin + 1, false});
    }
    if (at >= line.size()) return std::nullopt;
    at += separator != ' ';
  }
}

/// Empty, or what files and instruments write without a reading, in any case: `NA`, `NaN`, `null`, an open or
/// overloaded input (`OL`, `Overflow`, `Burnout`), a spreadsheet's error (`#NV`), a mark (`---`, `*`, `?`).
inline bool is_missing(std::string_view text) {
  if (text.empty()) return true;
  if (text.size() > 10) return false;
  char lower[10] = {};
  for (std::size_t i = 0; i < text.size(); ++i)
    lower[i] = text[i] >= 'A' && text[i] <= 'Z' ? static_cast<char>(text[i] - 'A' + 'a') : text[i];
  const std::string_view word(lower, text.size());
  if (word.find_first_not_of('-') == std::string_view::npos || word.find_first_not_of('*') == std::string_view::npos ||
      word.find_first_not_of('?') == std::string_view::npos)
    return true;
  for (const std::string_view mark :
       {"na",      "n/a",       "n.a.",       "nan",     "-nan",    "null",    "none",     "ol",       "o.l",
        "o.l.",    "+ol",       "-ol",        "over",    "+over",   "-over",   "overflow", "overload", "overrange",
        "under",   "underflow", "underrange", "burnout", "open",    "open tc", "opentc",   "#nv",      "#n/a",
        "#na",     "#wert!",    "#value!",    "#div/0!", "#bezug!", "#ref!",   "#num!",    "#zahl!",   "1.#qnan",
        "-1.#ind", "1.#ind",    "invalid",    "bad",     "err",     "error",   "fault"})
    if (word == mark) return true;
  return false;
}

/// A whole field as a number, with `mark` for the decimal point.
inline std::optional<double> parse_field(std::string_view text, char mark) {
  if (text.size() > 3 && text.size() < 64 && text.substr(0, 3) == "\xE2\x88\x92") {  // the minus of typesetters
    char buffer[64] = {'-'};
    const std::string_view rest = text.substr(3);
    if (rest.front() == '-' || rest.front() == '+' || rest.front() == '\xE2') return std::nullopt;
    std::copy(rest.begin(), rest.end(), buffer + 1);
    return parse_field({buffer, rest.size() + 1}, mark);
  }
  if (mark == '.') return parse_number(text);
  char buffer[64];
  if (text.size() > sizeof buffer || text.find('.') != std::string_view::npos) return std::nullopt;
  std::replace_copy(text.begin(), text.end(), buffer, mark, '.');
  return parse_number({buffer, text.size()});
}

/// Whether a field is a number, with a point or a comma.
inline bool is_number(std::string_view text) { return parse_field(text, '.') || parse_field(text, ','); }

/// Reads a plain fixed-point number at `begin` and moves `begin` behind it. False, with `begin` anywhere, for whatever
/// needs more care: exponents, more than 53 bits, signs with a plus, no digit. The quotient of two integers that
/// doubles hold is rounded once, hence equal to what from_chars gives (Clinger's fast path).
inline bool parse_fixed(const char*& begin, const char* end, char mark, double& value) {
  static constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8, 1e9,
                                      1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18};
  const char* at = begin;
  const bool negative = at < end && *at == '-';
  at += negative;
  const char* const digits = at;
  std::uint64_t number = 0;
  unsigned digit = 0;
  while (at < end && (digit = static_cast<unsigned>(*at - '0')) < 10) number = 10 * number + digit, ++at;
  std::ptrdiff_t count = at - digits, decimals = 0;
  if (at < end && *at == mark) {
    const char* const fraction = ++at;
    while (at < end && (digit = static_cast<unsigned>(*at - '0')) < 10) number = 10 * number + digit, ++at;
    decimals = at - fraction;
    count += decimals;
  }
  begin = at;
  if (count == 0 || count > 18 || number > (std::uint64_t{1} << 53)) return false;
  const double magnitude = static_cast<double>(number) / powers[decimals];
  value = negative ? -magnitude : magnitude;
  return true;
}

inline constexpr double missing_value = std::numeric_limits<double>::quiet_NaN();

/// Shortens a cell for a message and makes what cannot be printed visible.
inline std::string shown(std::string_view text) {
  std::string result = "'";
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (i >= 40 && (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return result + "…'";
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte >= 32 && byte != 127) {
      result += text[i];
    } else {
      result += "\\x";
      result += "0123456789abcdef"[byte >> 4];
      result += "0123456789abcdef"[byte & 15];
    }
  }
  return result + "'";
}

}  // namespace thermfit::detail
