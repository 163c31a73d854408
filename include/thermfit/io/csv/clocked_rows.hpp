#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/io/csv/one_clock.hpp"
#include "thermfit/io/csv/row_parser.hpp"

namespace thermfit::detail {

/// Rows of channels with clocks of their own: all lines are taken first, then rows come on one clock.
class ClockedRows {
 public:
  ClockedRows(const CsvLayout& layout, BetweenSamples between, Problems& problems)
      : layout_(layout),
        between_(between),
        problems_(problems),
        one_clock_(layout.clocks.of_channel, held(layout, between), layout.clocks.fields.size()) {}

  /// Takes what a line holds, which stands at `here`.
  void take(const RowCells& cells, std::size_t line, const std::string& here) {
    std::size_t clock = 0;
    const OneClock::Fault fault = one_clock_.take(cells.batch, cells.values, line, clock);
    if (fault == OneClock::Fault::none) return;
    const std::string& name = name_of(clock);
    if (fault == OneClock::Fault::value_without_time)
      problems_.add(problem(here, {name, " is missing beside a value"}, {"a time for each value"}));
    else
      problems_.add(problem(here, {name, " stands still or goes back"}, {"time that increases from row to row"}));
  }

  /// Makes the rows; to be called behind the last line of the file at `path`.
  void finish(const std::string& path) {
    rows_ = one_clock_.rows();
    if (rows_.empty() && problems_.count() == 0)
      problems_.add(problem(path, {"has no time at which all channels are there"}, {"clocks that overlap"},
                            {"leave channels out, or say CsvOptions::time_column"}));
  }

  /// Fills the cells with the next row, whose time a sample in `line` has; false behind the last.
  bool next(RowCells& cells, std::size_t& line) {
    if (next_ == rows_.size()) return false;
    const OneClock::Row& row = rows_[next_++];
    line = row.line;
    cells.batch = *row.batch;
    cells.missing.clear();
    std::copy(row.values.begin(), row.values.end(), cells.values.begin());
    for (std::size_t c = 0; c < row.values.size(); ++c)
      if (row.values[c] != row.values[c]) cells.missing.push_back({layout_.clocks.field_of_channel[c], 0});
    cells.time_s = row.time_s;
    const double seconds = std::floor(row.time_s);
    cells.date_time = {static_cast<std::int64_t>(seconds), row.time_s - seconds, false};
    return true;
  }

  /// How the clocks became one, and how many rows that cost.
  std::string told() const {
    std::string text = std::to_string(layout_.clocks.fields.size()) + " clocks, each of the columns right of it: ";
    if (one_clock_.agree()) return text + "they agree";
    text += "rows stand at the times of " + first_channel_of(one_clock_.base()) + ", other channels ";
    text += between_ == BetweenSamples::held
                ? "hold their last sample"
                : "are linear between their samples (CsvOptions::between = held holds the last)";
    if (const std::size_t rows = one_clock_.uncovered())
      text += "; " + std::to_string(rows) + (rows == 1 ? " row" : " rows") +
              " left out where another channel has not begun or has ended";
    return text;
  }

 private:
  static std::vector<bool> held(const CsvLayout& layout, BetweenSamples between) {
    std::vector<bool> held;
    for (const std::size_t field : layout.clocks.field_of_channel)
      held.push_back(between == BetweenSamples::held || !layout.spellings[field].on.empty());
    return held;
  }
  const std::string& first_channel_of(std::size_t clock) const {
    const CsvClocks& clocks = layout_.clocks;
    const auto channel = std::find(clocks.of_channel.begin(), clocks.of_channel.end(), clock);
    return channel == clocks.of_channel.end()
               ? name_of(clock)
               : layout_.columns[clocks.field_of_channel[static_cast<std::size_t>(channel - clocks.of_channel.begin())]]
                     .name;
  }
  const std::string& name_of(std::size_t clock) const { return layout_.columns[layout_.clocks.fields[clock]].name; }

  const CsvLayout& layout_;
  BetweenSamples between_;
  Problems& problems_;
  OneClock one_clock_;
  std::vector<OneClock::Row> rows_;
  std::size_t next_ = 0;
};

}  // namespace thermfit::detail
