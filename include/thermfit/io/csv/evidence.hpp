#pragma once

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/lines.hpp"

namespace thermfit::detail {

/// The content lines of a file's start, with their numbers.
struct CsvEvidence {
  struct Line {
    std::string_view text;
    std::size_t number;
  };
  std::vector<Line> lines;
  std::optional<Line> units;  ///< a line of units that stands apart: CsvOptions::units_begin

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

}  // namespace thermfit::detail
