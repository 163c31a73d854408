#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "thermfit/error.hpp"
#include "thermfit/io/csv/evidence.hpp"
#include "thermfit/io/csv/spelled.hpp"

namespace thermfit::detail {

/// What numbers have between their digits.
struct NumberMarks {
  char decimal = '.';  ///< `.` or `,`
  char thousands = 0;  ///< `.` `,` a blank (any) or `'`; 0: thousands are not grouped
};

inline const char* group_name(char mark) {
  return mark == '.' ? "points" : mark == ',' ? "commas" : mark == ' ' ? "blanks" : "apostrophes";
}

/// Where a mark was met in numbers.
struct MarkSeen {
  std::size_t count = 0,    ///< as decimal mark
      may_group = 0,        ///< of these, those that may be a grouped whole number: 1,234
      groups = 0;           ///< as what can only group thousands: 1,234,567 and 1,234.5
  std::string place, text;  ///< of the first as decimal mark
};

/// Counts the marks of a cell, whose place `place` tells; sets `thousands` where blanks or apostrophes group them.
template <typename Place>
void look_at_marks(std::string_view cell, const Place& place, MarkSeen& points, MarkSeen& commas, char& thousands) {
  const auto count = [&](MarkSeen& seen, bool may_group) {
    if (seen.count++ == 0) seen.place = place(), seen.text = shown(cell);
    seen.may_group += may_group;
  };
  if (cell.find(',') == std::string_view::npos && parse_field(cell, '.')) {  // most cells are plain
    if (cell.find('.') != std::string_view::npos) count(points, ungrouped(cell, '.', ',').has_value());
    return;
  }
  std::string_view number = trim_hidden(cell);
  if (const auto parts = split_unit_in_cell(number)) number = parts->first;
  for (const char mark : {'.', ','}) {
    MarkSeen& seen = mark == '.' ? points : commas;
    const char other = mark == '.' ? ',' : '.';
    if (number.find(mark) == std::string_view::npos) continue;
    std::size_t groups = 0;
    const bool grouped = ungrouped(number, mark, other, &groups).has_value();
    if (grouped && (groups > 1 || number.find(other) != std::string_view::npos)) ++seen.groups;
    if (parse_grouped(number, mark, ' ') || parse_grouped(number, mark, '\'')) count(seen, grouped);
  }
  for (const char mark : {'.', ','})
    for (const char group : {' ', '\''})
      if (thousands == 0 && ungrouped(number, group, mark)) thousands = group;
}

/// The marks that the cells use, where `told` leaves them open (0). Throws when they use both as decimal mark, or when
/// a mark may be either.
inline NumberMarks detect_marks(const CsvEvidence& evidence, char separator, bool has_header, NumberMarks told,
                                const std::string& name) {
  MarkSeen points, commas;
  NumberMarks marks{told.decimal, told.thousands};
  std::vector<CsvField> fields;
  for (std::size_t i = has_header ? 1 : 0; i < evidence.lines.size(); ++i) {
    if (split_line(evidence.lines[i].text, separator, fields)) continue;
    for (const CsvField& field : fields) {
      const std::string_view& text = field.text;
      if (text.find_first_of("., '\xC2\xE2") == std::string_view::npos || text.size() > 40) continue;
      char thousands = marks.thousands;
      look_at_marks(
          text, [&] { return place(name, evidence.lines[i].number, field.column); }, points, commas, thousands);
      marks.thousands = thousands;
    }
  }
  if (told.thousands == '.' || told.thousands == ',') {
    marks.decimal = told.thousands == '.' ? ',' : '.';
    if (told.decimal == told.thousands)
      throw problem(name, {"CsvOptions::thousands and CsvOptions::decimal_mark are the same mark"}, {"two marks"});
    return marks;
  }
  // A mark that groups for sure does so everywhere, and the other one is the decimal mark.
  const auto grouping = [](const MarkSeen& seen) { return seen.groups > 0 && seen.count == seen.may_group; };
  for (const char mark : {'.', ','}) {
    const bool may = told.decimal != mark && told.thousands == 0;
    if (!may || !grouping(mark == '.' ? points : commas) || (mark == '.' ? commas : points).groups > 0) continue;
    return {mark == '.' ? ',' : '.', mark};
  }
  if (told.decimal) return marks;
  marks.decimal = '.';
  if (commas.count == 0) return marks;
  const auto group_advice = [](const MarkSeen& seen, const char* word) {
    return seen.may_group == seen.count
               ? std::string(", or CsvOptions::thousands = ") + word + " if " + seen.text + " is a whole number"
               : std::string();
  };
  if (points.count > 0)
    throw problem(commas.place, {commas.text, " has a comma, and ", points.text, " (", points.place, ") has a point"},
                  {"one decimal mark in a file"},
                  {"say CsvOptions::decimal_mark = comma or CsvOptions::decimal_mark = point",
                   group_advice(points, "point"), group_advice(commas, "comma")});
  if (separator == ',')
    throw problem(commas.place,
                  {commas.text, " in a comma-separated file may be a decimal number or grouped thousands"}, {},
                  {"say CsvOptions::decimal_mark = comma if it is a decimal number", group_advice(commas, "comma")});
  if (separator == '\t' && commas.may_group == commas.count)
    throw problem(commas.place, {commas.text, " may be a decimal number or grouped thousands, as all its like here"},
                  {},
                  {"say CsvOptions::decimal_mark = comma if it is a decimal number", group_advice(commas, "comma")});
  marks.decimal = ',';
  return marks;
}

}  // namespace thermfit::detail
