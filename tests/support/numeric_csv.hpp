#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "thermfit/number.hpp"
#include "thermfit/types.hpp"

/// A plain comma-separated table of numbers with a header, for reference data: names and rows x columns.
struct NumericCsv {
  std::vector<std::string> names;
  thermfit::Matrix values;

  explicit NumericCsv(const std::string& path) {
    std::ifstream file(path);
    INFO(path);
    REQUIRE(file);
    std::string line;
    std::getline(file, line);
    names = fields(line);
    std::vector<std::vector<double>> rows;
    while (std::getline(file, line)) {
      rows.emplace_back();
      for (const std::string& field : fields(line)) rows.back().push_back(thermfit::parse_number(field).value());
    }
    values.resize(static_cast<thermfit::Index>(rows.size()), static_cast<thermfit::Index>(names.size()));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < names.size(); ++c) {
        values(static_cast<thermfit::Index>(r), static_cast<thermfit::Index>(c)) = rows[r].at(c);
      }
    }
  }

  /// The columns from the one called `first` to the one called `last`.
  thermfit::Matrix columns(const std::string& first, const std::string& last) const {
    const thermfit::Index from = column(first);
    return values.middleCols(from, column(last) - from + 1);
  }

  thermfit::Index column(const std::string& name) const {
    for (std::size_t c = 0; c < names.size(); ++c) {
      if (names[c] == name) return static_cast<thermfit::Index>(c);
    }
    FAIL("no column " << name);
    return 0;
  }

 private:
  static std::vector<std::string> fields(std::string line) {
    std::vector<std::string> result(1);
    for (const char c : line) {
      if (c == ',') {
        result.emplace_back();
      } else if (c != '"' && c != '\r') {
        result.back() += c;
      }
    }
    return result;
  }
};
