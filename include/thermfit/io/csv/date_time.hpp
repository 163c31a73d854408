#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace thermfit {

/// An ISO 8601 instant. Without a zone it is taken as it stands, which is right for differences on one clock.
struct DateTime {
  std::int64_t seconds;  ///< since 1970-01-01T00:00:00, zone applied
  double fraction;       ///< of a second, [0, 1)
  bool has_zone;         ///< a zone was written: Z or an offset
};

namespace detail {

/// Days from 1970-01-01 to a date of the proleptic Gregorian calendar (H. Hinnant, "chrono-compatible low-level date
/// algorithms").
inline std::int64_t days_from_civil(std::int64_t year, int month, int day) {
  year -= month <= 2;
  const std::int64_t era = (year >= 0 ? year : year - 399) / 400;
  const std::int64_t year_of_era = year - era * 400;
  const std::int64_t day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year - 719468;
}

/// Takes `count` digits off the front of `text`; -1 when they are not there.
inline int take_digits(std::string_view& text, std::size_t count) {
  if (text.size() < count) return -1;
  int value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (text[i] < '0' || text[i] > '9') return -1;
    value = 10 * value + (text[i] - '0');
  }
  text.remove_prefix(count);
  return value;
}

inline bool take(std::string_view& text, char wanted) {
  if (text.empty() || text.front() != wanted) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace detail

/// Reads `YYYY-MM-DDThh:mm[:ss[.fff]][Z|±hh[:]mm]`; a blank may stand for the T, a comma for the point. Nothing for
/// any other text and for dates that do not exist. Leap seconds are not known.
inline std::optional<DateTime> parse_date_time(std::string_view text) {
  using detail::take, detail::take_digits;
  const int year = take_digits(text, 4);
  if (year < 0 || !take(text, '-')) return std::nullopt;
  const int month = take_digits(text, 2);
  if (month < 1 || month > 12 || !take(text, '-')) return std::nullopt;
  const int day = take_digits(text, 2);
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  constexpr int lengths[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  if (day < 1 || day > lengths[month - 1] + (leap && month == 2)) return std::nullopt;
  if (!take(text, 'T') && !take(text, ' ')) return std::nullopt;
  const int hour = take_digits(text, 2);
  if (hour < 0 || hour > 23 || !take(text, ':')) return std::nullopt;
  const int minute = take_digits(text, 2);
  if (minute < 0 || minute > 59) return std::nullopt;
  int second = 0;
  double fraction = 0;
  if (take(text, ':')) {
    second = take_digits(text, 2);
    if (second < 0 || second > 59) return std::nullopt;
    if (take(text, '.') || take(text, ',')) {
      std::int64_t digits = 0, scale = 1;
      std::size_t count = 0;
      for (; count < text.size() && text[count] >= '0' && text[count] <= '9'; ++count)
        if (scale < 1'000'000'000'000'000) digits = 10 * digits + (text[count] - '0'), scale *= 10;
      if (count == 0) return std::nullopt;
      text.remove_prefix(count);
      fraction = static_cast<double>(digits) / static_cast<double>(scale);
    }
  }
  std::int64_t offset_s = 0;
  bool has_zone = false;
  if (take(text, 'Z')) {
    has_zone = true;
  } else if (!text.empty() && (text.front() == '+' || text.front() == '-')) {
    has_zone = true;
    const int sign = text.front() == '-' ? -1 : 1;
    text.remove_prefix(1);
    const int hours = take_digits(text, 2);
    take(text, ':');
    const int minutes = text.empty() ? 0 : take_digits(text, 2);
    if (hours < 0 || hours > 23 || minutes < 0 || minutes > 59) return std::nullopt;
    offset_s = sign * (3600 * hours + 60 * minutes);
  }
  if (!text.empty()) return std::nullopt;
  return DateTime{detail::days_from_civil(year, month, day) * 86400 + 3600 * hour + 60 * minute + second - offset_s,
                  fraction, has_zone};
}

}  // namespace thermfit
