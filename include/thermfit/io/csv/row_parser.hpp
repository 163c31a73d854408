#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/cell.hpp"
#include "thermfit/io/csv/layout.hpp"
#include "thermfit/io/csv/lines.hpp"
#include "thermfit/io/csv/long_table.hpp"

namespace thermfit::detail {

/// A cell of a column that is used, without a value.
struct MissingCell {
  std::size_t field, column;
};

/// What a row holds, in thermfit's units; NaN where a value is missing.
struct RowCells {
  std::vector<double> values;  ///< temperatures, errors, inputs
  double time_s = missing_value;
  DateTime date_time{};
  std::int64_t date_s = 0;  ///< of a date in a column of its own, since 1970
  std::string_view batch;
  std::vector<MissingCell> missing;
};

/// Makes cells of lines, each line by itself. Refers to the layout and the dialect, which may be filled in later.
class RowParser {
 public:
  RowParser(const CsvLayout& layout, const CsvDialect& dialect, const CellPlaces& places, const std::string& path,
            Problems& problems)
      : layout_(layout), dialect_(dialect), places_(places), path_(path), problems_(problems) {}

  /// To be called when layout and dialect are known: makes room, and finds out whether no row has as many fields as
  /// there are names, which is then told of the first row only.
  void start(const CsvEvidence& evidence, const CsvHeader& header) {
    cells_.values.resize(layout_.roles.temperatures.size() + layout_.roles.errors.size() + layout_.roles.inputs.size() +
                         layout_.clocks.fields.size());
    all_rows_ragged_ = no_row_fits(evidence, header);
    if (header.line > 0 && !evidence.lines.empty()) names_ = std::string(trim(evidence.lines.front().text));
  }

  /// False, and what is wrong with it has gone to the problems, when a line cannot be used.
  bool parse(std::string_view line, std::size_t line_number) {
    line_number_ = line_number;
    cells_.missing.clear();
    cells_.batch = {};
    cells_.time_s = missing_value;
    no_row_ = false;
    if (parse_plain(line)) return true;
    no_row_ = is_no_row(line);
    return !no_row_ && parse_carefully(line);
  }

  /// Whether the line that parse() refused last is none of the table's rows, for sure.
  bool was_no_row() const { return no_row_; }

  /// Of the line that parse() took last; the batch is a view into the line.
  RowCells& cells() { return cells_; }

 private:
  bool no_row_fits(const CsvEvidence& evidence, const CsvHeader& header) {
    for (std::size_t i = header.content_lines; i < evidence.lines.size(); ++i)
      if (split_line(evidence.lines[i].text, dialect_.separator, fields_) || fields_.size() == layout_.slots.size())
        return false;
    return evidence.lines.size() > header.content_lines + 1;
  }

  /// The line of names again, a word that ends a file, a lost sample of a sampler, or a row that begins with the name
  /// of a sum where a number or a stamp belongs.
  bool is_no_row(std::string_view line) {
    const std::string_view text = trim(line);
    if (!names_.empty() && text == names_) return true;
    if (text.empty()) return false;
    if (text.find(dialect_.separator) == std::string_view::npos ||
        text.find_first_not_of(",;\t ", 1) == std::string_view::npos)
      for (const char* word : {"eof", "end", "end of file", "end of data", "overrun"})
        if (layout_.slots.size() > 1 && lower_case(std::string(text)) == word) return true;
    if (split_line(line, dialect_.separator, fields_) || fields_.empty()) return false;
    const CsvRole role = layout_.slots.front().role;
    if (role != CsvRole::time && role != CsvRole::date && role != CsvRole::date_time && role != CsvRole::value)
      return false;
    const std::string first = lower_case(std::string(fields_.front().text));
    for (const char* word : {"max", "min", "mean", "avg", "average", "sum", "std", "stdev", "std dev", "median",
                             "maximum", "minimum", "total", "count", "range", "mittelwert", "summe", "anzahl"})
      if (first == word || first == std::string(word) + ':') return true;
    return false;
  }

  std::string here(std::size_t column = 0) const { return places_.place_of(path_, line_number_, column); }
  const std::string& name_of(std::size_t field) const { return layout_.columns[field].name; }

  /// The fast way: plain numbers, no quotes. False when anything is out of the ordinary; then parse_carefully decides.
  bool parse_plain(std::string_view line) {
    if (!dialect_.missing_marks.empty() || dialect_.separator == ' ') return false;  // a mark may look like a number
    const char separator = dialect_.separator, mark = dialect_.decimal_mark;
    const char* at = line.data();
    const char* const end = at + line.size();
    const std::size_t fields = layout_.slots.size();
    for (std::size_t f = 0; f < fields; ++f) {
      const CsvSlot& slot = layout_.slots[f];
      const char* const begin = at;
      double value = 0;
      if (slot.role == CsvRole::value || slot.role == CsvRole::time) {
        if (!parse_fixed(at, end, mark, value) || (at < end && *at != separator)) {
          at = find_end(begin, end, separator);
          const std::string_view text = trim({begin, static_cast<std::size_t>(at - begin)});
          if (text.find('"') != std::string_view::npos) return false;
          if (!take_number(text, f, static_cast<std::size_t>(text.data() - line.data()) + 1, value)) return false;
        }
        store(slot, value);
      } else {
        at = find_end(begin, end, separator);
        const std::string_view text = trim({begin, static_cast<std::size_t>(at - begin)});
        if (text.find('"') != std::string_view::npos) return false;
        if (slot.role == CsvRole::empty && !text.empty()) return false;
        if (slot.role == CsvRole::batch) cells_.batch = text;
        if ((slot.role == CsvRole::date_time || slot.role == CsvRole::date) &&
            !take_date_time(text, f, static_cast<std::size_t>(begin - line.data()) + 1))
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
    cells_.missing.clear();
    if (const auto broken = split_line(line, dialect_.separator, fields_)) {
      problems_.add(problem(here(broken->column), {broken->found}, {}, {broken->remedy}));
      return false;
    }
    if (fields_.size() != layout_.slots.size() && !ends_before_a_clock()) {
      if (all_rows_ragged_) throw ragged();  // said once
      problems_.add(ragged());
      return false;
    }
    bool good = true;
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      const CsvSlot& slot = layout_.slots[f];
      const CsvField& field = fields_[f];
      double value = 0;
      switch (slot.role) {
        case CsvRole::skip:
          break;
        case CsvRole::batch:
          batch_text_ = field.name();
          cells_.batch = batch_text_;
          break;
        case CsvRole::empty:
          if (field.text.empty()) break;
          problems_.add(problem(here(field.column), {shown(field.text), " in a column without a name"}, {},
                                {"give the last column a name"}));
          good = false;
          break;
        case CsvRole::date:
        case CsvRole::date_time:
          if (take_date_time(field.text, f, field.column)) break;
          if (layout_.clock.dated && !layout_.clock.iso) {
            problems_.add(bad_stamp(field, f));
            good = false;
            break;
          }
          problems_.add(
              problem(here(field.column), {name_of(f), " is ", shown(field.text)},
                      {"an ISO 8601 date-time such as 2024-05-31T08:00:00, with a zone in all rows or in none"}));
          good = false;
          break;
        case CsvRole::time:
        case CsvRole::value:
          if (take_number(field.text, f, field.column, value)) {
            store(slot, value);
            break;
          }
          problems_.add(bad_cell(here(field.column), name_of(f), field.text, dialect_, layout_.spellings[f]));
          good = false;
      }
    }
    return good;
  }

  /// Whether a row ends where the channels do that have the most samples; what is not there is missing then.
  bool ends_before_a_clock() {
    const std::vector<std::size_t>& clocks = layout_.clocks.fields;
    if (std::find(clocks.begin(), clocks.end(), fields_.size()) == clocks.end()) return false;
    for (std::size_t f = fields_.size(); f < layout_.slots.size(); ++f)
      if (const CsvSlot& slot = layout_.slots[f]; slot.role == CsvRole::value || slot.role == CsvRole::date_time)
        cells_.values[slot.index] = missing_value;
    return true;
  }

  Error ragged() const {
    const std::size_t found = fields_.size(), names = layout_.columns.size(), wanted = layout_.slots.size();
    const char separator = dialect_.separator;
    const std::string count = std::string(all_rows_ragged_ ? "in every row " : "") + std::to_string(found) +
                              (found == 1 ? " field" : " fields") + " under " + std::to_string(wanted) +
                              (wanted == 1 ? " name" : " names");
    if (found < wanted)
      return problem(here(),
                     {count, ": ",
                      (found < names ? name_of(found) : "the last, without name,") +
                          (found + 1 < wanted ? " and what follows are" : " is"),
                      " not there"},
                     {"a field for each name"}, {"complete the row, or delete it"});
    if (found == wanted + 1 && fields_.back().text.empty())
      return problem(here(fields_.back().column), {count, ": the row ends in a ", separator_name(separator)},
                     {"a field for each name"},
                     {"end the first line in a ", separator_name(separator), " too, or no row"});
    return problem(
        here(fields_[wanted].column), {count, ": ", shown(fields_[wanted].text), " is too many"},
        {"a field for each name"},
        {separator == ',' ? "if the comma is the decimal mark too, save with semicolons; put text with commas in quotes"
                          : "delete the surplus, or name the column"});
  }

  bool is_marked(std::string_view text) const {
    return std::find(dialect_.missing_marks.begin(), dialect_.missing_marks.end(), text) !=
           dialect_.missing_marks.end();
  }

  bool take_number(std::string_view text, std::size_t field, std::size_t column, double& value) {
    const bool marked = !dialect_.missing_marks.empty() && is_marked(text);
    if (const auto number = marked ? std::nullopt : parse_field(text, dialect_.decimal_mark)) {
      value = *number;
      return true;
    }
    if (!is_missing(text) && !is_marked(text)) {
      const auto number = parse_spelled(text, dialect_.decimal_mark, dialect_.thousands, layout_.spellings[field]);
      if (number) value = *number;
      if (number || !trim_hidden(text).empty()) return number.has_value();
    }
    value = missing_value;
    cells_.missing.push_back({field, column});
    return true;
  }

  bool take_date_time(std::string_view text, std::size_t field, std::size_t column) {
    const auto parsed = layout_.clock.iso ? parse_date_time(text) : dated(text);
    if (parsed) {
      if (layout_.slots[field].role == CsvRole::date) {
        cells_.date_s = parsed->seconds;
        return true;
      }
      if (zone_known_ && parsed->has_zone != has_zone_) return false;
      zone_known_ = true;
      has_zone_ = parsed->has_zone;
      cells_.date_time = *parsed;
      if (several_clocks()) clock_value(field) = static_cast<double>(parsed->seconds) + parsed->fraction;
      return true;
    }
    if (!is_missing(trim_hidden(text)) && !is_marked(text)) return false;
    if (several_clocks()) clock_value(field) = missing_value;
    cells_.missing.push_back({field, column});
    return true;
  }

  bool several_clocks() const { return !layout_.clocks.fields.empty(); }
  double& clock_value(std::size_t field) { return cells_.values[layout_.slots[field].index]; }

  /// A stamp as the layout reads it. While the order of day and month is open only one date may be met: differences
  /// are then the same in both.
  std::optional<DateTime> dated(std::string_view text) {
    const auto stamp = parse_stamp(text);
    if (!stamp) return std::nullopt;
    DateOrder order = layout_.clock.order;
    if (stamp->has_date && order == DateOrder::unknown && !stamp->year_first && !stamp->order_is_plain) {
      if (seen_date_.year < 0) seen_date_ = {stamp->year, stamp->first, stamp->second};
      if (seen_date_.year != stamp->year || seen_date_.first != stamp->first || seen_date_.second != stamp->second)
        return std::nullopt;
      order = stamp->first > 12 ? DateOrder::day_first : DateOrder::month_first;
    }
    return instant(*stamp, order);
  }

  Error bad_stamp(const CsvField& field, std::size_t f) const {
    const std::string place = here(field.column);
    const auto stamp = parse_stamp(field.text);
    if (stamp && stamp->has_date && layout_.clock.order == DateOrder::unknown && !stamp->year_first &&
        !stamp->order_is_plain && stamp->first <= 12 && stamp->second <= 12)
      return problem(place, {name_of(f), " is ", shown(field.text), ", day or month first: nothing in the file tells"},
                     {"CsvOptions::time_format = day-first or CsvOptions::time_format = month-first"}, {"say which"});
    return problem(place, {name_of(f), " is ", shown(field.text)},
                   {"dates and times written as in the rows before, such as 2024-05-31 08:00:00, 31.05.2024 08:00:00, "
                    "5/31/2024 8:00:00 PM"});
  }

  void store(const CsvSlot& slot, double value) {
    if (slot.convert) value = slot.unit.to_canonical(value);
    (slot.role == CsvRole::time ? cells_.time_s : cells_.values[slot.index]) = value;
  }

  const CsvLayout& layout_;
  const CsvDialect& dialect_;
  const CellPlaces& places_;
  const std::string& path_;
  Problems& problems_;
  RowCells cells_;
  std::size_t line_number_ = 0;
  std::string names_;  ///< the line of names
  bool no_row_ = false;
  std::string batch_text_;
  std::vector<CsvField> fields_;
  struct {
    int year = -1, first = 0, second = 0;
  } seen_date_;  ///< while the order of day and month is open
  bool zone_known_ = false, has_zone_ = false, all_rows_ragged_ = false;
};

}  // namespace thermfit::detail
