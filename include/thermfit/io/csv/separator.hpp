#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/error.hpp"
#include "thermfit/io/csv/date_time.hpp"
#include "thermfit/io/csv/evidence.hpp"
#include "thermfit/io/csv/field.hpp"
#include "thermfit/io/csv/spelled.hpp"

namespace thermfit::detail {

inline std::string separator_name(char separator) {
  return separator == ','   ? "comma"
         : separator == ';' ? "semicolon"
         : separator == '|' ? "bar"
         : separator == ' ' ? "blank"
                            : "tab";
}

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
      found.numbers += is_spelled_number(field.text) || parse_date_time(field.text);
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
    if (i > 0)
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

}  // namespace thermfit::detail
