#pragma once

/// The library names fields of its options (`CsvOptions::missing = drop`), the command names flags (`--missing drop`).

#include <string>
#include <string_view>
#include <vector>

namespace thermfit::cli {

struct FieldFlag {
  std::string_view field;  ///< as the library's messages name it, "CsvOptions::missing"
  std::string_view flag;   ///< "--missing"; behind the name of its command where only one has it
};

/// The one table of both.
const std::vector<FieldFlag>& field_flags();

/// A message of the library in the words of the command line: each field of the table is its flag, and `field = value`
/// is `flag value`.
std::string with_flags(std::string_view message);

}  // namespace thermfit::cli
