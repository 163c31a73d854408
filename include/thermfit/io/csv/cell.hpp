#pragma once

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>

#include "thermfit/error.hpp"
#include "thermfit/io/csv/dialect.hpp"
#include "thermfit/io/csv/spelled.hpp"
#include "thermfit/io/units.hpp"

namespace thermfit::detail {

/// Says why a cell is no number, and what to do about it.
inline Error bad_cell(const std::string& place, const std::string& column, std::string_view text,
                      const CsvDialect& dialect, const CellSpelling& spelling) {
  const std::string found = column + " is " + shown(text);
  const std::string point = dialect.decimal_mark == ',' ? "a number such as 20,1" : "a number such as 20.1";
  const auto explain = [&](const std::string& what, const std::string& remedy) {
    return problem(place, {found, (what.empty() ? "" : ", " + what)}, {point}, {remedy});
  };
  const std::string_view digits = "0123456789";
  std::string_view bare = text;
  if (!bare.empty() && (bare[0] == '-' || bare[0] == '+')) bare.remove_prefix(1);

  std::string lower(bare);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (lower == "inf" || lower == "infinity" || lower == "nan")
    return explain(lower == "nan" ? "no reading" : "an infinite value", "leave the cell empty if there was no reading");
  if (lower.rfind("0x", 0) == 0) return explain("hexadecimal", "write it in decimal");

  double value = 0;
  const auto [end, status] = std::from_chars(bare.data(), bare.data() + bare.size(), value);
  const bool whole = end == bare.data() + bare.size();
  if (status == std::errc::result_out_of_range && whole)
    return explain("beyond what a double holds", "correct the value");

  const bool only_marks = !bare.empty() && digits.find(bare.front()) != std::string_view::npos &&
                          bare.find_first_not_of("0123456789., '\xC2\xA0\xE2\x80\x99\xAF") == std::string_view::npos;
  const auto marks = std::count_if(bare.begin(), bare.end(), [](char c) { return c == ',' || c == '.'; });
  if (only_marks && (marks > 1 || bare.find_first_of(" '\xC2\xE2") != std::string_view::npos))
    return explain("with thousands separators",
                   "write it without them, or say CsvOptions::thousands = comma, point, space or apostrophe");
  if (only_marks && marks == 1)
    return explain(dialect.decimal_mark == ',' ? "a decimal point in a file with decimal comma"
                                               : "a decimal comma in a file with decimal point",
                   "use one decimal mark, or say CsvOptions::decimal_mark = comma or CsvOptions::decimal_mark = point");
  if (parse_date_time(text)) return explain("a date-time", "name the clock: CsvOptions::time_column = NAME");
  if (text.find_first_of(";\t|") != std::string_view::npos)
    return explain("", "is the file separated by something else? say CsvOptions::separator");
  if (!spelling.on.empty()) return explain("neither " + spelling.on + " nor " + spelling.off, "correct the cell");
  if (const auto parts = split_unit_in_cell(text); parts && !spelling.unit.empty())
    return explain("in " + std::string(parts->second) + ", the cells before in " + spelling.unit,
                   "one unit for a column");
  const std::size_t number = bare.find_first_not_of("0123456789.,");
  if (number != std::string_view::npos && number > 0 && find_unit(trim(bare.substr(number))))
    return explain("a number with its unit", "write the unit in brackets behind the name of the column");
  return explain("", "correct the cell, or leave it empty if there was no reading");
}

}  // namespace thermfit::detail
