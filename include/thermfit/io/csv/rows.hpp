#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/io/csv/cell.hpp"
#include "thermfit/io/csv/layout.hpp"
#include "thermfit/io/csv/lines.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// One row of a file, in thermfit's units. The views hold until the next row is asked for.
struct CsvRow {
  using Values = Eigen::Map<const Eigen::RowVectorXd>;
  std::size_t line;        ///< in the file, from 1
  std::string_view batch;  ///< value of the batch column; empty without one
  double time_s;           ///< NaN without a clock
  Values temperatures, errors, inputs;
  Index held_values = 0;  ///< values that were missing and are the last ones of their channel
};

/// What was met while reading one file.
struct CsvFile {
  std::string path;  ///< `stdin` for standard input
  CsvDialect dialect;
  CsvRoles roles;
  std::size_t rows = 0;     ///< rows handed out
  std::size_t missing = 0;  ///< cells without a value, in columns that are used
  std::size_t dropped_rows = 0;
  std::string first_missing;  ///< `file:line:column (T3)`
};

/// Reads a file row by row in constant memory. Problems of rows go to `problems`; such rows are left out.
class CsvRowReader {
 public:
  /// Opens the file and finds out what it holds. Throws Error when it cannot be a table.
  CsvRowReader(const std::string& path, const CsvOptions& options, Problems& problems)
      : options_(options), problems_(problems), lines_(path, options.max_line_bytes) {
    const detail::CsvEvidence evidence(lines_.head());
    file_.path = lines_.name();
    file_.dialect = detect_dialect(lines_, evidence, options_);
    const detail::CsvHeader header = detail::read_header(evidence, file_.dialect, options_, file_.path);
    layout_ =
        detail::LayoutMaker(header, detail::column_contents(evidence, header, file_.dialect), options_, file_.path)
            .make();
    file_.roles = layout_.roles;
    values_.resize(layout_.roles.temperatures.size() + layout_.roles.errors.size() + layout_.roles.inputs.size());
    all_rows_ragged_ = no_row_fits(evidence, header);
    std::string_view line;
    for (std::size_t taken = 0; taken < header.content_lines && lines_.next(line);) taken += detail::is_content(line);
  }

  const CsvFile& file() const { return file_; }

  /// Rows of a batch (by its value in the batch column) left out so far for missing values.
  Index dropped_rows(const std::string& batch = {}) const {
    const auto found = states_.find(batch);
    return found == states_.end() ? 0 : found->second.dropped_rows;
  }

  /// The next row that is good; false at the end, after which missing values and an absence of rows are told.
  bool next(CsvRow& row) {
    std::string_view line;
    while (lines_.next(line)) {
      if (!detail::is_content(line)) continue;
      ++seen_rows_;
      missing_.clear();
      batch_ = {};
      time_s_ = detail::missing_value;
      if (!parse_plain(line) && !parse_carefully(line)) continue;
      if (!enter_state() || !settle_missing() || !check_time()) continue;
      ++file_.rows;
      const auto count = [](const auto& names) { return static_cast<Index>(names.size()); };
      const double* const values = values_.data();
      const CsvRoles& roles = layout_.roles;
      new (&row) CsvRow{lines_.line_number(),
                        batch_,
                        time_s_,
                        {values, count(roles.temperatures)},
                        {values + count(roles.temperatures), count(roles.errors)},
                        {values + count(roles.temperatures) + count(roles.errors), count(roles.inputs)},
                        options_.missing == MissingValues::hold ? static_cast<Index>(missing_.size()) : 0};
      return true;
    }
    finish();
    return false;
  }

 private:
  using Role = detail::CsvRole;

  struct Missing {
    std::size_t field, column;
  };

  /// What is remembered of a batch from row to row.
  struct State {
    double time_s = -HUGE_VAL;
    bool has_origin = false;
    DateTime origin{};
    std::vector<double> held;
    Index dropped_rows = 0;
  };

  bool no_row_fits(const detail::CsvEvidence& evidence, const detail::CsvHeader& header) {
    for (std::size_t i = header.content_lines; i < evidence.lines.size(); ++i)
      if (detail::split_line(evidence.lines[i].text, file_.dialect.separator, fields_) ||
          fields_.size() == layout_.slots.size())
        return false;
    return evidence.lines.size() > header.content_lines + 1;
  }

  std::string here(std::size_t column = 0) const { return detail::place(file_.path, lines_.line_number(), column); }
  const std::string& name_of(std::size_t field) const { return layout_.columns[field].name; }

  /// The fast way: plain numbers, no quotes. False when anything is out of the ordinary; then parse_carefully decides.
  bool parse_plain(std::string_view line) {
    const char separator = file_.dialect.separator, mark = file_.dialect.decimal_mark;
    const char* at = line.data();
    const char* const end = at + line.size();
    const std::size_t fields = layout_.slots.size();
    for (std::size_t f = 0; f < fields; ++f) {
      const detail::CsvSlot& slot = layout_.slots[f];
      const char* const begin = at;
      double value = 0;
      if (slot.role == Role::value || slot.role == Role::time) {
        if (!detail::parse_fixed(at, end, mark, value) || (at < end && *at != separator)) {
          at = find_end(begin, end, separator);
          const std::string_view text = detail::trim({begin, static_cast<std::size_t>(at - begin)});
          if (text.find('"') != std::string_view::npos) return false;
          if (!take_number(text, f, static_cast<std::size_t>(text.data() - line.data()) + 1, value)) return false;
        }
        store(slot, value);
      } else {
        at = find_end(begin, end, separator);
        const std::string_view text = detail::trim({begin, static_cast<std::size_t>(at - begin)});
        if (text.find('"') != std::string_view::npos) return false;
        if (slot.role == Role::empty && !text.empty()) return false;
        if (slot.role == Role::batch) batch_ = text;
        if (slot.role == Role::date_time && !take_date_time(text, f, static_cast<std::size_t>(begin - line.data()) + 1))
          return false;
      }
      if (at == end) return f + 1 == fields;
      ++at;
    }
    return false;
  }

  static const char* find_end(const char* begin, const char* end, char separator) {
    return std::find(begin, end, separator);
  }

  /// The slow way, which tells everything that is wrong with a row. False when the row cannot be used.
  bool parse_carefully(std::string_view line) {
    missing_.clear();
    if (const auto broken = detail::split_line(line, file_.dialect.separator, fields_)) {
      problems_.add(detail::problem(here(broken->column), {broken->found}, {}, {broken->remedy}));
      return false;
    }
    if (fields_.size() != layout_.slots.size()) {
      if (all_rows_ragged_) throw ragged();  // said once
      problems_.add(ragged());
      return false;
    }
    bool good = true;
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      const detail::CsvSlot& slot = layout_.slots[f];
      const detail::CsvField& field = fields_[f];
      double value = 0;
      switch (slot.role) {
        case Role::skip:
          break;
        case Role::batch:
          batch_text_ = field.name();
          batch_ = batch_text_;
          break;
        case Role::empty:
          if (field.text.empty()) break;
          problems_.add(detail::problem(here(field.column), {detail::shown(field.text), " in a column without a name"},
                                        {}, {"give the last column a name"}));
          good = false;
          break;
        case Role::date_time:
          if (take_date_time(field.text, f, field.column)) break;
          problems_.add(detail::problem(
              here(field.column), {name_of(f), " is ", detail::shown(field.text)},
              {"an ISO 8601 date-time such as 2024-05-31T08:00:00, with a zone in all rows or in none"}));
          good = false;
          break;
        case Role::time:
        case Role::value:
          if (take_number(field.text, f, field.column, value)) {
            store(slot, value);
            break;
          }
          problems_.add(detail::bad_cell(here(field.column), name_of(f), field.text, file_.dialect));
          good = false;
      }
    }
    return good;
  }

  Error ragged() const {
    const std::size_t found = fields_.size(), names = layout_.columns.size(), wanted = layout_.slots.size();
    const char separator = file_.dialect.separator;
    const std::string count = std::string(all_rows_ragged_ ? "in every row " : "") + std::to_string(found) +
                              (found == 1 ? " field" : " fields") + " under " + std::to_string(wanted) +
                              (wanted == 1 ? " name" : " names");
    if (found < wanted)
      return detail::problem(here(),
                             {count, ": ",
                              (found < names ? name_of(found) : "the last, without name,") +
                                  (found + 1 < wanted ? " and what follows are" : " is"),
                              " not there"},
                             {"a field for each name"}, {"complete the row, or delete it"});
    if (found == wanted + 1 && fields_.back().text.empty())
      return detail::problem(here(fields_.back().column),
                             {count, ": the row ends in a ", detail::separator_name(separator)},
                             {"a field for each name"},
                             {"end the first line in a ", detail::separator_name(separator), " too, or no row"});
    return detail::problem(
        here(fields_[wanted].column), {count, ": ", detail::shown(fields_[wanted].text), " is too many"},
        {"a field for each name"},
        {separator == ',' ? "if the comma is the decimal mark too, save with semicolons; put text with commas in quotes"
                          : "delete the surplus, or name the column"});
  }

  bool take_number(std::string_view text, std::size_t field, std::size_t column, double& value) {
    if (const auto number = detail::parse_field(text, file_.dialect.decimal_mark)) {
      value = *number;
      return true;
    }
    if (!detail::is_missing(text)) return false;
    value = detail::missing_value;
    missing_.push_back({field, column});
    return true;
  }

  bool take_date_time(std::string_view text, std::size_t field, std::size_t column) {
    if (const auto parsed = parse_date_time(text)) {
      if (zone_known_ && parsed->has_zone != has_zone_) return false;
      zone_known_ = true;
      has_zone_ = parsed->has_zone;
      date_time_ = *parsed;
      return true;
    }
    if (!detail::is_missing(text)) return false;
    missing_.push_back({field, column});
    return true;
  }

  void store(const detail::CsvSlot& slot, double value) {
    if (slot.convert) value = slot.unit.to_canonical(value);
    (slot.role == Role::time ? time_s_ : values_[slot.index]) = value;
  }

  /// Finds the batch that the row belongs to. False when its name is missing.
  bool enter_state() {
    if (!layout_.roles.batch.empty() && batch_.empty()) {
      problems_.add(detail::problem(here(), {layout_.roles.batch, " is empty"}, {"the name of a batch in every row"}));
      return false;
    }
    if (!state_ || batch_ != current_batch_) {
      current_batch_ = batch_;
      state_ = &states_[current_batch_];
    }
    return true;
  }

  bool settle_missing() {
    if (missing_.empty()) return true;
    if (file_.missing == 0)
      file_.first_missing = here(missing_.front().column) + " (" + name_of(missing_.front().field) + ")";
    file_.missing += missing_.size();
    if (options_.missing == MissingValues::keep) return true;
    if (options_.missing == MissingValues::hold) {
      for (const Missing& one : missing_) {
        const detail::CsvSlot& slot = layout_.slots[one.field];
        if (slot.role != Role::value || state_->held.empty()) {
          problems_.add(detail::problem(
              here(one.column),
              {name_of(one.field), " is missing, and ",
               (slot.role == Role::value ? "there is no value before it to hold" : "time cannot be held")},
              {"CsvOptions::missing = drop"}));
          return false;
        }
        values_[slot.index] = state_->held[slot.index];
      }
      return true;
    }
    ++file_.dropped_rows;
    ++state_->dropped_rows;
    return false;
  }

  bool check_time() {
    if (layout_.roles.time.empty()) return remember();
    const bool missing_time = std::any_of(missing_.begin(), missing_.end(), [&](const Missing& one) {
      return layout_.slots[one.field].role != Role::value;
    });
    if (missing_time) return remember();
    if (is_date_time()) {
      if (!state_->has_origin) state_->origin = date_time_;
      state_->has_origin = true;
      time_s_ = static_cast<double>(date_time_.seconds - state_->origin.seconds) +
                (date_time_.fraction - state_->origin.fraction);
    }
    const double before = state_->time_s;
    state_->time_s = time_s_;
    if (time_s_ > before || !options_.increasing_time) return remember();
    problems_.add(detail::problem(
        here(),
        {layout_.roles.time, (time_s_ == before ? " stands still at " : " goes back to "), exact_text(time_s_),
         " s" + (time_s_ == before ? "" : " from " + exact_text(before) + " s")},
        {"time that increases from row to row"},
        {"split runs with CsvOptions::batch_column or into files, or leave time out: CsvOptions::time_column = none"}));
    return false;
  }

  bool is_date_time() const {
    return std::any_of(layout_.slots.begin(), layout_.slots.end(),
                       [](const auto& slot) { return slot.role == Role::date_time; });
  }

  bool remember() {
    if (options_.missing == MissingValues::hold) state_->held = values_;
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

  std::vector<double> values_;  ///< temperatures, errors, inputs of the row
  double time_s_ = detail::missing_value;
  DateTime date_time_{};
  bool zone_known_ = false, has_zone_ = false;
  std::string_view batch_;
  std::string batch_text_, current_batch_;
  std::vector<Missing> missing_;
  std::vector<detail::CsvField> fields_;
  std::map<std::string, State> states_;
  State* state_ = nullptr;
  std::size_t seen_rows_ = 0;
  bool all_rows_ragged_ = false;
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
