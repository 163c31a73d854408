#pragma once

#include <algorithm>
#include <vector>

#include "thermfit/io/csv/header.hpp"

namespace thermfit::detail {

/// What the start of the file says about each column: numbers, text, or date-times in the first filled cell.
struct ColumnContent {
  bool numbers = false, text = false, date_time = false;
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
      if (content.numbers || is_missing(fields[c].text)) continue;
      if (!content.text && parse_date_time(fields[c].text)) content.date_time = true;
      if (parse_field(fields[c].text, dialect.decimal_mark)) {
        content.numbers = true;
        --undecided;
      } else {
        content.text = true;
      }
    }
  }
  return contents;
}

}  // namespace thermfit::detail
