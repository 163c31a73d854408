#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "thermfit/io/csv/field.hpp"
#include "thermfit/io/csv/spelled.hpp"
#include "thermfit/io/units.hpp"

namespace thermfit {

/// A column as the header names it.
struct CsvColumn {
  std::string name;            ///< without its unit
  std::string title;           ///< as written
  std::string unit;            ///< as written behind the name or in the unit row; empty when not told
  std::size_t position = 0;    ///< of the title in its line, from 1
  std::size_t same_as = 0;     ///< the number, from 1, of the first column that the file calls the same; 0: none before
  bool nameless = false;       ///< its name is made up, as the file gives none
  bool unit_in_words = false;  ///< the unit stands behind the name without brackets: Z_mm, Z / mm, Z in mm

  /// Whether `text` is its name or its title, spelled exactly. Does not allocate.
  bool is_called(const std::string& text) const { return text == name || text == title; }
};

namespace detail {

/// Whether a word is a unit of temperature or length and nothing else: not C, F, m or in, which names end in too.
inline bool is_sure_unit(std::string_view word) {
  const auto unit = unit_named(word);
  const std::string plain = plain_unit(word);
  return unit && unit->quantity != Quantity::time && plain.size() > 1 && plain != "in" && plain != "of" &&
         plain != "oc";
}

/// Name and unit of a title without brackets: `Z_mm`, `T1 degC`, `T1/°C`, `Z / mm`, `Z, mm`, `Z in mm`, and what R
/// makes of `Z (mm)`. Nothing when there is no unit, as in `T_in`, `feed mm/min`.
inline std::optional<std::pair<std::string_view, std::string_view>> split_unit_in_words(std::string_view title) {
  const auto parts = [&](std::size_t end, std::size_t begin) {
    return std::pair(trim_hidden(title.substr(0, end)), trim_hidden(title.substr(begin)));
  };
  if (const std::size_t slash = title.rfind('/'); slash != std::string_view::npos && slash > 0) {
    const auto [name, unit] = parts(slash, slash + 1);
    const std::size_t last_word = name.find_last_of(" _[(");
    const bool is_rate = unit_named(name.substr(last_word == std::string_view::npos ? 0 : last_word + 1)) &&
                         last_word != std::string_view::npos;
    if (find_unit(unit) && !name.empty() && !is_rate) return parts(slash, slash + 1);
  }
  if (const std::size_t in = title.rfind(" in ");
      in != std::string_view::npos && in > 0 && find_unit(parts(in, in + 4).second))
    return parts(in, in + 4);
  if (const std::size_t comma = title.rfind(','); comma != std::string_view::npos && comma > 0) {
    const std::string_view unit = parts(comma, comma + 1).second;
    const auto known = find_unit(unit);
    if (known && (known->quantity == Quantity::time || is_sure_unit(unit))) return parts(comma, comma + 1);
  }
  if (title.size() > 4 && title.back() == '.')
    if (const std::size_t dots = title.find(".."); dots != std::string_view::npos && dots > 0) {
      const std::string_view unit = title.substr(dots + 2, title.size() - dots - 3);
      if (unit_named(unit)) return std::pair(title.substr(0, dots), unit);
    }
  for (std::size_t at = title.find_first_of("_ ", 1); at != std::string_view::npos;
       at = title.find_first_of("_ ", at + 1))
    if (is_sure_unit(parts(at, at + 1).second)) return parts(at, at + 1);
  return std::nullopt;
}

/// `T1 [degC]` is column T1 in degC. Square brackets always hold a unit; round ones only one that is known.
inline CsvColumn column_of(const CsvField& field) {
  CsvColumn column;
  column.title = std::string(trim_hidden(field.name()));
  column.name = column.title;
  column.position = field.column;
  const std::string_view title = column.title;
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const std::size_t begin = title.rfind(open);
    if (begin == std::string_view::npos || begin == 0 || title.back() != close) continue;
    const std::string_view unit = trim_hidden(title.substr(begin + 1, title.size() - begin - 2));
    if (open == '(' && !find_unit(unit)) continue;
    column.unit = unit;
    column.name = trim_hidden(title.substr(0, begin));
    return column;
  }
  if (const auto parts = split_unit_in_words(title)) {
    column.name = parts->first;
    column.unit = parts->second;
    column.unit_in_words = true;
  }
  return column;
}

/// A title whose name without the unit is another column's too keeps its unit in its name.
inline void keep_names_apart(std::vector<CsvColumn>& columns) {
  std::map<std::string, std::size_t> uses;
  for (const CsvColumn& column : columns) {
    ++uses[column.name];
    if (column.title != column.name) ++uses[column.title];
  }
  for (CsvColumn& column : columns)
    if (column.unit_in_words && uses[column.name] > 1) column.name = column.title;
}

/// A name as a message shows it: in quotes, with escapes, where something in it cannot be seen.
inline std::string visible_name(const std::string& name) {
  const bool hidden =
      std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }) ||
      std::any_of(std::begin(hidden_blanks), std::end(hidden_blanks),
                  [&](std::string_view blank) { return name.find(blank) != std::string::npos; });
  if (!hidden) return name;
  std::string text;
  for (std::size_t i = 0; i < name.size();) {
    const std::size_t blank = blank_in_front(std::string_view(name).substr(i));
    const std::size_t size = std::max<std::size_t>(1, name[i] == ' ' ? 0 : blank);
    if (size == 1 && static_cast<unsigned char>(name[i]) >= 32) {
      text += name[i];
    } else {
      for (std::size_t k = 0; k < size; ++k) {
        const auto byte = static_cast<unsigned char>(name[i + k]);
        text += "\\x";
        text += "0123456789abcdef"[byte >> 4];
        text += "0123456789abcdef"[byte & 15];
      }
    }
    i += size;
  }
  return '\'' + text + '\'';
}

}  // namespace detail
}  // namespace thermfit
