#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "thermfit/io/csv/field.hpp"
#include "thermfit/io/units.hpp"

namespace thermfit::detail {

/// How the cells of one column spell numbers beyond digits and marks.
struct CellSpelling {
  std::string unit;     ///< stands behind each number, as written
  std::string on, off;  ///< words for 1 and 0 in lower case
};

/// Without blanks around it, hidden ones too.
inline std::string_view trim_hidden(std::string_view text) {
  while (const std::size_t blank = blank_in_front(text)) text.remove_prefix(blank);
  for (bool again = true; again;) {
    again = false;
    for (std::size_t size = std::min<std::size_t>(3, text.size()); size > 0 && !again; --size)
      if (blank_in_front(text.substr(text.size() - size)) == size) text.remove_suffix(size), again = true;
  }
  return text;
}

/// The bytes at the front of `text` that group thousands: `.` or `,` as said, any blank for a blank, any apostrophe for
/// an apostrophe; 0 where another text begins.
inline std::size_t group_mark(std::string_view text, char group) {
  if (text.empty()) return 0;
  if (group == ' ') return text.front() == '\t' || text.front() == '\r' ? 0 : blank_in_front(text);
  if (text.front() == group) return 1;
  return group == '\'' && starts_with(text, "\xE2\x80\x99") ? 3 : 0;
}

/// A number whose thousands are grouped, without the marks: one to three digits, the first no 0, then groups of three,
/// then what `decimal_mark` begins or nothing. `groups` tells how many marks there were. Nothing for any other text.
inline std::optional<std::string> ungrouped(std::string_view text, char group, char decimal_mark,
                                            std::size_t* groups = nullptr) {
  if (text.size() < 5 || text.size() > 60) return std::nullopt;
  if (group == '.' || group == ',') {  // most often the first mark is not followed by three digits
    const std::size_t mark = text.find(group);
    if (mark == std::string_view::npos || mark + 4 > text.size()) return std::nullopt;
  }
  std::string number;
  if (starts_with(text, "\xE2\x88\x92"))
    number = "-", text.remove_prefix(3);
  else if (text.front() == '-' || text.front() == '+')
    number = text.front(), text.remove_prefix(1);
  const auto digits = [&](std::size_t most) {
    std::size_t count = 0;
    for (; count < most && count < text.size() && text[count] >= '0' && text[count] <= '9'; ++count)
      number += text[count];
    text.remove_prefix(count);
    return count;
  };
  if (text.empty() || text.front() == '0' || digits(3) == 0) return std::nullopt;
  std::size_t marks = 0;
  while (const std::size_t mark = group_mark(text, group)) {
    text.remove_prefix(mark);
    if (digits(3) != 3) return std::nullopt;
    ++marks;
  }
  if (groups) *groups = marks;
  const bool ends = text.empty() || text.front() == decimal_mark || text.front() == 'e' || text.front() == 'E';
  if (marks == 0 || !ends) return std::nullopt;
  return number += text;
}

/// A number with its thousands grouped by `group` or plain; `group` 0: not grouped. Blanks around it may be hidden.
inline std::optional<double> parse_grouped(std::string_view text, char mark, char group) {
  text = trim_hidden(text);
  if (const auto number = parse_field(text, mark)) return number;
  if (group == 0) return std::nullopt;
  const auto digits = ungrouped(text, group, mark);
  return digits ? parse_field(*digits, mark) : std::nullopt;
}

/// A number and the word behind it: `23.4 °C`, `20C`, `1200 1/min`. Without a blank between them the word must be a
/// unit or a percent sign. Nothing for any other text.
inline std::optional<std::pair<std::string_view, std::string_view>> split_unit_in_cell(std::string_view text) {
  const auto parts = [&](std::size_t at) {
    return std::pair(trim_hidden(text.substr(0, at)), trim_hidden(text.substr(at)));
  };
  text = trim_hidden(text);
  const std::size_t digit = text.find_last_of("0123456789");
  const std::size_t digits_begin = text.find_first_of("0123456789");
  if (digit == std::string_view::npos || digits_begin > 3 || text.size() > 40) return std::nullopt;
  const auto is_number_part = [](std::string_view part) {
    for (const char mark : {'.', ','})
      for (const char group : {'\0', '.', ',', ' ', '\''})
        if (group != mark && parse_grouped(part, mark, group)) return true;
    return false;
  };
  const auto is_word = [](std::string_view word) {
    return !word.empty() && word.size() <= 12 && word.find_first_of(" \t,;.:|\"+-") == std::string_view::npos;
  };
  if (const auto [number, word] = parts(digit + 1); is_word(word) && is_number_part(number)) {
    const bool apart = number.data() + number.size() != word.data();
    if (apart || word == "%" || unit_named(word)) return std::pair(number, word);
  }
  const std::size_t blank = text.find_last_of(' ');
  if (blank == std::string_view::npos || blank + 1 > digit) return std::nullopt;
  const auto [number, word] = parts(blank);
  if (!is_word(word) || !is_number_part(number) || word.find_first_of("/") == std::string_view::npos)
    return std::nullopt;
  return std::pair(number, word);
}

/// A cell as its column spells numbers; nothing for any other text.
inline std::optional<double> parse_spelled(std::string_view text, char mark, char group, const CellSpelling& spelling) {
  if (const auto number = parse_grouped(text, mark, group)) return number;
  if (!spelling.on.empty() && text.size() <= 10) {
    std::string word(trim_hidden(text));
    for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (word == spelling.on) return 1;
    if (word == spelling.off) return 0;
  }
  if (spelling.unit.empty()) return std::nullopt;
  const auto parts = split_unit_in_cell(text);
  return parts && parts->second == spelling.unit ? parse_grouped(parts->first, mark, group) : std::nullopt;
}

/// The words for 1 and 0 that `text` is one of, in any case; nothing for another text.
inline const std::pair<std::string_view, std::string_view>* state_words(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> pairs{
      {{"on", "off"}, {"true", "false"}, {"yes", "no"}, {"ein", "aus"}, {"ja", "nein"}, {"wahr", "falsch"}}};
  text = trim_hidden(text);
  const auto is = [&](std::string_view word) {
    return text.size() == word.size() && std::equal(text.begin(), text.end(), word.begin(), [](char a, char b) {
             return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
           });
  };
  for (const auto& pair : pairs)
    if (is(pair.first) || is(pair.second)) return &pair;
  return nullptr;
}

/// Whether a field is a number in any spelling: grouped, or with a word behind it.
inline bool is_spelled_number(std::string_view text) {
  if (is_number(text)) return true;
  if (text.empty() || text.size() > 40) return false;
  for (const char mark : {'.', ','})
    for (const char group : {'.', ',', ' ', '\''})
      if (group != mark && parse_grouped(text, mark, group)) return true;
  return split_unit_in_cell(text).has_value();
}

}  // namespace thermfit::detail
