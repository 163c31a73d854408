#pragma once

/// Pieces that exported sources are made of.

#include <charconv>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "export/export.hpp"

namespace thermfit::cli {

/// `text` less the parts that are not `wanted`: lines from `@?part@` to `@.@`, both taken away.
std::string chosen_parts(std::string_view text, const std::vector<std::string>& wanted);

/// `text` with every `@key@` replaced. An unknown key is a bug and throws std::logic_error.
std::string fill_template(std::string_view text, const std::map<std::string, std::string>& values);

/// Sensor and error names as identifiers: letters, digits and single underscores, not starting with a digit, all
/// different also for a compiler that ignores case.
std::vector<std::string> identifiers(const std::vector<std::string>& names);

/// Text that may stand in a comment: no line break, no comment end of any target's language.
std::string comment_text(std::string_view text);

std::string upper_case(std::string text);

/// Shortest decimal text that reads back to the same Scalar, always with a decimal point: 1.0, 2.5e-05.
template <class Scalar>
std::string real_text(Scalar value) {
  char buffer[40];
  std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  if (text.find('.') != std::string::npos) return text;
  const auto exponent = text.find('e');
  return exponent == std::string::npos ? text + ".0" : text.insert(exponent, ".0");
}

/// Refuses a model whose derived channels need a memory, where the target has none: throws Error.
void require_formula(const ExportRequest& request, const std::string& target, const std::string& why);

/// What every export says about itself, one line each, without comment marks: origin, digest, what goes in and comes
/// out with unit and sign, limits.
std::vector<std::string> facts(const ExportRequest& request);

/// The same as comment lines that start with `mark`.
std::string fact_comment(const ExportRequest& request, std::string_view mark);

std::string sign_name(OutputSign sign);        ///< "error" or "correction"
std::string policy_name(DomainPolicy policy);  ///< "ignore", "warn", "shrink", "hold"
std::string zero_name(ZeroPolicy policy);      ///< "wait" or "first"

}  // namespace thermfit::cli
