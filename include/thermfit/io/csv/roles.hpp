#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/content.hpp"

namespace thermfit {

/// What the columns of a file mean: names by role, in the order of the file or of the options that chose them.
struct CsvRoles {
  std::string time;                         ///< empty when there is none
  std::string batch;                        ///< empty when the file is one batch
  std::vector<std::string> temperatures,    ///< temperature points, whose values are read in degC
      errors,                               ///< thermal errors, whose values are read in um
      inputs;                               ///< other columns of numbers, whose values are left as written
  std::vector<std::string> ignored;         ///< text, empty, or not asked for
  std::vector<std::string> converted;       ///< "T1 from degF"
  std::vector<std::string> contradicted;    ///< "Z in mm, its title says um": CsvOptions::units against the file
  std::vector<std::string> nearly;          ///< "t1 (not T1)": an input whose name is nearly that of another role
  std::vector<std::string> made_up;         ///< "column1 (no name)", "Temp.2 (Temp again)"
  std::vector<std::string> spelled;         ///< "T1 in °C", "coolant as on (1) or off (0)": what cells say of numbers
  std::vector<std::string> may_be_grouped;  ///< text that would be numbers if thousands were grouped
  std::vector<std::string> nameless;        ///< columns of numbers without a name, of which nobody knows what they are
  std::vector<std::string> skipped;         ///< CsvOptions::skip_columns
  std::string replaced;                     ///< names of the file that were replaced by those given
  std::string clock;                        ///< how the clock is read, where that is not plain
  bool assumed_minutes = false;             ///< nobody said what the clock counts
};

namespace detail {

enum class CsvRole { skip, empty, time, date, date_time, batch, value };

/// Where a column goes. `index` counts temperatures, then errors, then inputs.
struct CsvSlot {
  CsvRole role = CsvRole::skip;
  std::size_t index = 0;
  bool convert = false;
  Unit unit{Quantity::length, 0, 1, 1};
};

/// How the cells of a clock become seconds.
struct CsvClock {
  bool stamps = false;                   ///< dates or times of day, not numbers
  bool iso = false;                      ///< all of ISO 8601
  bool dated = false;                    ///< with a date in it or beside it; else it may pass midnight
  bool from_first = false;               ///< counts from the first row of the batch
  DateOrder order = DateOrder::unknown;  ///< of day and month
  double row_step_s = 0;                 ///< CsvOptions::time_step_s, or how far rows of one stamp are apart; else 0
  std::size_t rows_a_stamp = 0;          ///< where stamps repeat
  std::size_t rows_before = 0;           ///< of the first stamp, which the file does not have
};

/// The clocks of channels, where these have clocks of their own. Cells of clocks are kept behind those of channels.
struct CsvClocks {
  std::vector<std::size_t> fields;      ///< the columns of the clocks; empty where there is one for all
  std::vector<std::size_t> of_channel,  ///< number of the clock of each temperature, error and input
      field_of_channel;
};

struct CsvLayout {
  CsvRoles roles;
  CsvClocks clocks;
  CsvClock clock;
  std::vector<CsvSlot> slots;  ///< one a column of the file
  std::vector<CsvColumn> columns;
  std::vector<CellSpelling> spellings;  ///< of the cells, one a column
};

/// `*` stands for any text, `?` for one character.
inline bool matches_glob(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p, ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

}  // namespace detail
}  // namespace thermfit
