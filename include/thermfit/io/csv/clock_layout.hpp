#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/io/csv/layout_draft.hpp"

namespace thermfit::detail {

/// Finds the clock among the columns, or the clocks of channels, and how its cells are read.
class ClockLayout : protected LayoutDraft {
 protected:
  using LayoutDraft::LayoutDraft;

  void assign_time() {
    if (options_.time_column == "none") return;
    const std::vector<std::size_t> found = options_.time_column.empty() ? clocks() : clocks_called();
    if (found.size() > 1 && options_.time_step_s == 0 && options_.time_column.empty() && !each_has_channels(found))
      throw problem(place_of(found[1]), {column(found[1]).name, " may be the time, and so may ", column(found[0]).name},
                    {"one clock, or one left of the columns it is for"},
                    {"say CsvOptions::time_column = ", column(found[0]).name,
                     ", or a glob that finds the clocks, each left of its columns"});
    if (options_.time_step_s > 0) return count_rows(found);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const std::size_t c = found[k];
      const std::string name = take(c, "the time");
      if (k == 0) layout_.roles.time = name;
      if (contents_[c].stamps && !contents_[c].numbers)
        read_stamps(c);
      else
        read_numbers(c);
    }
    if (found.size() > 1) layout_.clocks.fields = found;
  }

  /// Gives each channel the clock left of it, and the clocks their places behind the channels.
  void place_clocks() {
    CsvClocks& clocks = layout_.clocks;
    if (clocks.fields.empty()) return;
    clocks.of_channel.resize(values_);
    clocks.field_of_channel.resize(values_);
    for (std::size_t c = 0; c < taken_.size(); ++c) {
      if (layout_.slots[c].role != CsvRole::value || taken_[c] == "the time") continue;
      const auto right = std::upper_bound(clocks.fields.begin(), clocks.fields.end(), c);
      if (right == clocks.fields.begin())
        throw problem(place_of(c), {column(c).name, " has no clock left of it"}, {"a clock left of each column"},
                      {"say CsvOptions::time_column = NAME for one clock"});
      clocks.of_channel[layout_.slots[c].index] = static_cast<std::size_t>(right - clocks.fields.begin()) - 1;
      clocks.field_of_channel[layout_.slots[c].index] = c;
    }
    for (std::size_t k = 0; k < clocks.fields.size(); ++k) {
      CsvSlot& slot = layout_.slots[clocks.fields[k]];
      if (slot.role == CsvRole::time) slot.role = CsvRole::value;
      slot.index = values_ + k;
      const std::string& name = column(clocks.fields[k]).name;
      const auto made_up = std::find_if(layout_.roles.made_up.begin(), layout_.roles.made_up.end(),
                                        [&](const std::string& one) { return one.rfind(name + " (", 0) == 0; });
      if (made_up != layout_.roles.made_up.end()) layout_.roles.made_up.erase(made_up);
    }
  }

 private:
  /// The columns that the option names: one, or several of that name or like that glob.
  std::vector<std::size_t> clocks_called() const {
    const std::string& wanted = options_.time_column;
    std::vector<std::size_t> found;
    const bool exact = std::any_of(header_.columns.begin(), header_.columns.end(),
                                   [&](const CsvColumn& one) { return one.is_called(wanted); });
    for (std::size_t c = 0; c < header_.columns.size(); ++c) {
      const std::size_t first = column(c).same_as;
      const bool again = first > 0 && column(first - 1).is_called(wanted);
      const bool like = !exact && (matches_glob(wanted, column(c).name) || matches_glob(wanted, column(c).title));
      if (column(c).is_called(wanted) || again || like) found.push_back(c);
    }
    if (found.empty()) found.push_back(find(wanted, "CsvOptions::time_column"));
    return found;
  }

  /// Whether clocks are one a channel for sure: called alike but for what follows a number (Time, Time; Zeit 1 - slow,
  /// Zeit 2 - fast), or as the column right of them (time_T1, T1), with columns between.
  bool each_has_channels(const std::vector<std::size_t>& found) const {
    const std::string& first = column(found.front()).name;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const std::size_t c = found[k], next = k + 1 < found.size() ? found[k + 1] : header_.columns.size();
      if (next <= c + 1) return false;
      const std::size_t digit = std::min(first.find_first_of("0123456789"), first.size());
      const bool alike = column(c).same_as == found.front() + 1 ||
                         (digit < first.size() && column(c).name.compare(0, digit, first, 0, digit) == 0);
      const bool as_channel = column(c).name.find(column(c + 1).name) != std::string::npos;
      if (c != found.front() && !alike && !as_channel) return false;
    }
    return true;
  }

  /// The step that the options say is the clock; columns that may be one are left out.
  void count_rows(const std::vector<std::size_t>& clocks) {
    for (const std::size_t c : clocks) take(c, "the time");
    layout_.roles.time = "the count of rows";
    layout_.clock.row_step_s = options_.time_step_s;
  }

  /// Columns that may be the clock: by name; else by what they hold; else by a name that needs a unit to be sure.
  std::vector<std::size_t> clocks() const {
    std::vector<std::size_t> named, full, times, weak;
    for (std::size_t c = 0; c < header_.columns.size(); ++c) {
      if (!taken_[c].empty()) continue;
      const ColumnContent& content = contents_[c];
      const auto unit = find_unit(column(c).unit);
      const std::string& name = column(column(c).same_as > 0 ? column(c).same_as - 1 : c).name;
      if (!time_unit_in(name).empty())
        named.push_back(c);
      else if (content.stamps && !content.numbers)
        (content.has_date && content.has_time ? full : content.has_time ? times : weak).push_back(c);
      else if (content.numbers && may_be_clock(name) &&
               ((unit && unit->quantity == Quantity::time) || unix_scale(content.first) > 0))
        weak.push_back(c);
    }
    if (!named.empty()) return named;
    if (!full.empty()) return full;
    if (!times.empty()) return times;
    std::vector<std::size_t> sure;
    for (const std::size_t c : weak)
      if (!contents_[c].stamps) sure.push_back(c);
    return sure;
  }

  void read_stamps(std::size_t c) {
    ColumnContent& content = contents_[c];
    CsvClock& clock = layout_.clock;
    layout_.slots[c].role = CsvRole::date_time;
    clock.stamps = clock.from_first = true;
    clock.iso = content.is_iso;
    clock.dated = content.has_date;
    OrderEvidence order = content.order;
    std::string with;
    if (!content.has_date) {  // the date may stand in a column of its own
      std::vector<std::size_t> dates;
      for (std::size_t o = 0; o < contents_.size(); ++o)
        if (taken_[o].empty() && contents_[o].stamps && !contents_[o].numbers && !contents_[o].has_time)
          dates.push_back(o);
      if (dates.size() == 1) {
        with = take(dates[0], "the date");
        layout_.slots[dates[0]].role = CsvRole::date;
        order = contents_[dates[0]].order;
        clock.dated = true;
      }
    }
    clock.order = options_.time_format == TimeFormat::day_first     ? DateOrder::day_first
                  : options_.time_format == TimeFormat::month_first ? DateOrder::month_first
                                                                    : order.order();
    const StampRuns& runs = content.runs;
    std::string apart;
    if (const std::size_t rows = runs.rows_a_stamp(); rows > 0 && options_.batch_column.empty()) {
      clock.rows_a_stamp = rows;
      clock.rows_before = runs.rows_before();
      clock.row_step_s = static_cast<double>(runs.stamps_apart_s()) / static_cast<double>(rows);
      apart = ", " + std::to_string(rows) + " rows a stamp, " + exact_text(clock.row_step_s) + " s apart";
    }
    if (clock.iso && apart.empty()) return;
    std::string how = !clock.dated   ? "a time of day or elapsed time"
                      : with.empty() ? "dates and times"
                                     : "times, with the dates of " + with;
    if (order.open)
      how += clock.order == DateOrder::day_first     ? ", day before month"
             : clock.order == DateOrder::month_first ? ", month before day"
                                                     : ", all of one date";
    else if (clock.dated)
      how += order.plain ? ", day before month" : ", year before month";
    layout_.roles.clock = layout_.roles.time + " is read as " + how + apart;
  }

  /// How many of a count of years beyond 1973 make a second, if it can be nothing else: 1, 1e3, 1e6; 0 where it can.
  static double unix_scale(double first) {
    return first >= 1e8 && first < 1e11    ? 1
           : first >= 1e11 && first < 1e14 ? 1e3
           : first >= 1e14 && first < 1e17 ? 1e6
           : first >= 1e18 && first < 4e18 ? 1e9
                                           : 0;
  }

  void read_numbers(std::size_t c) {
    CsvSlot& slot = layout_.slots[c];
    slot.role = CsvRole::time;
    const ColumnContent& content = contents_[c];
    const std::string by_name = time_unit_in(column(column(c).same_as > 0 ? column(c).same_as - 1 : c).name);
    std::string unit = unit_of(c, Quantity::time);
    if (unit.empty() && by_name != "?") unit = by_name;
    if (!options_.time_unit.empty() && !unit.empty() && find_unit(unit) && find_unit(options_.time_unit) &&
        !find_unit(unit)->is_same_as(*find_unit(options_.time_unit)))
      throw problem(place_of(c), {column(c).title, " says ", unit, ", CsvOptions::time_unit says ", options_.time_unit},
                    {"one unit for a column"});
    if (unit.empty()) unit = options_.time_unit;
    const TimeFormat format = options_.time_format;
    const auto since = [&](const char* said, const std::string& how) {
      layout_.clock.from_first = true;
      layout_.roles.clock = layout_.roles.time + " is read as " + how;
      unit = said;
    };
    const bool open = unit.empty() && format == TimeFormat::from_file;
    const bool spreadsheet = content.first >= 36526 && content.first < 73051 && std::abs(content.step) < 0.02 &&
                             content.step != 0 &&
                             content.first + content.step != std::floor(content.first + content.step);
    if (format == TimeFormat::unix_s || (open && unix_scale(content.first) == 1))
      since("s", "seconds since 1970");
    else if (format == TimeFormat::unix_ms || (open && unix_scale(content.first) == 1e3))
      since("ms", "milliseconds since 1970");
    else if (open && unix_scale(content.first) == 1e6)
      since("us", "microseconds since 1970");
    else if (open && unix_scale(content.first) == 1e9)
      since("0.001 us", "nanoseconds since 1970");
    else if (format == TimeFormat::from_file && content.first >= 1e17 && content.first < 1e18 &&
             (unit.empty() || unit == options_.time_unit))
      since("0.1 us", "steps of 100 ns since 1601");
    else if (format == TimeFormat::serial_days || (open && spreadsheet))
      since("d", "days, as spreadsheets count them");
    layout_.roles.assumed_minutes = unit.empty();
    if (unit.empty()) unit = "min";
    set_unit(slot, c, Quantity::time, unit);
  }
};

}  // namespace thermfit::detail
