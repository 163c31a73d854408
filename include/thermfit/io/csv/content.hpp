#pragma once

#include <algorithm>
#include <vector>

#include "thermfit/io/csv/header.hpp"
#include "thermfit/io/csv/stamp.hpp"

namespace thermfit::detail {

/// What the start of the file says about each column: numbers, text, or stamps of time in the first filled cell.
struct ColumnContent {
  bool numbers = false, text = false, stamps = false;
  bool has_date = false, has_time = false;             ///< of the stamps
  bool is_iso = true;                                  ///< every stamp is a date-time of ISO 8601
  OrderEvidence order;                                 ///< of day and month
  double first = missing_value, step = missing_value;  ///< the first number, and how far the second is from it
};

inline std::vector<ColumnContent> column_contents(const CsvEvidence& evidence, const CsvHeader& header,
                                                  const CsvDialect& dialect) {
  std::vector<ColumnContent> contents(header.columns.size());
  std::vector<CsvField> fields;
  std::size_t undecided = contents.size();
  for (std::size_t i = header.content_lines; i < evidence.lines.size() && undecided > 0; ++i) {
    if (split_line(evidence.lines[i].text, dialect.separator, fields)) continue;
    for (std::size_t c = 0; c < std::min(contents.size(), fields.size()); ++c) {
      ColumnContent& content = contents[c];
      if (content.step == content.step || is_missing(fields[c].text)) continue;
      if (const auto number = parse_field(fields[c].text, dialect.decimal_mark)) {
        if (content.numbers) {
          content.step = *number - content.first;
          --undecided;
        }
        if (!content.numbers) content.first = *number;
        content.numbers = true;
        continue;
      }
      if (content.numbers) continue;
      const auto stamp = content.text && !content.stamps ? std::nullopt : parse_stamp(fields[c].text);
      if (stamp) {
        content.stamps = true;
        content.has_date = content.has_date || stamp->has_date;
        content.has_time = content.has_time || stamp->has_time;
        const bool exists = instant(*stamp, DateOrder::unknown) || instant(*stamp, DateOrder::month_first);
        content.is_iso = content.is_iso && (parse_date_time(fields[c].text) || !exists);
        content.order.look_at(*stamp);
      }
      content.text = true;
    }
  }
  return contents;
}

}  // namespace thermfit::detail
