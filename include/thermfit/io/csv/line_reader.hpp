#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/date_time.hpp"
#include "thermfit/io/csv/header.hpp"

namespace thermfit {

/// A table that arrives line by line and is answered line by line: the first line names the columns, each further one
/// is a row. Names, quotes and units are those of a file; what a file shows in its rows is not there yet, so the
/// separator is the one of `,` `;` tab that splits the names into most columns, and a comma is a decimal mark where it
/// does not separate.
class CsvLineReader {
 public:
  /// Whether a line holds anything: not blank, no comment (`#` first), a byte order mark before it or not.
  static bool has_content(std::string_view line) { return detail::is_content(without_mark(line)); }

  /// Takes the line of names, the `line_number`th of `name`. Throws Error when it is no UTF-8 or a quote is never
  /// closed.
  CsvLineReader(std::string_view names, std::size_t line_number, std::string name)
      : name_(std::move(name)), line_number_(line_number) {
    const std::string_view line = without_end(without_mark(names));
    separator_ = separator_of(line);
    columns_ = detail::columns_in(line, line_number_, separator_, name_);
  }

  /// The columns in the order of the line of names; find() and value() count them from 0. Does not allocate.
  const std::vector<CsvColumn>& columns() const { return columns_; }

  /// The column called `wanted`, or nothing. Throws Error when there are two, or when it has a unit that is none of
  /// `quantity`.
  std::optional<std::size_t> find(const std::string& wanted, Quantity quantity) const {
    std::optional<std::size_t> found;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (!columns_[c].is_called(wanted)) continue;
      if (found) throw detail::problem(detail::place(name_, line_number_), {"column '", wanted, "' twice"});
      found = c;
    }
    if (found && unit_of(columns_[*found], quantity).quantity != quantity)
      throw detail::problem(detail::place(name_, line_number_, columns_[*found].position),
                            {"unit '", columns_[*found].unit, "' of '", wanted, "'"},
                            {std::string(unit_names(quantity))});
    return found;
  }

  /// The column that tells the time: named as one (time_s, time_min, Time, t, with a unit or in minutes), as in a file;
  /// or nothing. Throws Error when there are two.
  std::optional<std::size_t> find_time() const {
    std::optional<std::size_t> found;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (detail::time_unit_in(columns_[c].name).empty()) continue;
      if (found)
        throw detail::problem(detail::place(name_, line_number_, columns_[c].position),
                              {columns_[c].name, " may be the time, and so may ", columns_[*found].name},
                              {"one clock"});
      found = c;
    }
    return found;
  }

  /// The cell of the column that find_time() gave, in s, an ISO 8601 time too; NaN when it holds neither.
  double time_s(std::size_t column) const {
    if (const auto time = parse_date_time(cells_[column])) return static_cast<double>(time->seconds) + time->fraction;
    const std::string in_name = detail::time_unit_in(columns_[column].name);
    std::string unit = columns_[column].unit.empty() ? in_name : columns_[column].unit;
    if (unit == "?") unit = "min";
    const auto known = find_unit(unit);
    const auto number = detail::parse_field(cells_[column], '.');
    return known && number ? known->to_canonical(*number) : detail::missing_value;
  }

  /// Takes the cells of a row. False, and the row before is kept, when it has not as many cells as there are names.
  bool take(std::string_view row) {
    std::string line(without_end(row));
    std::vector<detail::CsvField> fields;
    if (detail::split_line(line, separator_, fields) || fields.size() != columns_.size()) return false;
    cells_.clear();
    for (const detail::CsvField& field : fields) cells_.emplace_back(field.text);
    return true;
  }

  /// The cell of a column that find() gave for `quantity`, in s, degC or um; NaN when it holds no number.
  double value(std::size_t column, Quantity quantity) const {
    const std::string& cell = cells_[column];
    auto number = detail::parse_field(cell, '.');
    if (!number && separator_ != ',') number = detail::parse_field(cell, ',');
    return number ? unit_of(columns_[column], quantity).to_canonical(*number) : detail::missing_value;
  }

 private:
  static std::string_view without_mark(std::string_view line) {
    const bool marked = line.substr(0, detail::byte_order_mark.size()) == detail::byte_order_mark;
    return line.substr(marked ? detail::byte_order_mark.size() : 0);
  }

  static std::string_view without_end(std::string_view line) {
    return !line.empty() && line.back() == '\r' ? line.substr(0, line.size() - 1) : line;
  }

  static char separator_of(std::string_view names) {
    char best = ',';
    std::size_t most = 0;
    std::vector<detail::CsvField> fields;
    for (const char separator : {',', ';', '\t'})
      if (!detail::split_line(names, separator, fields) && fields.size() > most) {
        most = fields.size();
        best = separator;
      }
    return best;
  }

  /// A unit that is not known counts as one of another quantity.
  static Unit unit_of(const CsvColumn& column, Quantity quantity) {
    if (column.unit.empty()) return {quantity, 0, 1, 1};
    const Quantity another = quantity == Quantity::time ? Quantity::length : Quantity::time;
    return find_unit(column.unit).value_or(Unit{another, 0, 1, 1});
  }

  std::string name_;
  std::size_t line_number_;
  char separator_ = ',';
  std::vector<CsvColumn> columns_;
  std::vector<std::string> cells_;
};

}  // namespace thermfit
