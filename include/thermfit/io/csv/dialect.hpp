#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/error.hpp"
#include "thermfit/io/csv/date_time.hpp"
#include "thermfit/io/csv/field.hpp"
#include "thermfit/io/csv/lines.hpp"
#include "thermfit/io/csv/options.hpp"

namespace thermfit {

namespace detail {

inline std::string separator_name(char separator) {
  return separator == ','   ? "comma"
         : separator == ';' ? "semicolon"
         : separator == '|' ? "bar"
         : separator == ' ' ? "blank"
                            : "tab";
}

}  // namespace detail

/// How a file spells its table, as found or as told.
struct CsvDialect {
  char separator = ',';                    ///< `,` `;` tab or `|`
  char decimal_mark = '.';                 ///< `.` or `,`
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
    return separator == ',' && decimal_mark == '.' && !unit_row && !returns && header_line == 0 && encoding.empty();
  }

  /// "semicolon-separated, decimal comma, unit row".
  std::string description() const {
    std::string text = detail::separator_name(separator);
    text += decimal_mark == ',' ? "-separated, decimal comma" : "-separated, decimal point";
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

namespace detail {

/// Looks like a decimal number written with `mark`, in digits only but for a sign, the mark and an exponent.
inline bool is_decimal_with(std::string_view text, char mark) {
  return text.find(mark) != std::string_view::npos && parse_field(text, mark).has_value();
}

/// `1,234`: one to three digits, then groups of three; a decimal or a grouped whole number, nobody can tell.
inline bool may_be_grouped(std::string_view text, char mark) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  const std::size_t first = text.find(mark);
  return first != std::string_view::npos && first >= 1 && first <= 3 && text.front() != '0' && text.size() == first + 4;
}

/// The content lines of a file's start, with their numbers.
struct CsvEvidence {
  struct Line {
    std::string_view text;
    std::size_t number;
  };
  std::vector<Line> lines;

  explicit CsvEvidence(std::string_view head) {
    for (std::size_t number = 1; !head.empty(); ++number) {
      const std::size_t end = std::min(head.find('\n'), head.size());
      std::string_view line = head.substr(0, end);
      head.remove_prefix(std::min(end + 1, head.size()));
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      if (is_content(line)) lines.push_back({line, number});
    }
  }
};

/// What speaks for one separator.
struct SeparatorEvidence {
  char separator;
  std::size_t header_fields = 0;        ///< fields of the first line, or the number of names given
  std::size_t matching_lines = 0;       ///< data lines with as many
  std::size_t consistent_lines = 0;     ///< data lines with as many fields as the first data line, if more than one
  std::size_t filled = 0, numbers = 0;  ///< fields of data lines that are not missing; those that are numbers

  double number_share() const { return filled == 0 ? 0 : static_cast<double>(numbers) / static_cast<double>(filled); }
};

inline SeparatorEvidence weigh_separator(char separator, const CsvEvidence& evidence, std::size_t names_given) {
  SeparatorEvidence found{separator, names_given};
  std::vector<CsvField> fields;
  std::size_t first_data_fields = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(evidence.lines.size(), 400); ++i) {
    const bool broken = split_line(evidence.lines[i].text, separator, fields).has_value();
    if (i == 0 && names_given == 0) {
      found.header_fields = broken ? 0 : fields.size();
      continue;
    }
    if (broken) continue;
    if (first_data_fields == 0) first_data_fields = fields.size();
    found.matching_lines += fields.size() == found.header_fields;
    found.consistent_lines += fields.size() > 1 && fields.size() == first_data_fields;
    for (const CsvField& field : fields) {
      if (is_missing(field.text)) continue;
      ++found.filled;
      found.numbers += is_number(field.text) || parse_date_time(field.text);
    }
  }
  return found;
}

/// Whether blanks divide every line into as many fields, two or more, of numbers in all but the first.
inline bool blanks_separate(const CsvEvidence& evidence, std::size_t names_given) {
  std::vector<CsvField> fields;
  std::size_t wanted = names_given;
  for (std::size_t i = 0; i < evidence.lines.size(); ++i) {
    if (split_line(evidence.lines[i].text, ' ', fields)) return false;
    if (wanted == 0) wanted = fields.size();
    if (i > 0 && fields.size() == 1 && fields.front().text == "overrun") continue;
    if (fields.size() != wanted || wanted < 2) return false;
    if (i > 0 || names_given > 0)
      for (const CsvField& field : fields)
        if (!is_number(field.text) && !is_missing(field.text)) return false;
  }
  return evidence.lines.size() > 1;
}

/// The separator that makes a table of the file. Throws when two do, or when the header and the rows disagree.
inline char detect_separator(const CsvEvidence& evidence, std::size_t names_given, const std::string& name) {
  std::vector<char> candidates;
  for (const char separator : {',', ';', '\t'})
    if (std::any_of(evidence.lines.begin(), evidence.lines.end(),
                    [&](const auto& line) { return line.text.find(separator) != std::string_view::npos; }))
      candidates.push_back(separator);
  if (candidates.empty() && blanks_separate(evidence, names_given)) return ' ';
  if (candidates.size() < 2) return candidates.empty() ? ',' : candidates.front();

  std::vector<SeparatorEvidence> tables, headers, rows;
  for (const char separator : candidates) {
    const SeparatorEvidence found = weigh_separator(separator, evidence, names_given);
    const bool has_rows = names_given > 0 ? !evidence.lines.empty() : evidence.lines.size() > 1;
    if (found.header_fields > 1 && (found.matching_lines > 0 || !has_rows)) tables.push_back(found);
    if (found.header_fields > 1) headers.push_back(found);
    if (found.consistent_lines > 0) rows.push_back(found);
  }
  const std::string options = "CsvOptions::separator = comma, semicolon or tab";
  const std::size_t first_line = evidence.lines.empty() ? 1 : evidence.lines.front().number;
  const auto ambiguous = [&](const SeparatorEvidence& a, const SeparatorEvidence& b) {
    return problem(place(name, first_line),
                   {"may be separated by ", separator_name(a.separator), " or by ", separator_name(b.separator)},
                   {options}, {"say which"});
  };
  if (tables.size() > 1) {
    const auto better = [](const SeparatorEvidence& a, const SeparatorEvidence& b) {
      return a.number_share() > b.number_share() && a.matching_lines >= b.matching_lines;
    };
    for (const SeparatorEvidence& one : tables)
      if (std::all_of(tables.begin(), tables.end(),
                      [&](const SeparatorEvidence& other) { return &other == &one || better(one, other); }))
        return one.separator;
    throw ambiguous(tables[0], tables[1]);
  }
  const std::vector<SeparatorEvidence>& likely = tables.empty() ? headers : tables;
  for (const SeparatorEvidence& row : rows)
    for (const SeparatorEvidence& one : likely)
      if (row.separator != one.separator && row.number_share() > one.number_share() &&
          row.consistent_lines > one.matching_lines / 2)
        throw problem(place(name, first_line),
                      {"the first line is separated by ", separator_name(one.separator), ", the rows by ",
                       separator_name(row.separator)},
                      {"one separator in the whole file"}, {"mend the first line, or say ", options});
  if (likely.size() > 1) throw ambiguous(likely[0], likely[1]);
  if (likely.size() == 1) return likely[0].separator;
  const bool has_fields =
      std::any_of(rows.begin(), rows.end(), [](const SeparatorEvidence& row) { return row.number_share() > 0.5; });
  if (has_fields && names_given != 1)
    throw problem(place(name, first_line), {"one name, but the rows have several fields"}, {"a name for each column"},
                  {"mend the first line, or say ", options});
  return ',';
}

/// The decimal mark that the cells use. Throws when they use both, or when a mark may also group thousands.
inline char detect_decimal_mark(const CsvEvidence& evidence, char separator, bool has_header, const std::string& name) {
  struct Seen {
    std::size_t count = 0, grouped = 0;
    std::string place, text;
  } points, commas;
  std::vector<CsvField> fields;
  for (std::size_t i = has_header ? 1 : 0; i < evidence.lines.size(); ++i) {
    if (split_line(evidence.lines[i].text, separator, fields)) continue;
    for (const CsvField& field : fields)
      for (const char mark : {'.', ','}) {
        if (!is_decimal_with(field.text, mark)) continue;
        Seen& seen = mark == '.' ? points : commas;
        if (seen.count++ == 0) {
          seen.place = place(name, evidence.lines[i].number, field.column);
          seen.text = shown(field.text);
        }
        seen.grouped += may_be_grouped(field.text, mark);
      }
  }
  if (commas.count == 0) return '.';
  if (points.count > 0)
    throw problem(commas.place, {commas.text, " has a comma, and ", points.text, " (", points.place, ") has a point"},
                  {"one decimal mark in a file"},
                  {"say CsvOptions::decimal_mark = comma or CsvOptions::decimal_mark = point; write numbers without "
                   "thousands separators"});
  if (separator == ',')
    throw problem(commas.place,
                  {commas.text, " in a comma-separated file may be a decimal number or grouped thousands"}, {},
                  {"say CsvOptions::decimal_mark = comma if it is a decimal number"});
  if (separator == '\t' && commas.grouped == commas.count)
    throw problem(
        commas.place, {commas.text, " may be a decimal number or grouped thousands, as all its like here"}, {},
        {"say CsvOptions::decimal_mark = comma if it is a decimal number; else write thousands without separators"});
  return ',';
}

}  // namespace detail

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
  dialect.decimal_mark = options.decimal_mark ? options.decimal_mark
                                              : detail::detect_decimal_mark(evidence, dialect.separator,
                                                                            options.columns.empty(), lines.name());
  return dialect;
}

}  // namespace thermfit
