#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/io/csv/roles.hpp"
#include "thermfit/io/nearest.hpp"

namespace thermfit::detail {

/// A layout while its columns get their roles: each one only, with the unit that the options or the file say.
class LayoutDraft {
 protected:
  LayoutDraft(const CsvHeader& header, std::vector<ColumnContent> contents, const CsvOptions& options, std::string name)
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

  const CsvHeader& header_;
  std::vector<ColumnContent> contents_;
  const CsvOptions& options_;
  std::string name_;
  CsvLayout layout_;
  std::vector<bool> unit_used_;     ///< of options.units
  std::vector<std::string> taken_;  ///< role of each column, empty when it has none yet
  std::size_t values_ = 0;
};

}  // namespace thermfit::detail
