#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "thermfit/io/csv/roles.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// One row of a file, in thermfit's units. The views hold until the next row is asked for.
struct CsvRow {
  /// The values of one role, a view; NaN where one is missing and MissingValues::keep is asked for.
  using Values = Eigen::Map<const Eigen::RowVectorXd>;
  std::size_t line;                         ///< in the file, from 1
  std::string_view batch;                   ///< value of the batch column; empty without one
  double time_s;                            ///< NaN without a clock
  Values temperatures,                      ///< degC
      errors,                               ///< um
      inputs;                               ///< as written
  Index held_values = 0;                    ///< values that were missing and are the last ones of their channel
  Index number = 0;                         ///< in its batch, from 1, counting rows that were left out
  Values first_degC = Values(nullptr, 0);   ///< temperatures of row 1 of its batch, NaN where it has none
  double begins_s = detail::missing_value;  ///< time 0 of its batch, since 1970; NaN where the clock tells no dates
};

/// What was met while reading one file.
struct CsvFile {
  std::string path;                ///< `stdin` for standard input
  CsvDialect dialect;              ///< as found or as told
  CsvRoles roles;                  ///< of its columns
  std::size_t rows = 0;            ///< rows handed out
  std::size_t missing = 0;         ///< cells without a value, in columns that are used
  bool newest_first = false;       ///< the rows of a batch were turned round
  std::size_t dropped_rows = 0;    ///< rows left out for a missing value: MissingValues::drop or error
  std::size_t left_out_lines = 0;  ///< that are no rows for sure: the names again, sums and means at the end, EOF
  std::string first_left_out;      ///< `file:line ('Max,28,24')`
  std::string first_missing;       ///< `file:line:column (T3)`
  std::string widened;             ///< how a long table became a wide one
  std::string recognised;          ///< the named dialect that the file tells
  std::string clocks;              ///< how several clocks became one, and how many rows that cost
};

}  // namespace thermfit
