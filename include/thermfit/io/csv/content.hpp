#pragma once

#include <algorithm>
#include <vector>

#include "thermfit/io/csv/header.hpp"
#include "thermfit/io/csv/stamp.hpp"
#include "thermfit/io/csv/stamp_runs.hpp"

namespace thermfit::detail {

/// What the start of the file says about each column: numbers, text, or stamps of time in the first filled cell.
struct ColumnContent {
  bool numbers = false, text = false, stamps = false;
  bool has_date = false, has_time = false;             ///< of the stamps
  bool is_iso = true;                                  ///< every stamp is a date-time of ISO 8601
  OrderEvidence order;                                 ///< of day and month
  StampRuns runs;                                      ///< of stamps that repeat
  double first = missing_value, step = missing_value;  ///< the first number, and how far the second is from it
  CellSpelling spelling;                               ///< of the numbers
  bool may_be_grouped = false;                         ///< text, but numbers if the other mark grouped thousands
};

/// A cell as a number of its column. The first one that is no plain number tells how the column spells them: with a
/// unit behind, or as one of two words.
inline std::optional<double> number_in(std::string_view text, const CsvDialect& dialect, ColumnContent& content) {
  CellSpelling& spelling = content.spelling;
  if (const auto number = parse_spelled(text, dialect.decimal_mark, dialect.thousands, spelling)) return number;
  if (content.text || content.numbers) return std::nullopt;
  if (const auto* const words = state_words(text))
    spelling.on = words->first, spelling.off = words->second;
  else if (const auto parts = split_unit_in_cell(text))
    spelling.unit = parts->second;
  const auto number = parse_spelled(text, dialect.decimal_mark, dialect.thousands, spelling);
  if (!number) spelling = {};
  return number;
}

/// Words among numbers that had words behind them make text of the column, unless those were units for sure.
inline void doubt_spelling(ColumnContent& content) {
  CellSpelling& spelling = content.spelling;
  if ((spelling.unit.empty() && spelling.on.empty()) || spelling.unit == "%" || find_unit(spelling.unit)) return;
  content.numbers = false;
  content.first = content.step = missing_value;
  spelling = {};
}

/// Whether a cell is a number if the mark that is not the decimal one groups thousands.
inline bool may_be_grouped(std::string_view text, const CsvDialect& dialect) {
  const char other = dialect.decimal_mark == '.' ? ',' : '.';
  return dialect.thousands == 0 && ungrouped(trim_hidden(text), other, dialect.decimal_mark);
}

inline std::vector<ColumnContent> column_contents(const CsvEvidence& evidence, const CsvHeader& header,
                                                  const CsvDialect& dialect) {
  std::vector<ColumnContent> contents(header.columns.size());
  std::vector<CsvField> fields;
  std::size_t undecided = contents.size();
  for (std::size_t i = header.content_lines; i < evidence.lines.size() && undecided > 0; ++i) {
    if (split_line(evidence.lines[i].text, dialect.separator, fields)) continue;
    for (std::size_t c = 0; c < std::min(contents.size(), fields.size()); ++c) {
      ColumnContent& content = contents[c];
      const bool decided = content.step == content.step && content.spelling.unit.empty() && content.spelling.on.empty();
      if (decided || is_missing(trim_hidden(fields[c].text))) continue;
      if (const auto number = number_in(fields[c].text, dialect, content)) {
        if (content.numbers && content.step != content.step) {
          content.step = *number - content.first;
          undecided -= content.spelling.unit.empty() && content.spelling.on.empty();
        }
        if (!content.numbers) content.first = *number;
        content.numbers = true;
        continue;
      }
      doubt_spelling(content);
      if (content.numbers) continue;
      const auto stamp = content.text && !content.stamps ? std::nullopt : parse_stamp(fields[c].text);
      if (stamp) {
        content.stamps = true;
        content.has_date = content.has_date || stamp->has_date;
        content.has_time = content.has_time || stamp->has_time;
        const bool exists = instant(*stamp, DateOrder::unknown) || instant(*stamp, DateOrder::month_first);
        content.is_iso = content.is_iso && (parse_date_time(fields[c].text) || !exists);
        content.order.look_at(*stamp);
        content.runs.look_at(*stamp);
      }
      content.may_be_grouped = may_be_grouped(fields[c].text, dialect) && (!content.text || content.may_be_grouped);
      content.text = true;
    }
  }
  return contents;
}

}  // namespace thermfit::detail
