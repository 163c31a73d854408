#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/content.hpp"
#include "thermfit/io/nearest.hpp"

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
};

struct CsvLayout {
  CsvRoles roles;
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

/// Gives each column its role.
class LayoutMaker {
 public:
  LayoutMaker(const CsvHeader& header, std::vector<ColumnContent> contents, const CsvOptions& options, std::string name)
      : header_(header), contents_(std::move(contents)), options_(options), name_(std::move(name)) {
    layout_.columns = header.columns;
    layout_.roles.made_up = header.made_up;
    layout_.roles.replaced = header.replaced;
    for (const ColumnContent& content : contents_) layout_.spellings.push_back(content.spelling);
    layout_.slots.resize(header.columns.size() + header.empty_last_column);
    if (header.empty_last_column) layout_.slots.back().role = CsvRole::empty;
    taken_.resize(header.columns.size());
    unit_used_.resize(options.units.size());
  }

  CsvLayout make() {
    if (!options_.batch_column.empty()) {
      const std::size_t c = find(options_.batch_column, "CsvOptions::batch_column");
      layout_.slots[c].role = CsvRole::batch;
      layout_.roles.batch = take(c, "the batch column");
    }
    assign_time();
    // Errors come first, so that `temperatures = {"*"}` leaves them alone.
    const auto errors = options_.errors.empty() ? by_default(is_error_name, "a thermal error")
                                                : choose(wanted_errors(), "CsvOptions::errors", "a thermal error");
    const auto temperatures = options_.temperatures.empty()
                                  ? by_default(is_temperature_name, "a temperature")
                                  : choose(options_.temperatures, "CsvOptions::temperatures", "a temperature");
    add_values(temperatures, layout_.roles.temperatures, Quantity::temperature);
    add_values(errors, layout_.roles.errors, Quantity::length);
    add_values(options_.inputs ? choose(*options_.inputs, "CsvOptions::inputs", "an input") : remaining_numbers(),
               layout_.roles.inputs, std::nullopt);
    for (std::size_t c = 0; c < taken_.size(); ++c) {
      if (taken_[c].empty()) layout_.roles.ignored.push_back(column(c).title);
      if (taken_[c].empty() && contents_[c].may_be_grouped) layout_.roles.may_be_grouped.push_back(column(c).title);
      note_spelling(c);
      if (taken_[c] == "an input") note_nearly(c);
    }
    require_units_used();
    return std::move(layout_);
  }

 private:
  const CsvColumn& column(std::size_t c) const { return header_.columns[c]; }
  std::string place_of(std::size_t c) const {
    return header_.given ? "CsvOptions::columns" : place(name_, header_.line, column(c).position);
  }

  std::string take(std::size_t c, const std::string& as) {
    if (!taken_[c].empty() && taken_[c] != as)
      throw problem(place_of(c), {column(c).name, " is to be ", taken_[c], " and ", as}, {"one role for a column"});
    taken_[c] = as;
    return column(c).name;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const CsvColumn& one : header_.columns) all.push_back(visible_name(one.unit_in_words ? one.title : one.name));
    return all;
  }

  std::size_t find(const std::string& wanted, const std::string& option) const {
    for (std::size_t c = 0; c < header_.columns.size(); ++c)
      if (column(c).is_called(wanted)) return c;
    throw problem(name_, {"no column ", shown(wanted), " (", option, ")", did_you_mean(wanted, names())},
                  {name_list(names())});
  }

  /// Columns that the patterns of an option name, each once, in the order of the option.
  std::vector<std::size_t> choose(const std::vector<std::string>& patterns, const std::string& option,
                                  const std::string& role) {
    std::vector<std::size_t> chosen;
    const auto add = [&](std::size_t c, bool by_title) {
      if (std::find(chosen.begin(), chosen.end(), c) == chosen.end()) chosen.push_back(c);
      take(c, role);
      if (by_title && column(c).unit_in_words) layout_.columns[c].name = column(c).title;
    };
    for (const std::string& pattern : patterns) {
      const bool exact = std::any_of(header_.columns.begin(), header_.columns.end(),
                                     [&](const CsvColumn& one) { return one.is_called(pattern); });
      if (exact || pattern.find_first_of("*?") == std::string::npos) {
        const std::size_t c = find(pattern, option);
        add(c, pattern != column(c).name);
        continue;
      }
      bool any = false;
      for (std::size_t c = 0; c < header_.columns.size(); ++c) {
        const bool is_text = contents_[c].text && !contents_[c].numbers;
        const bool by_name = matches_glob(pattern, column(c).name),
                   by_title = column(c).unit_in_words && matches_glob(pattern, column(c).title);
        if ((!taken_[c].empty() && taken_[c] != role) || is_text || !(by_name || by_title)) continue;
        add(c, !by_name);
        any = true;
      }
      if (!any)
        throw problem(name_, {"no column of numbers is like ", shown(pattern), " (", option, ")"},
                      {name_list(names())});
    }
    return chosen;
  }

  std::vector<std::string> wanted_errors() const {
    if (!options_.errors_may_lack) return options_.errors;
    std::vector<std::string> there;
    for (const std::string& name : options_.errors)
      if (std::any_of(header_.columns.begin(), header_.columns.end(), [&](const auto& c) { return c.is_called(name); }))
        there.push_back(name);
    return there;
  }

  static bool is_temperature_name(const std::string& name) {
    return name.size() > 1 && name[0] == 'T' && name.find_first_not_of("0123456789", 1) == std::string::npos;
  }
  static bool is_error_name(const std::string& name) { return name == "X" || name == "Y" || name == "Z"; }

  bool is_named_by_option(std::size_t c) const {
    const auto among = [&](const std::vector<std::string>& wanted) {
      return std::any_of(wanted.begin(), wanted.end(), [&](const auto& one) { return column(c).is_called(one); });
    };
    return among(options_.temperatures) || among(options_.errors) || (options_.inputs && among(*options_.inputs));
  }

  std::vector<std::size_t> by_default(bool (*is_one)(const std::string&), const std::string& role) {
    std::vector<std::size_t> chosen;
    for (std::size_t c = 0; c < header_.columns.size(); ++c)
      if (!options_.plain && taken_[c].empty() && is_one(column(c).name) && !is_named_by_option(c)) {
        take(c, role);
        chosen.push_back(c);
      }
    return chosen;
  }

  std::vector<std::size_t> remaining_numbers() {
    std::vector<std::size_t> chosen;
    for (std::size_t c = 0; c < header_.columns.size(); ++c)
      if (taken_[c].empty() && contents_[c].numbers) {
        take(c, "an input");
        chosen.push_back(c);
      }
    return chosen;
  }

  void add_values(const std::vector<std::size_t>& chosen, std::vector<std::string>& role_names,
                  std::optional<Quantity> quantity) {
    for (const std::size_t c : chosen) {
      CsvSlot& slot = layout_.slots[c];
      slot.role = CsvRole::value;
      slot.index = values_++;
      // What nobody asked for is left as written, its name too.
      std::string& name = layout_.columns[c].name;
      if (!quantity && column(c).unit_in_words) name = column(c).title;
      if (quantity) set_unit(slot, c, *quantity, unit_of(c, *quantity));
      role_names.push_back(name);
    }
  }

  /// The unit of a column: what the options say, else what the file says.
  std::string unit_of(std::size_t c, Quantity quantity) {
    const std::string in_file = unit_in_file(c);
    for (std::size_t u = 0; u < options_.units.size(); ++u) {
      const auto& [pattern, text, otherwise] = options_.units[u];
      const auto said = find_unit(text);
      if (!said) throw problem("CsvOptions::units", {shown(text), " is no unit"}, {all_units()});
      if (!column(c).is_called(pattern) && (said->quantity != quantity || !(matches_glob(pattern, column(c).name) ||
                                                                            matches_glob(pattern, column(c).title))))
        continue;
      unit_used_[u] = true;
      if (otherwise && !in_file.empty()) return text.front() == '-' ? '-' + in_file : in_file;
      const auto written = find_unit(in_file);
      if (!in_file.empty() && !(written && written->is_same_as(*said)))
        layout_.roles.contradicted.push_back(layout_.columns[c].name + " in " + text + ", the file says " + in_file);
      return text;
    }
    return in_file;
  }

  /// What the file says: behind or below the name, or behind each number.
  std::string unit_in_file(std::size_t c) const {
    const std::string &with_name = column(c).unit, &with_numbers = contents_[c].spelling.unit;
    if (with_name.empty() || with_numbers.empty()) return with_name.empty() ? with_numbers : with_name;
    const auto one = find_unit(with_name), other = find_unit(with_numbers);
    if (with_name != with_numbers && !(one && other && one->is_same_as(*other)))
      throw problem(place_of(c), {column(c).name, " is in ", with_name, ", its cells in ", with_numbers},
                    {"one unit for a column"});
    return with_name;
  }

  static std::string all_units() {
    return std::string(unit_names(Quantity::temperature)) + "; " + std::string(unit_names(Quantity::length)) + "; " +
           std::string(unit_names(Quantity::time));
  }

  /// Throws when a unit was given for what is not there or has none.
  void require_units_used() const {
    for (std::size_t u = 0; u < options_.units.size(); ++u) {
      if (unit_used_[u] || options_.units[u].otherwise) continue;
      const std::string& pattern = options_.units[u].column;
      const auto called = [&](const CsvColumn& one) { return one.is_called(pattern); };
      if (std::any_of(header_.columns.begin(), header_.columns.end(), called))
        throw problem(name_, {shown(pattern), " (CsvOptions::units) is no temperature, no thermal error and no clock"},
                      {"units of those"},
                      {"an input is left as written; a role is given by CsvOptions::temperatures "
                       "or CsvOptions::errors"});
      if (options_.errors_may_lack) continue;
      throw problem(name_, {"no column ", shown(pattern), " (CsvOptions::units)", did_you_mean(pattern, names())},
                    {name_list(names())});
    }
  }

  /// Says what the cells of a column that is used say of their numbers.
  void note_spelling(std::size_t c) {
    const CellSpelling& spelling = contents_[c].spelling;
    const CsvRole role = layout_.slots[c].role;
    if (role != CsvRole::value && role != CsvRole::time) return;
    if (!spelling.unit.empty()) layout_.roles.spelled.push_back(layout_.columns[c].name + " in " + spelling.unit);
    if (!spelling.on.empty())
      layout_.roles.spelled.push_back(layout_.columns[c].name + " " + spelling.on + " as 1, " + spelling.off + " as 0");
  }

  /// Says of an input that its name is nearly that of a temperature or thermal error: but for case and blanks.
  void note_nearly(std::size_t c) {
    if (options_.plain || options_.inputs) return;
    const auto parts = split_unit_in_words(column(c).title);
    std::string bare;
    for (std::string_view rest = parts ? parts->first : std::string_view(column(c).name); !rest.empty();) {
      const std::size_t hidden = blank_in_front(rest);
      if (hidden == 0)
        bare += rest.front() >= 'a' && rest.front() <= 'z' ? static_cast<char>(rest.front() - 32) : rest.front();
      rest.remove_prefix(std::max<std::size_t>(1, hidden));
    }
    const std::string shown_name = visible_name(column(c).title);
    if (options_.temperatures.empty() && is_temperature_name(bare))
      layout_.roles.nearly.push_back(shown_name + " (nearly " + bare + ": CsvOptions::temperatures = NAMES)");
    else if (options_.errors.empty() && is_error_name(bare))
      layout_.roles.nearly.push_back(shown_name + " (nearly " + bare + ": CsvOptions::errors = NAMES)");
  }

  void set_unit(CsvSlot& slot, std::size_t c, Quantity quantity, const std::string& text) {
    if (text.empty()) return;
    const auto unit = find_unit(text);
    if (!unit || unit->quantity != quantity)
      throw problem(place_of(c), {column(c).name, " is in ", shown(text), (unit ? ", a unit of another quantity" : "")},
                    {std::string(unit_names(quantity))},
                    {"write one of these behind the name, or say CsvOptions::units = ", column(c).name, "=",
                     quantity == Quantity::temperature ? "degC"
                     : quantity == Quantity::length    ? "um"
                                                       : "s"});
    slot.unit = *unit;
    slot.convert = !unit->is_canonical();
    if (slot.convert && quantity != Quantity::time)
      layout_.roles.converted.push_back(layout_.columns[c].name + " from " + text);
  }

  void assign_time() {
    if (options_.time_column == "none") return;
    const std::vector<std::size_t> found =
        options_.time_column.empty() ? clocks()
                                     : std::vector<std::size_t>{find(options_.time_column, "CsvOptions::time_column")};
    if (found.size() > 1)
      throw problem(place_of(found[1]), {column(found[1]).name, " may be the time, and so may ", column(found[0]).name},
                    {"one clock"}, {"say CsvOptions::time_column = ", column(found[0]).name});
    if (found.empty()) return;
    const std::size_t c = found.front();
    layout_.roles.time = take(c, "the time");
    if (contents_[c].stamps && !contents_[c].numbers)
      read_stamps(c);
    else
      read_numbers(c);
  }

  /// Columns that may be the clock: by name; else by what they hold; else by a name that needs a unit to be sure.
  std::vector<std::size_t> clocks() const {
    std::vector<std::size_t> named, full, times, weak;
    for (std::size_t c = 0; c < header_.columns.size(); ++c) {
      if (!taken_[c].empty()) continue;
      const ColumnContent& content = contents_[c];
      const auto unit = find_unit(column(c).unit);
      if (!time_unit_in(column(c).name).empty())
        named.push_back(c);
      else if (content.stamps && !content.numbers)
        (content.has_date && content.has_time ? full : content.has_time ? times : weak).push_back(c);
      else if (content.numbers && may_be_clock(column(c).name) &&
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
    if (clock.iso) return;
    std::string how = !clock.dated   ? "a time of day or elapsed time"
                      : with.empty() ? "dates and times"
                                     : "times, with the dates of " + with;
    if (order.open)
      how += clock.order == DateOrder::day_first     ? ", day before month"
             : clock.order == DateOrder::month_first ? ", month before day"
                                                     : ", all of one date";
    else if (clock.dated)
      how += order.plain ? ", day before month" : ", year before month";
    layout_.roles.clock = layout_.roles.time + " is read as " + how;
  }

  /// How many of a count of years beyond 1973 make a second, if it can be nothing else: 1, 1e3, 1e6; 0 where it can.
  static double unix_scale(double first) {
    return first >= 1e8 && first < 1e11    ? 1
           : first >= 1e11 && first < 1e14 ? 1e3
           : first >= 1e14 && first < 1e17 ? 1e6
                                           : 0;
  }

  void read_numbers(std::size_t c) {
    CsvSlot& slot = layout_.slots[c];
    slot.role = CsvRole::time;
    const ColumnContent& content = contents_[c];
    const std::string by_name = time_unit_in(column(c).name);
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
    else if (format == TimeFormat::serial_days || (open && spreadsheet))
      since("d", "days, as spreadsheets count them");
    layout_.roles.assumed_minutes = unit.empty();
    if (unit.empty()) unit = "min";
    set_unit(slot, c, Quantity::time, unit);
  }

  const CsvHeader& header_;
  std::vector<ColumnContent> contents_;
  const CsvOptions& options_;
  std::string name_;
  CsvLayout layout_;
  std::vector<bool> unit_used_;     ///< of options.units
  std::vector<std::string> taken_;  ///< role of each column, empty when it has none yet
  std::size_t values_ = 0;
};

}  // namespace detail
}  // namespace thermfit
