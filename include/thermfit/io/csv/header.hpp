#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/dialect.hpp"
#include "thermfit/io/csv/preamble.hpp"
#include "thermfit/io/csv/stamp.hpp"
#include "thermfit/io/csv/title.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/io/problems.hpp"
#include "thermfit/io/units.hpp"

namespace thermfit {

namespace detail {

inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

/// The unit that a column's name says it is a time in: `s` for time_s, `?` for Time; empty when it is no time.
inline std::string time_unit_in(const std::string& name) {
  const std::string lower = lower_case(name);
  if (lower == "time" || name == "t") return "?";
  if (lower.rfind("time_", 0) != 0) return {};
  const auto unit = find_unit(name.substr(5));
  return unit && unit->quantity == Quantity::time ? name.substr(5) : std::string();
}

/// Whether a name is one that clocks have among others, so that a unit or what it holds must say so too.
inline bool may_be_clock(const std::string& name) {
  const std::string lower = lower_case(name);
  for (const char* word :
       {"timestamp", "time stamp", "elapsed", "elapsed time", "elapsed_time", "date",    "datetime", "date time",
        "date_time", "date/time",  "zeit",    "zeitstempel",  "uhrzeit",      "datum",   "temps",    "tiempo",
        "tempo",     "hora",       "heure",   "时间",         "日期",         "x_value", "x value"})
    if (lower == word) return true;
  return lower.rfind("zeit ", 0) == 0 || lower.rfind("time ", 0) == 0;
}

struct CsvHeader {
  std::vector<CsvColumn> columns;
  std::size_t line = 0;              ///< of the names; 0 when they were given
  std::size_t content_lines = 0;     ///< lines it takes: names, unit row
  bool given = false;                ///< the names are CsvOptions::columns
  std::string replaced;              ///< the line of names that those given stand for; empty without one
  std::vector<std::string> made_up;  ///< "Temp.2 (Temp again)": names that the file does not give
  bool empty_last_column = false;    ///< rows and header end in a separator
};

inline bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = byte < 0x80                   ? 1
                               : byte >= 0xC2 && byte < 0xE0 ? 2
                               : byte >= 0xE0 && byte < 0xF0 ? 3
                               : byte >= 0xF0 && byte < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (std::size_t k = 1; k < length; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0) != 0x80) return false;
    i += length;
  }
  return true;
}

/// A line of units below the names: no cell is a number, at least one is a unit of temperature, length or time.
inline bool is_unit_row(const std::vector<CsvField>& fields, std::vector<std::string>& units) {
  units.clear();
  bool known = false;
  for (const CsvField& field : fields) {
    std::string_view text = field.text;
    if (is_number(text)) return false;
    if (text.size() > 1 && ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')')))
      text = trim(text.substr(1, text.size() - 2));
    units.emplace_back(text == "-" ? std::string_view() : text);
    known = known || (find_unit(text) && !is_spelled_number(field.text));  // 20 °C is no unit, 0.1 um beside others is
  }
  return known;
}

/// Throws Error where a line is no UTF-8.
inline void require_utf8(std::string_view line, std::size_t number, const std::string& name) {
  if (!is_utf8(line))
    throw problem(
        place(name, number), {"names that are not UTF-8"}, {"text in UTF-8"},
        {"say CsvOptions::encoding = NAME: latin1 or cp1252 in western Europe, gb18030 in China, shift_jis in Japan"});
}

/// The columns that a line names, the `number`th of `name`. Throws Error when it is no UTF-8 or its quotes do not
/// match.
inline std::vector<CsvColumn> columns_in(std::string_view line, std::size_t number, char separator,
                                         const std::string& name) {
  require_utf8(line, number, name);
  std::vector<CsvField> fields;
  if (const auto broken = split_line(line, separator, fields))
    throw problem(place(name, number, broken->column), {broken->found}, {}, {broken->remedy});
  std::vector<CsvColumn> columns;
  for (const CsvField& field : fields) columns.push_back(column_of(field));
  keep_names_apart(columns);
  return columns;
}

inline CsvHeader names_given(const CsvOptions& options) {
  CsvHeader header;
  header.given = true;
  for (const std::string& name : options.columns) header.columns.push_back(column_of({name, 0, false}));
  keep_names_apart(header.columns);
  return header;
}

inline bool rows_end_in_separator(const CsvEvidence& evidence, char separator) {
  std::vector<CsvField> fields;
  for (std::size_t i = 1; i < evidence.lines.size(); ++i)
    if (!split_line(evidence.lines[i].text, separator, fields) && !fields.back().text.empty()) return false;
  return true;
}

/// Whether every row has exactly one field less than there are names.
inline bool lacks_last_field(const CsvEvidence& evidence, char separator, std::size_t names) {
  std::vector<CsvField> fields;
  for (std::size_t i = 1; i < evidence.lines.size(); ++i)
    if (split_line(evidence.lines[i].text, separator, fields) || fields.size() + 1 != names) return false;
  return evidence.lines.size() > 1;
}

inline CsvHeader names_read(const CsvEvidence& evidence, CsvDialect& dialect, const CsvOptions& options,
                            const std::string& name) {
  CsvHeader header;
  const auto& first = evidence.lines.front();
  header.line = first.number;
  header.content_lines = 1;
  header.columns = columns_in(first.text, first.number, dialect.separator, name);
  if (std::all_of(header.columns.begin(), header.columns.end(), [&](const CsvColumn& column) {
        return is_missing(column.title) || is_spelled_number(column.title) || parse_stamp(column.title);
      }))
    throw problem(place(name, first.number), {"numbers where the names of the columns should be"}, {"a header line"},
                  {"add one, or name the columns: CsvOptions::columns = NAME,NAME,…"});
  if (header.columns.size() > 2 && header.columns.back().title == "Comment" &&
      lacks_last_field(evidence, dialect.separator, header.columns.size()))
    header.columns.pop_back();  // LabVIEW names it also where no row has one
  header.empty_last_column = header.columns.size() > 1 && header.columns.back().title.empty() &&
                             rows_end_in_separator(evidence, dialect.separator);
  if (header.empty_last_column) header.columns.pop_back();

  std::vector<CsvField> fields;
  std::vector<std::string> units;
  if (!split_line(first.text, dialect.separator, fields) && is_unit_row(fields, units) && evidence.lines.size() > 2 &&
      std::all_of(header.columns.begin(), header.columns.end(),
                  [](const CsvColumn& column) { return column.title.empty() || find_unit(column.title); }) &&
      !split_line(evidence.lines[1].text, dialect.separator, fields) && fields.size() == units.size() &&
      std::none_of(fields.begin(), fields.end(), [&](const CsvField& field) {
        return field.text.empty() || is_number_or_stamp(field.text);
      })) {  // units above the names
    dialect.unit_row = true;
    header.line = evidence.lines[1].number;
    header.content_lines = 2;
    header.columns = columns_in(evidence.lines[1].text, header.line, dialect.separator, name);
    for (std::size_t c = 0; c < header.columns.size(); ++c)
      if (header.columns[c].unit.empty()) header.columns[c].unit = units[c];
    return header;
  }
  if (evidence.lines.size() > 1) require_utf8(evidence.lines[1].text, evidence.lines[1].number, name);
  if (evidence.lines.size() > 1 && !split_line(evidence.lines[1].text, dialect.separator, fields) &&
      fields.size() == header.columns.size() + header.empty_last_column && is_unit_row(fields, units)) {
    dialect.unit_row = true;
    header.content_lines = 2;
    for (std::size_t c = 0; c < header.columns.size(); ++c) {
      std::string& unit = header.columns[c].unit;
      const auto above = find_unit(unit), below = find_unit(units[c]);
      if (!unit.empty() && !units[c].empty() && !(above && below && above->is_same_as(*below)) && unit != units[c])
        throw problem(place(name, evidence.lines[1].number, fields[c].column),
                      {"unit ", units[c], " below a name that says ", unit}, {"one unit for a column"});
      if (unit.empty()) unit = units[c];
    }
  }
  // Lines of words, as of channel numbers: below names and units, or below names that are certain.
  const bool certain = !options.names_begin.empty() || options.header_line > 0;
  std::size_t& taken = header.content_lines;
  while ((dialect.unit_row || certain) && taken + 1 < evidence.lines.size() &&
         !split_line(evidence.lines[taken].text, dialect.separator, fields) &&
         (certain ? begins_with_a_word(fields)
                  : fields.size() == header.columns.size() + header.empty_last_column &&
                        std::none_of(fields.begin(), fields.end(), [&](const CsvField& field) {
                          return is_missing(field.text) || is_number_or_stamp(field.text);
                        })))
    ++taken;
  if (evidence.units && !split_line(evidence.units->text, dialect.separator, fields)) {
    dialect.unit_row = true;
    for (std::size_t c = 1; c < std::min(fields.size(), header.columns.size()); ++c)
      if (header.columns[c].unit.empty()) header.columns[c].unit = fields[c].text;
  }
  return header;
}

/// Puts the names given over those of a line of names that is there, whose units stay where none are given. Throws when
/// there are more or fewer.
inline CsvHeader names_over(CsvHeader header, const CsvOptions& options, const std::string& name) {
  CsvHeader given = names_given(options);
  std::vector<std::string> titles;
  for (const CsvColumn& column : header.columns) titles.push_back(visible_name(column.title));
  if (given.columns.size() != header.columns.size())
    throw problem(place(name, header.line),
                  {"names ", std::to_string(header.columns.size()), " columns, CsvOptions::columns ",
                   std::to_string(given.columns.size())},
                  {"a name for each of: ", name_list(titles)});
  for (std::size_t c = 0; c < given.columns.size(); ++c) {
    CsvColumn& column = given.columns[c];
    column.position = header.columns[c].position;
    if (column.unit.empty()) column.unit = header.columns[c].unit;
  }
  given.line = header.line;
  given.content_lines = header.content_lines;
  given.empty_last_column = header.empty_last_column;
  given.replaced = std::to_string(header.line) + ": " + name_list(titles);
  return given;
}

/// Whether the first line holds names although names are given: the options say which line does, or it has words only.
inline bool has_names(const CsvEvidence& evidence, char separator, const CsvOptions& options) {
  if (options.columns.empty() || options.header_line > 0 || !options.names_begin.empty()) return true;
  std::vector<CsvField> fields;
  return !evidence.lines.empty() && !split_line(evidence.lines.front().text, separator, fields) && is_name_line(fields);
}

/// The names and units of the columns, from the options or from the first content lines.
inline CsvHeader read_header(const CsvEvidence& evidence, CsvDialect& dialect, const CsvOptions& options,
                             const std::string& name) {
  if (evidence.lines.empty() && options.columns.empty())
    throw problem(name, {"has no line with content"}, {"a header line and rows of numbers"});
  CsvHeader header = has_names(evidence, dialect.separator, options) ? names_read(evidence, dialect, options, name)
                                                                     : names_given(options);
  if (header.line > 0 && !options.columns.empty()) header = names_over(std::move(header), options, name);
  if (header.columns.size() > options.max_columns)
    throw problem(place(name, header.line), {std::to_string(header.columns.size()), " columns"},
                  {"at most ", std::to_string(options.max_columns)},
                  {"is this the right file, and the right CsvOptions::separator?"});
  Problems problems(options.max_errors);
  std::map<std::string, std::size_t> first_of_name;
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    const CsvColumn& column = header.columns[c];
    const bool given = header.given;
    const std::string at = given ? "CsvOptions::columns" : place(name, header.line, column.position);
    if (column.name.empty() && given)
      problems.add(problem(at, {"column ", std::to_string(c + 1), " has no name"}, {"a name for each column"}));
    const auto [before, fresh] = first_of_name.emplace(column.name, c + 1);
    if (fresh && !column.name.empty()) continue;
    if (given) {
      problems.add(problem(at,
                           {"column ", std::to_string(c + 1), " is called ", shown(column.name), " like column ",
                            std::to_string(before->second)},
                           {"names that differ"}));
      continue;
    }
    std::string made = column.name.empty() ? "column" + std::to_string(c + 1) : column.name + ".2";
    for (int n = 3; first_of_name.count(made) || std::any_of(header.columns.begin(), header.columns.end(),
                                                             [&](const CsvColumn& one) { return one.is_called(made); });
         ++n)
      made = (column.name.empty() ? "column" + std::to_string(c + 1) : column.name) + '.' + std::to_string(n);
    header.made_up.push_back(column.name.empty() ? made + " (no name)" : made + " (" + column.name + " again)");
    CsvColumn& named = header.columns[c];
    if (!fresh && !column.name.empty()) named.same_as = before->second;
    named.nameless = column.name.empty();
    named.name = named.title = made;
    first_of_name.emplace(made, c + 1);
  }
  problems.throw_if_any();
  return header;
}

}  // namespace detail
}  // namespace thermfit
