#pragma once

#include <string>

#include "thermfit/batch/batch.hpp"
#include "thermfit/io/csv/title.hpp"
#include "thermfit/number.hpp"

namespace thermfit {

/// A name as a CSV field: in quotes where it needs them, quotes inside it doubled (RFC 4180). Allocates.
inline std::string csv_field(const std::string& text) {
  if (text.find_first_of(",;\t\"") == std::string::npos && text.rfind('#', 0) != 0 && !text.empty() &&
      text.front() != ' ' && text.back() != ' ')
    return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

/// A batch as CSV that read_campaign reads back: `time_s`, temperatures, errors, inputs; where a name ends in a unit,
/// as Z_mm does, the one of the numbers stands behind it. Numbers are the
/// shortest text that gives the same double again, unless `decimals` of temperatures and errors is given; missing
/// values are empty.
inline std::string write_csv(const Batch& batch, int decimals = -1) {
  std::string text;
  const char* separator = "";
  const auto field = [&](const std::string& one) {
    text += separator + one;
    separator = ",";
  };
  const auto number = [&](double value, int digits) {
    field(!(value == value) ? std::string() : digits < 0 ? exact_text(value) : fixed_text(value, digits));
  };
  if (batch.has_time()) field("time_s");
  const Channels* const groups[] = {&batch.temperatures, &batch.errors, &batch.inputs};
  for (const Channels* group : groups)
    for (const std::string& name : group->names) {
      const bool says_a_unit = group != &batch.inputs && detail::split_unit_in_words(name);
      field(csv_field(says_a_unit ? name + (group == &batch.temperatures ? " [degC]" : " [um]") : name));
    }
  text += '\n';
  for (Index row = 0; row < batch.rows(); ++row) {
    separator = "";
    if (batch.has_time()) field(exact_text(batch.time_s(row)));
    for (const Channels* group : groups)
      for (Index c = 0; c < group->count(); ++c) number(group->values(row, c), group == &batch.inputs ? -1 : decimals);
    text += '\n';
  }
  return text;
}

}  // namespace thermfit
