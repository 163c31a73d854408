#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "thermfit/io/csv/date_time.hpp"
#include "thermfit/io/csv/field.hpp"
#include "thermfit/io/units.hpp"

namespace thermfit {

/// Which of day and month comes first where the year does not.
enum class DateOrder { unknown, day_first, month_first };

namespace detail {

/// A date, a time of day, or both, as loggers write them: the parts as they stand.
struct Stamp {
  bool has_date = false, has_time = false;
  bool has_zone = false;        ///< Z or an offset
  bool year_first = false;      ///< 2026/05/04; else two numbers whose order may be open
  bool order_is_plain = false;  ///< a month by name, or full stops, which nobody puts behind a month that comes first
  bool month_by_name = false;
  int year = 0, first = 0, second = 0;  ///< year, and the two others as written; month and day where the year is first
  std::int64_t seconds = 0;             ///< since midnight, zone applied
  double fraction = 0;                  ///< of a second
};

/// Takes one to `most` digits; -1 when there is none.
inline int take_number(std::string_view& text, std::size_t most, std::size_t* count = nullptr) {
  std::size_t digits = 0;
  int value = 0;
  while (digits < most && digits < text.size() && text[digits] >= '0' && text[digits] <= '9')
    value = 10 * value + (text[digits++] - '0');
  text.remove_prefix(digits);
  if (count) *count = digits;
  return digits == 0 ? -1 : value;
}

/// Takes an English or German month of at least three letters; 0 when there is none.
inline int take_month(std::string_view& text) {
  constexpr std::string_view months[][2] = {{"jan", "jan"}, {"feb", "feb"}, {"mar", "mär"}, {"apr", "apr"},
                                            {"may", "mai"}, {"jun", "jun"}, {"jul", "jul"}, {"aug", "aug"},
                                            {"sep", "sep"}, {"oct", "okt"}, {"nov", "nov"}, {"dec", "dez"}};
  const auto begins = [&](std::string_view word) {
    for (std::size_t i = 0; i < word.size(); ++i) {
      if (i >= text.size()) return false;
      const char c = text[i];
      if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != word[i]) return false;
    }
    return true;
  };
  for (int month = 0; month < 12; ++month)
    for (const std::string_view name : months[month])
      if (begins(name)) {
        text.remove_prefix(name.size());
        while (!text.empty() && ((text.front() | 32) >= 'a' && (text.front() | 32) <= 'z')) text.remove_prefix(1);
        take(text, '.');
        return month + 1;
      }
  return 0;
}

inline bool take_date(std::string_view& text, Stamp& stamp) {
  std::string_view rest = text;
  std::size_t digits = 0;
  const int one = take_number(rest, 4, &digits);
  if (one < 0 || rest.empty()) return false;
  const char mark = rest.front();
  if (mark != '-' && mark != '/' && mark != '.' && mark != ' ') return false;
  rest.remove_prefix(1);
  if (mark == '.') take(rest, ' ');
  if (digits == 4) {
    stamp.year_first = true;
    stamp.year = one;
    stamp.first = take_number(rest, 2);
    if (stamp.first < 0 || !take(rest, mark)) return false;
    stamp.second = take_number(rest, 2);
    if (stamp.second < 0) return false;
  } else {
    stamp.first = one;
    stamp.second = take_month(rest);
    stamp.month_by_name = stamp.second > 0;
    if (!stamp.month_by_name) stamp.second = take_number(rest, 2);
    if (stamp.second < 0 || (!take(rest, mark) && !(stamp.month_by_name && take(rest, ' ')))) return false;
    stamp.year = take_number(rest, 4, &digits);
    if (digits == 2)
      stamp.year += 2000;
    else if (digits != 4)
      return false;
    stamp.order_is_plain = stamp.month_by_name || mark == '.';
  }
  stamp.has_date = true;
  text = rest;
  return true;
}

inline bool take_time(std::string_view& text, Stamp& stamp) {
  std::string_view rest = text;
  const int hour = take_number(rest, 5);
  if (hour < 0 || !take(rest, ':')) return false;
  const int minute = take_digits(rest, 2);
  if (minute < 0 || minute > 59) return false;
  int second = 0;
  if (take(rest, ':')) {
    second = take_digits(rest, 2);
    if (second < 0 || second > 59) return false;
    if (!rest.empty() && (rest.front() == '.' || rest.front() == ',' || rest.front() == ':')) {
      rest.remove_prefix(1);
      std::int64_t value = 0, scale = 1;
      std::size_t count = 0;
      for (; count < rest.size() && rest[count] >= '0' && rest[count] <= '9'; ++count)
        if (scale < 1'000'000'000'000'000) value = 10 * value + (rest[count] - '0'), scale *= 10;
      if (count == 0) return false;
      rest.remove_prefix(count);
      stamp.fraction = static_cast<double>(value) / static_cast<double>(scale);
    }
  }
  std::string_view half = rest;
  take(half, ' ');
  int shift = 0;
  if (half.size() >= 2 && (half[1] == 'M' || half[1] == 'm') && ((half[0] | 32) == 'a' || (half[0] | 32) == 'p')) {
    if (hour < 1 || hour > 12) return false;
    shift = ((half[0] | 32) == 'p' ? 12 : 0) - (hour == 12 ? 12 : 0);
    rest = half.substr(2);
  }
  std::int64_t offset_s = 0;
  if (take(rest, 'Z')) {
    stamp.has_zone = true;
  } else if (!rest.empty() && (rest.front() == '+' || rest.front() == '-')) {
    const int sign = rest.front() == '-' ? -1 : 1;
    rest.remove_prefix(1);
    const int hours = take_digits(rest, 2);
    take(rest, ':');
    const int minutes = rest.empty() ? 0 : take_digits(rest, 2);
    if (hours < 0 || hours > 23 || minutes < 0 || minutes > 59) return false;
    offset_s = sign * (3600 * hours + 60 * minutes);
    stamp.has_zone = true;
  }
  if (stamp.has_date && hour > 23) return false;
  stamp.seconds = std::int64_t{3600} * (hour + shift) + 60 * minute + second - offset_s;
  stamp.has_time = true;
  text = rest;
  return true;
}

/// `4.5.2026 8:00:05`, `2026/05/04-08:00:05`, `5/4/2026 8:00:05 PM`, `04-May-2026`, `26:00:05`; a date, a time of day
/// or an elapsed time, or both, and nothing behind. Nothing for any other text.
inline std::optional<Stamp> parse_stamp(std::string_view text) {
  Stamp stamp;
  char plain[64];
  if (text.size() <= sizeof plain && text.find_first_of("\xC2\xE2\xE3") != std::string_view::npos) {
    std::size_t size = 0;  // some programs put a hidden blank before PM
    for (std::size_t blank; !text.empty(); text.remove_prefix(std::max<std::size_t>(1, blank)))
      plain[size++] = (blank = blank_in_front(text)) > 0 ? ' ' : text.front();
    text = trim({plain, size});
  }
  if (take_date(text, stamp)) {
    if (text.empty()) return stamp;
    if (!take(text, 'T')) {
      const bool marked = take(text, ',') || take(text, '-') || take(text, ';') || take(text, '_');
      bool blank = false;
      while (take(text, ' ')) blank = true;
      if (!marked && !blank) return std::nullopt;
    }
  }
  if (!take_time(text, stamp) || !text.empty()) return std::nullopt;
  return stamp;
}

/// Whether a field is what rows hold and names are not: a number or a stamp.
inline bool is_number_or_stamp(std::string_view text) { return is_number(text) || parse_stamp(text); }

/// The instant of a stamp: seconds since 1970 where it has a date, since midnight where it has none. Nothing for a date
/// that does not exist in that order.
inline std::optional<DateTime> instant(const Stamp& stamp, DateOrder order) {
  if (!stamp.has_date) return DateTime{stamp.seconds, stamp.fraction, stamp.has_zone};
  const bool day_first = !stamp.year_first && (stamp.order_is_plain || order != DateOrder::month_first);
  const int month = day_first ? stamp.second : stamp.first, day = day_first ? stamp.first : stamp.second;
  constexpr int lengths[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = (stamp.year % 4 == 0 && stamp.year % 100 != 0) || stamp.year % 400 == 0;
  if (month < 1 || month > 12 || day < 1 || day > lengths[month - 1] + (leap && month == 2)) return std::nullopt;
  return DateTime{days_from_civil(stamp.year, month, day) * 86400 + stamp.seconds, stamp.fraction, stamp.has_zone};
}

/// What many stamps of one column say about the order of day and month.
struct OrderEvidence {
  bool open = false;                       ///< some could be read both ways
  bool day_first = false;                  ///< a first number above 12
  bool month_first = false;                ///< a second number above 12
  bool year_first = false, plain = false;  ///< some need no evidence

  void look_at(const Stamp& stamp) {
    year_first = year_first || (stamp.has_date && stamp.year_first);
    plain = plain || stamp.order_is_plain;
    if (!stamp.has_date || stamp.year_first || stamp.order_is_plain) return;
    open = true;
    day_first = day_first || stamp.first > 12;
    month_first = month_first || stamp.second > 12;
  }
  DateOrder order() const {
    return day_first == month_first ? DateOrder::unknown : day_first ? DateOrder::day_first : DateOrder::month_first;
  }
};

}  // namespace detail
}  // namespace thermfit
