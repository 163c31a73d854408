#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "thermfit/constants.hpp"
#include "thermfit/number.hpp"

namespace thermfit {

/// What a unit measures, told by thermfit in s, degC or um.
enum class Quantity { time, temperature, length };

/// A unit as a way to thermfit's own: `canonical = (value - zero) * numerator / denominator` in s, degC or um.
/// Two factors, so that 212 degF is 100 degC and 0.1 h is 360 s to the last digit.
struct Unit {
  Quantity quantity;  ///< what it measures
  double zero,        ///< value in this unit that is 0 in thermfit's own
      numerator,      ///< of the factor from this unit to thermfit's own
      denominator;    ///< of the same; never 0

  /// A value in this unit, in s, degC or um. Does not allocate.
  double to_canonical(double value) const { return (value - zero) * numerator / denominator; }
  /// Whether it is thermfit's own, so that values stay as they are. Does not allocate.
  bool is_canonical() const { return zero == 0 && numerator == denominator; }
  /// Whether values in both mean the same. Does not allocate.
  bool is_same_as(const Unit& other) const {
    return quantity == other.quantity && zero == other.zero &&
           numerator * other.denominator == other.numerator * denominator;
  }
};

namespace detail {

struct NamedUnits {
  std::string_view names;  ///< plain spellings, each between blanks
  Unit unit;
};

inline constexpr std::array<NamedUnits, 17> unit_table{{
    {" s sec secs second seconds sek sekunde sekunden 秒 ", {Quantity::time, 0, 1, 1}},
    {" ms msec millisecond milliseconds millisekunden 毫秒 ", {Quantity::time, 0, 1, 1000}},
    {" us usec microsecond microseconds mikrosekunden 微秒 ", {Quantity::time, 0, 1, 1e6}},
    {" min mins minute minutes minuten 分 分钟 ", {Quantity::time, 0, 60, 1}},
    {" h hr hrs hour hours std stunde stunden 小时 ", {Quantity::time, 0, 3600, 1}},
    {" d day days tag tage 天 ", {Quantity::time, 0, 86400, 1}},
    {" degc c celsius degcelsius degreec degreesc degreecelsius degreescelsius gradc gradcelsius oc centigrade 摄氏度 ",
     {Quantity::temperature, 0, 1, 1}},
    {" degf f fahrenheit degfahrenheit degreef degreesf degreefahrenheit degreesfahrenheit gradf gradfahrenheit of ",
     {Quantity::temperature, 32, 5, 9}},
    {" k kelvin degk ", {Quantity::temperature, ice_point_K, 1, 1}},
    {" um micron microns micrometer micrometers micrometre micrometres mikrometer mkm µ 微米 ",
     {Quantity::length, 0, 1, 1}},
    {" nm nanometer nanometers nanometre nanometres 纳米 ", {Quantity::length, 0, 1, 1000}},
    {" mm millimeter millimeters millimetre millimetres 毫米 ", {Quantity::length, 0, 1000, 1}},
    {" cm centimeter centimeters centimetre centimetres zentimeter 厘米 ", {Quantity::length, 0, 10000, 1}},
    {" m meter meters metre metres ", {Quantity::length, 0, 1e6, 1}},
    {" in inch inches ", {Quantity::length, 0, 25400, 1}},
    {" mil mils thou ", {Quantity::length, 0, 25.4, 1}},
    {" microinch microinches uin ", {Quantity::length, 0, 254, 10000}},
}};

/// Signs that look alike, or stand for a blank, and what a plain spelling has instead.
inline constexpr std::pair<std::string_view, std::string_view> unit_signs[] = {
    {"°", "deg"}, {"º", "deg"}, {"˚", "deg"}, {"℃", "degc"}, {"℉", "degf"}, {"μ", "µ"}};

/// Blanks that cannot be told from a blank, or not be seen at all, as bytes of UTF-8.
inline constexpr std::string_view hidden_blanks[] = {"\xC2\xA0",     "\xE2\x80\x87", "\xE2\x80\xAF", "\xE2\x80\x89",
                                                     "\xE2\x80\x8B", "\xE3\x80\x80", "\xEF\xBB\xBF"};

inline bool starts_with(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }

/// How many bytes at the front of `text` are one blank, a hidden one too; 0 when it begins with something else.
inline std::size_t blank_in_front(std::string_view text) {
  if (text.empty()) return 0;
  if (text.front() == ' ' || text.front() == '\t' || text.front() == '\r') return 1;
  for (const std::string_view blank : hidden_blanks)
    if (starts_with(text, blank)) return blank.size();
  return 0;
}

/// A unit's name without what does not tell units apart: case, blanks, full stops, which sign stands for degree.
inline std::string plain_unit(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    std::size_t used = blank_in_front(text);
    for (const auto& [sign, instead] : unit_signs)
      if (used == 0 && starts_with(text, sign)) plain += instead, used = sign.size();
    if (used == 0 && (text.front() == '.' || text.front() == '_')) used = 1;
    if (used == 0) {
      const char c = text.front();
      plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      used = 1;
    }
    text.remove_prefix(used);
  }
  if (plain.size() > 2 && starts_with(plain, "µ")) plain.replace(0, 2, "u");  // µm, µs
  return plain;
}

/// The unit of a name, without a factor. Where case makes another unit of it (Nm, Mm, M) only the right one counts.
inline std::optional<Unit> unit_named(std::string_view text) {
  if (text == "M" || text == "Mm" || text == "Nm" || text == "NM") return std::nullopt;
  const std::string plain = ' ' + plain_unit(text) + ' ';
  if (plain.size() < 3 || plain.find(' ', 1) + 1 != plain.size()) return std::nullopt;
  for (const auto& [names, unit] : unit_table)
    if (names.find(plain) != std::string_view::npos) return unit;
  return std::nullopt;
}

/// `0.1`, `0,1`, `1e-3`, `10^-3`, `1/1000`, with a blank or a sign of multiplication behind: a positive factor.
inline std::optional<double> unit_factor(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '*' || text.back() == 'x')) text.remove_suffix(1);
  const auto number = [](std::string_view part) {
    std::string written(part);
    if (const std::size_t comma = written.find(','); comma != std::string::npos) written[comma] = '.';
    return parse_number(written);
  };
  if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
    const auto above = number(text.substr(0, slash)), below = number(text.substr(slash + 1));
    return above && below && *above > 0 && *below > 0 ? std::optional<double>(*above / *below) : std::nullopt;
  }
  if (starts_with(text, "10^")) {
    const auto power = number(text.substr(3));
    return power ? parse_number("1e" + std::string(text.substr(3))) : std::nullopt;
  }
  const auto factor = number(text);
  return factor && *factor > 0 ? factor : std::nullopt;
}

}  // namespace detail

/// The unit that `text` names, in any case and usual spelling (degC, °C, Deg. C), also with a factor before it
/// (0.1 um, 1.25um, 1/1000 mm, as some controls count), and of a length also with a minus before it (-um: corrections,
/// where thermfit counts errors); nothing when unknown. Allocates.
inline std::optional<Unit> find_unit(std::string_view text) {
  if (detail::starts_with(text, "-") && text.size() > 1 && text[1] != '-' && !(text[1] >= '0' && text[1] <= '9')) {
    auto unit = find_unit(text.substr(1));
    if (!unit || unit->quantity != Quantity::length) return std::nullopt;
    unit->numerator = -unit->numerator;
    return unit;
  }
  if (const auto unit = detail::unit_named(text)) return unit;
  if (text.empty() || text.front() < '0' || text.front() > '9') return std::nullopt;
  for (std::size_t i = 1; i < text.size(); ++i) {
    const auto unit = detail::unit_named(text.substr(i));
    if (!unit) continue;
    const auto factor = detail::unit_factor(text.substr(0, i));
    if (!factor) continue;
    return Unit{unit->quantity, unit->zero / *factor, unit->numerator * *factor, unit->denominator};
  }
  return std::nullopt;
}

/// The usual spellings of the units of a quantity, for messages.
inline std::string_view unit_names(Quantity quantity) {
  switch (quantity) {
    case Quantity::time:
      return "us, ms, s, min, h, d";
    case Quantity::temperature:
      return "degC, °C, C, degF, °F, F, K";
    case Quantity::length:
      break;
  }
  return "um, µm, nm, mm, cm, m, in, mil, microinch, or with a factor as in 0.1 um";
}

}  // namespace thermfit
