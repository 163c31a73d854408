#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/lines.hpp"
#include "thermfit/io/csv/marks.hpp"
#include "thermfit/io/csv/options.hpp"
#include "thermfit/io/csv/separator.hpp"

namespace thermfit {

/// How a file spells its table, as found or as told.
struct CsvDialect {
  char separator = ',';                    ///< `,` `;` tab or `|`
  char decimal_mark = '.';                 ///< `.` or `,`
  char thousands = 0;                      ///< what groups them: `.` `,` `'` or a blank; 0: nothing does
  bool bom = false,                        ///< a byte order mark comes first
      crlf = false,                        ///< the first line ends in CR LF
      returns = false,                     ///< carriage returns stand inside lines, and count as blanks
      compressed = false,                  ///< it is gzip
      unit_row = false;                    ///< the line below or above the names holds their units
  std::string encoding;                    ///< where it is not UTF-8
  std::vector<std::string> missing_marks;  ///< CsvOptions::missing_marks
  std::size_t header_line = 0;             ///< of the names in the file where lines stand before it, else 0

  /// Whether commas separate, points are decimal marks, and there is nothing to be told. Does not allocate.
  bool is_plain() const {
    return separator == ',' && decimal_mark == '.' && !unit_row && !returns && header_line == 0 && encoding.empty() &&
           thousands == 0;
  }

  /// "semicolon-separated, decimal comma, unit row".
  std::string description() const {
    std::string text = detail::separator_name(separator);
    text += decimal_mark == ',' ? "-separated, decimal comma" : "-separated, decimal point";
    if (thousands) text += std::string(", thousands grouped by ") + detail::group_name(thousands);
    if (unit_row) text += ", unit row";
    if (header_line > 0) text += ", names in line " + std::to_string(header_line) + ", those above left out";
    if (bom) text += ", byte order mark";
    if (crlf) text += ", CRLF";
    if (!encoding.empty()) text += ", " + encoding;
    if (returns) text += ", carriage returns inside lines taken as blanks";
    if (compressed) text += ", gzip";
    return text;
  }
};

/// Finds out how a file is written from the whole start of it (64 kB); what the options say is taken as said.
inline CsvDialect detect_dialect(const detail::CsvLines& lines, const detail::CsvEvidence& evidence,
                                 const CsvOptions& options) {
  CsvDialect dialect;
  dialect.encoding = lines.encoding();
  dialect.missing_marks = options.missing_marks;
  dialect.bom = lines.has_bom();
  dialect.crlf = lines.has_crlf();
  dialect.compressed = lines.compressed();
  dialect.returns = std::any_of(evidence.lines.begin(), evidence.lines.end(),
                                [](const auto& line) { return line.text.find('\r') != std::string_view::npos; });
  dialect.separator =
      options.separator ? options.separator : detail::detect_separator(evidence, options.columns.size(), lines.name());
  const detail::NumberMarks marks = detail::detect_marks(evidence, dialect.separator, options.columns.empty(),
                                                         {options.decimal_mark, options.thousands}, lines.name());
  dialect.decimal_mark = marks.decimal;
  dialect.thousands = marks.thousands;
  return dialect;
}

}  // namespace thermfit
