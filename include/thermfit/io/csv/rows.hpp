#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/io/csv/clocked_rows.hpp"
#include "thermfit/io/csv/row.hpp"
#include "thermfit/io/csv/row_parser.hpp"
#include "thermfit/io/csv/table_start.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Reads a file row by row in constant memory. Problems of rows go to `problems`; such rows are left out.
class CsvRowReader {
 public:
  /// Opens the file and finds out what it holds. Throws Error when it cannot be a table.
  CsvRowReader(const std::string& path, const CsvOptions& options, Problems& problems)
      : options_(options),
        problems_(problems),
        lines_(path, options.max_line_bytes, options.encoding),
        parser_(layout_, file_.dialect, places_, file_.path, problems),
        cells_(parser_.cells()) {
    file_.path = lines_.name();
    detail::TableStart start(lines_, options_, file_, places_);
    const std::size_t before = start.find();
    const detail::CsvEvidence& evidence = start.evidence();
    file_.dialect = detect_dialect(lines_, evidence, options_);
    const detail::CsvHeader header = detail::read_header(evidence, file_.dialect, options_, file_.path);
    layout_ =
        detail::LayoutMaker(header, detail::column_contents(evidence, header, file_.dialect), options_, file_.path)
            .make();
    file_.roles = layout_.roles;
    may_decrease_ = options_.newest_first && evidence.lines.size() >= header.content_lines + 3;  // two may be a mistake
    parser_.start(evidence, header);
    if (before > 0 && header.line > 0) file_.dialect.header_line = header.line;
    std::string_view line;
    for (std::size_t taken = 0; taken < before + header.content_lines && lines_.next(line);)
      taken += detail::is_content(line);
  }

  /// What was met so far: dialect and roles from the start, counts up to the row that next() gave last. Does not
  /// allocate.
  const CsvFile& file() const { return file_; }

  /// Rows of a batch (by its value in the batch column) left out so far for missing values.
  Index dropped_rows(const std::string& batch = {}) const {
    const auto found = states_.find(batch);
    return found == states_.end() ? 0 : found->second.dropped_rows;
  }

  /// Whether the rows of a batch come newest first. Does not allocate.
  bool newest_first(const std::string& batch = {}) const {
    const auto found = states_.find(batch);
    return found != states_.end() && found->second.decreasing && !found->second.to_and_fro;
  }

  /// The rows of a batch met so far, also those left out. Does not allocate.
  Index rows_met(const std::string& batch) const { return states_.at(batch).rows; }
  /// Temperatures of the oldest row of a batch, also where it is left out; NaN where it has none. Does not allocate.
  const std::vector<double>& first_degC(const std::string& batch) const { return states_.at(batch).first_degC; }

  /// The next row that is good; false at the end, after which missing values and an absence of rows are told.
  bool next(CsvRow& row) {
    while (layout_.clocks.fields.empty() ? next_line() : next_on_one_clock()) {
      if (!enter_state()) continue;
      remember_first();
      if (!settle_missing() || !check_time()) continue;
      ++file_.rows;
      const auto count = [](const auto& names) { return static_cast<Index>(names.size()); };
      const double* const values = cells_.values.data();
      const CsvRoles& roles = layout_.roles;
      new (&row) CsvRow{line_number_,
                        cells_.batch,
                        cells_.time_s,
                        {values, count(roles.temperatures)},
                        {values + count(roles.temperatures), count(roles.errors)},
                        {values + count(roles.temperatures) + count(roles.errors), count(roles.inputs)},
                        options_.missing == MissingValues::hold ? static_cast<Index>(cells_.missing.size()) : 0,
                        state_->rows,
                        {state_->first_degC.data(), count(roles.temperatures)},
                        begins_s()};
      return true;
    }
    finish();
    return false;
  }

 private:
  using Role = detail::CsvRole;

  /// Fills the cells from the next line that is a row.
  bool next_line() {
    std::string_view line;
    while (lines_.next(line)) {
      if (!detail::is_content(line)) continue;
      ++seen_rows_;
      line_number_ = lines_.line_number();
      if (parser_.parse(line, line_number_)) return true;
      if (!parser_.was_no_row()) continue;
      --seen_rows_;
      if (file_.left_out_lines++ == 0) file_.first_left_out = here() + " (" + detail::shown(line) + ")";
    }
    return false;
  }

  /// Fills the cells from the next row of what all lines hold, put on one clock.
  bool next_on_one_clock() {
    if (!clocked_) {
      clocked_ = std::make_unique<detail::ClockedRows>(layout_, options_.between, problems_);
      while (next_line()) clocked_->take(cells_, line_number_, here());
      clocked_->finish(file_.path);
      file_.clocks = clocked_->told();
    }
    return clocked_->next(cells_, line_number_);
  }

  /// What is remembered of a batch from row to row.
  struct State {
    double time_s = -HUGE_VAL;
    bool has_origin = false;
    DateTime origin{};
    double origin_s = 0;
    bool decreasing = false, to_and_fro = false;  ///< newest row first; not all rows the same way
    Index rows_timed = 0;
    std::size_t rows_of_stamp = 0;      ///< before this one, where stamps repeat
    std::int64_t stamp_s = 0;           ///< the stamp of the row before
    std::int64_t days = 0, last_s = 0;  ///< midnights passed, and the row before, for times of day
    std::vector<double> held;
    std::vector<double> first_degC;
    Index rows = 0;
    Index dropped_rows = 0;
  };

  std::string here(std::size_t column = 0) const { return places_.place_of(file_.path, line_number_, column); }
  const std::string& name_of(std::size_t field) const { return layout_.columns[field].name; }

  /// Finds the batch that the row belongs to. False when its name is missing.
  bool enter_state() {
    if (!layout_.roles.batch.empty() && cells_.batch.empty()) {
      problems_.add(detail::problem(here(), {layout_.roles.batch, " is empty"}, {"the name of a batch in every row"}));
      return false;
    }
    if (!state_ || cells_.batch != current_batch_) {
      current_batch_ = cells_.batch;
      state_ = &states_[current_batch_];
    }
    return true;
  }

  /// What counts from the first row counts from it also when it is left out.
  void remember_first() {
    const auto temperatures = static_cast<std::ptrdiff_t>(layout_.roles.temperatures.size());
    if (++state_->rows == 1) state_->first_degC.assign(cells_.values.begin(), cells_.values.begin() + temperatures);
    if (layout_.clock.row_step_s > 0 && !layout_.clock.stamps)
      cells_.time_s = layout_.clock.row_step_s * static_cast<double>(state_->rows - 1);
    if (state_->decreasing) state_->first_degC.assign(cells_.values.begin(), cells_.values.begin() + temperatures);
    if (state_->has_origin || !layout_.clock.from_first || lacks_time()) return;
    state_->origin = cells_.date_time;
    state_->origin.seconds += cells_.date_s;
    state_->origin_s = cells_.time_s;
    state_->rows_of_stamp = layout_.clock.rows_before;
    shift(state_->origin, layout_.clock.row_step_s * static_cast<double>(layout_.clock.rows_before));
    state_->has_origin = true;
  }

  static void shift(DateTime& time, double seconds) {
    time.fraction += seconds;
    const double whole = std::floor(time.fraction);
    time.seconds += static_cast<std::int64_t>(whole);
    time.fraction -= whole;
  }

  /// Time 0 of the batch since 1970, where stamps tell dates.
  double begins_s() const {
    if (!state_->has_origin || !layout_.clock.stamps || !layout_.clock.dated) return detail::missing_value;
    return static_cast<double>(state_->origin.seconds) + state_->origin.fraction;
  }

  bool lacks_time() const {
    return std::any_of(cells_.missing.begin(), cells_.missing.end(),
                       [&](const detail::MissingCell& one) { return layout_.slots[one.field].role != Role::value; });
  }

  /// Cells of errors or inputs that need not be there are no missing values.
  void forgive() {
    if (cells_.missing.empty() || (!options_.errors_may_lack && !options_.inputs_may_lack)) return;
    const std::size_t errors = layout_.roles.temperatures.size(), inputs = errors + layout_.roles.errors.size();
    const auto forgiven = [&](const detail::MissingCell& one) {
      const detail::CsvSlot& slot = layout_.slots[one.field];
      if (slot.role != Role::value || slot.index < errors) return false;
      return slot.index < inputs ? options_.errors_may_lack : options_.inputs_may_lack;
    };
    cells_.missing.erase(std::remove_if(cells_.missing.begin(), cells_.missing.end(), forgiven), cells_.missing.end());
  }

  bool settle_missing() {
    forgive();
    if (cells_.missing.empty()) return true;
    if (file_.missing == 0)
      file_.first_missing = here(cells_.missing.front().column) + " (" + name_of(cells_.missing.front().field) + ")";
    file_.missing += cells_.missing.size();
    if (options_.missing == MissingValues::keep) return true;
    if (options_.missing == MissingValues::hold) {
      for (const detail::MissingCell& one : cells_.missing) {
        const detail::CsvSlot& slot = layout_.slots[one.field];
        if (slot.role != Role::value || state_->held.empty()) {
          problems_.add(detail::problem(
              here(one.column),
              {name_of(one.field), " is missing, and ",
               (slot.role == Role::value ? "there is no value before it to hold" : "time cannot be held")},
              {"CsvOptions::missing = drop"}));
          return false;
        }
        cells_.values[slot.index] = state_->held[slot.index];
      }
      return true;
    }
    ++file_.dropped_rows;
    ++state_->dropped_rows;
    return false;
  }

  bool check_time() {
    if (layout_.roles.time.empty()) return remember();
    if (lacks_time()) return remember();
    if (layout_.clock.from_first) count_from_first();
    const double before = state_->time_s;
    state_->time_s = cells_.time_s;
    if (may_decrease_ && state_->rows_timed == 1 && cells_.time_s < before) state_->decreasing = true;
    ++state_->rows_timed;
    const bool onward =
        state_->rows_timed == 1 || (state_->decreasing ? cells_.time_s < before : cells_.time_s > before);
    state_->to_and_fro = state_->to_and_fro || !onward;
    if (onward || !options_.increasing_time) return remember();
    problems_.add(detail::problem(
        here(),
        {layout_.roles.time,
         (cells_.time_s == before ? " stands still at "
          : state_->decreasing    ? " decreased, and goes up to "
                                  : " goes back to "),
         exact_text(cells_.time_s), " s" + (cells_.time_s == before ? "" : " from " + exact_text(before) + " s")},
        {"time that increases from row to row"},
        {cells_.time_s == before ? "say CsvOptions::time_step_s = SECONDS if rows are evenly apart; else " : "",
         "split runs with CsvOptions::batch_column or into files, or leave time out: CsvOptions::time_column = none"}));
    return false;
  }

  /// Seconds since the first row of the batch, from stamps or from numbers that count from long ago. A time of day that
  /// goes back by more than half a day has passed midnight.
  void count_from_first() {
    State& state = *state_;
    if (!layout_.clock.stamps) {
      cells_.time_s -= state.origin_s;
      return;
    }
    DateTime now = cells_.date_time;
    now.seconds += cells_.date_s;
    if (!layout_.clock.dated) {
      now.seconds += state.days * 86400;
      if (now.seconds + 43200 < state.last_s) ++state.days, now.seconds += 86400;
      state.last_s = now.seconds;
    }
    if (layout_.clock.rows_a_stamp > 0) {
      if (state.rows_timed > 0) state.rows_of_stamp = now.seconds == state.stamp_s ? state.rows_of_stamp + 1 : 0;
      state.stamp_s = now.seconds;
      shift(now, layout_.clock.row_step_s * static_cast<double>(state.rows_of_stamp));
    }
    cells_.time_s = static_cast<double>(now.seconds - state.origin.seconds) + (now.fraction - state.origin.fraction);
  }

  bool remember() {
    if (options_.missing == MissingValues::hold) state_->held = cells_.values;
    return true;
  }

  void finish() {
    if (options_.missing == MissingValues::error && file_.missing > 0)
      problems_.add(detail::problem(
          file_.first_missing,
          {file_.missing == 1 ? "a value is missing"
                              : std::to_string(file_.missing) + " values are missing, this is the first"},
          {"a number in every cell"},
          {"CsvOptions::missing = drop leaves such rows out, CsvOptions::missing = hold repeats the last value"}));
    else if (seen_rows_ == 0)
      problems_.add(detail::problem(file_.path, {"has no rows"}, {"at least one row of numbers"}));
    else if (file_.rows == 0 && problems_.count() == 0)
      problems_.add(detail::problem(file_.path, {"has no row without a missing value"}, {"at least one"}));
  }

  CsvOptions options_;
  Problems& problems_;
  detail::CsvLines lines_;
  CsvFile file_;
  detail::CsvLayout layout_;

  detail::CellPlaces places_;  ///< where the cells of a long table stand in the file
  detail::RowParser parser_;
  detail::RowCells& cells_;  ///< of the row

  std::string current_batch_;
  std::map<std::string, State> states_;
  State* state_ = nullptr;
  std::size_t seen_rows_ = 0, line_number_ = 0;
  std::unique_ptr<detail::ClockedRows> clocked_;  ///< where channels have clocks of their own
  bool may_decrease_ = false;
};

/// Hands each row of a file to `row`, in constant memory; `begin` hears first what the columns mean. Rows with problems
/// are not handed out; all problems are thrown at the end (or when there are `max_errors`), so a caller that throws
/// away its sums on an exception uses good files only. Returns what was met.
template <typename Scalar = double>
CsvFile read_rows(const std::string& path, const CsvOptions& options, const std::function<void(const CsvFile&)>& begin,
                  const std::function<void(const CsvRow&)>& take_row) {
  Problems problems(options.max_errors);
  CsvRowReader reader(path, options, problems);
  if (begin) begin(reader.file());
  CsvRow row{0, {}, 0, {nullptr, 0}, {nullptr, 0}, {nullptr, 0}};
  while (reader.next(row)) take_row(row);
  problems.throw_if_any();
  return reader.file();
}

THERMFIT_COMPILED_TEMPLATE(CsvFile read_rows<double>(const std::string&, const CsvOptions&,
                                                     const std::function<void(const CsvFile&)>&,
                                                     const std::function<void(const CsvRow&)>&));

}  // namespace thermfit
