#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/io/csv/clock_layout.hpp"
#include "thermfit/io/csv/named_dialect.hpp"

namespace thermfit::detail {

/// Gives each column its role.
class LayoutMaker : private ClockLayout {
 public:
  LayoutMaker(const CsvHeader& header, std::vector<ColumnContent> contents, const CsvOptions& options, std::string name)
      : ClockLayout(header, std::move(contents), options, std::move(name)) {}

  CsvLayout make() {
    skip_columns();
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
    place_clocks();
    for (std::size_t c = 0; c < taken_.size(); ++c) {
      if (taken_[c].empty())
        (column(c).nameless && contents_[c].numbers ? layout_.roles.nameless : layout_.roles.ignored)
            .push_back(column(c).title);
      if (taken_[c].empty() && contents_[c].may_be_grouped) layout_.roles.may_be_grouped.push_back(column(c).title);
      note_spelling(c);
      if (taken_[c] == "an input") note_nearly(c);
    }
    require_units_used();
    return std::move(layout_);
  }

 private:
  void skip_columns() {
    for (const std::string& pattern : options_.skip_columns) {
      bool any = false;
      for (std::size_t c = 0; c < header_.columns.size(); ++c) {
        if (!column(c).is_called(pattern) && !matches_glob(pattern, column(c).name)) continue;
        any = true;
        if (taken_[c].empty()) layout_.roles.skipped.push_back(take(c, "left out"));
      }
      const bool by_dialect = std::any_of(named_dialects.begin(), named_dialects.end(), [&](const NamedDialect& one) {
        return one.name == options_.dialect && one.skip_columns.find(pattern) != std::string_view::npos;
      });
      if (!any && !by_dialect) find(pattern, "CsvOptions::skip_columns");
    }
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
      if (taken_[c].empty() && contents_[c].numbers && (options_.plain || !column(c).nameless)) {
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
};

}  // namespace thermfit::detail
