#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/dialect.hpp"
#include "thermfit/io/csv/stamp.hpp"
#include "thermfit/io/units.hpp"

namespace thermfit::detail {

/// The separator that a first line `sep=;` tells, as spreadsheets write it; 0 when it is another line.
inline char told_separator(std::string_view line) {
  if (line.size() > 1 && line.front() == '"' && line.back() == '"') line = line.substr(1, line.size() - 2);
  return line.size() == 5 && (starts_with(line, "sep=") || starts_with(line, "SEP=")) ? line.back() : '\0';
}

/// A line of numbers: two fields or more, at least half of those with a value numbers or stamps, the first filled one
/// too.
inline bool is_number_line(const std::vector<CsvField>& fields) {
  std::size_t filled = 0, numbers = 0;
  for (const CsvField& field : fields) {
    if (is_missing(field.text)) continue;
    const bool number = is_spelled_number(field.text) || parse_stamp(field.text);
    if (filled++ == 0 && !number) return false;
    numbers += number;
  }
  return fields.size() > 1 && numbers > 1 && 2 * numbers >= filled;
}

/// A line that may hold names: no number among its fields, and something in most of them.
inline bool is_name_line(const std::vector<CsvField>& fields) {
  std::size_t filled = 0, words = 0;
  for (const CsvField& field : fields) {
    if (is_number_or_stamp(field.text)) return false;
    filled += !field.text.empty();
    words += !is_missing(field.text);
  }
  return 2 * filled >= fields.size() && filled > 1 && 2 * words > filled;
}

/// Whether the first field of a line that holds something is a word, which rows do not begin with.
inline bool begins_with_a_word(const std::vector<CsvField>& fields) {
  for (const CsvField& field : fields)
    if (!is_missing(field.text)) return !is_spelled_number(field.text) && !parse_stamp(field.text);
  return false;
}

/// The last line above the rows that begins with `text`; as many as there are lines where none does.
inline std::size_t line_that_begins(const CsvEvidence& evidence, std::string_view text) {
  std::size_t found = evidence.lines.size();
  std::vector<CsvField> fields;
  for (std::size_t i = 0; i < evidence.lines.size(); ++i) {
    std::string_view line = trim(evidence.lines[i].text);
    if (!line.empty() && line.front() == '"') line.remove_prefix(1);
    if (starts_with(line, text)) {
      found = i;
      continue;
    }
    for (const char separator : {',', ';', '\t'})
      if (found < i && !split_line(evidence.lines[i].text, separator, fields) && is_number_line(fields)) return found;
  }
  return found;
}

/// How many content lines stand before the names: 0 where the first line has as many fields as the rows, and where no
/// line right above the rows can be their names. The rows are the longest run of lines of numbers with one count of
/// fields; three are needed. Where `names_given` names are given, so many fields are, and the rows need no names.
inline std::size_t lines_before_names(const CsvEvidence& evidence, char separator_told, std::size_t names_given = 0) {
  std::size_t best_run = 2, before = 0;
  std::vector<CsvField> fields;
  for (const char separator : {',', ';', '\t', ' '}) {
    if (separator_told ? separator != separator_told : separator == ' ') continue;
    std::size_t begin = 0, count = 0, first_fields = 0;
    std::vector<std::size_t> counts, with_empty;
    std::vector<char> kinds;  // n: numbers, t: names
    for (const auto& line : evidence.lines) {
      const bool broken = split_line(line.text, separator, fields).has_value();
      with_empty.push_back(fields.size());
      while (!broken && fields.size() > 1 && fields.back().text.empty()) fields.pop_back();
      counts.push_back(broken ? 0 : fields.size());
      kinds.push_back(broken || fields.size() < 2 ? '?'
                      : is_number_line(fields)    ? 'n'
                      : is_name_line(fields)      ? 't'
                                                  : '?');
    }
    if (!counts.empty()) first_fields = counts.front();
    for (std::size_t i = 0; i < counts.size(); ++i) {
      count = kinds[i] != 'n' ? 0 : count > 0 && counts[i] == counts[i - 1] ? count + 1 : 1;
      if (count == 1) begin = i;
      if (count <= best_run || begin == 0 || (names_given > 0 && counts[begin] != names_given)) continue;
      std::size_t names = begin;
      while (names > 0 && kinds[names - 1] == 't' && counts[names - 1] == counts[begin]) --names;
      if (names == begin && kinds[begin - 1] == 't' &&
          (counts[begin - 1] == counts[begin] + 1 || with_empty[begin - 1] == with_empty[begin]))
        --names;  // a last column unused, or without a name
      if (names == begin && names_given == 0) continue;
      best_run = count;
      before = first_fields == counts[begin] && kinds.front() == 't' ? 0 : names;
    }
  }
  return before;
}

}  // namespace thermfit::detail
