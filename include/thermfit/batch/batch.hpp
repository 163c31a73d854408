#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit {

/// Named columns of one kind: `values` is rows x names.size(), in the order of `names`.
struct Channels {
  std::vector<std::string> names;  ///< as in the file, without the unit
  Matrix values;                   ///< rows x names.size(), in the unit of the kind; NaN where a value is missing

  /// How many channels there are. Does not allocate.
  Index count() const { return static_cast<Index>(names.size()); }

  /// Column of `name`, or -1. Does not allocate.
  Index find(const std::string& name) const {
    const auto it = std::find(names.begin(), names.end(), name);
    return it == names.end() ? -1 : static_cast<Index>(it - names.begin());
  }
};

/// One experiment: what the thermometers, the displacement probes and the control reported, one row per sample.
///
/// Units are fixed (the reader converts): temperatures in degC, thermal errors in um, time in s.
/// Inputs keep the unit of their column. Every member has rows() rows, except that `time_s` may be empty: a batch
/// without a clock can be fitted, but not simulated.
struct Batch {
  std::string name;                ///< file stem or value of the batch column, e.g. "K01"
  std::string source;              ///< path it was read from; empty when made in memory
  std::string digest;              ///< SHA-256 of its numbers, hex; empty when made in memory
  Vector time_s;                   ///< strictly increasing; empty when the data have no time
  Channels temperatures;           ///< degC, absolute
  Channels errors;                 ///< um, the responses
  Channels inputs;                 ///< known inputs: spindle_rpm, feed_mm_min, coolant, …
  Index dropped_rows = 0;          ///< rows the reader left out because a value was missing (MissingValues::drop)
  Index held_values = 0;           ///< missing values replaced by the last one of their channel (MissingValues::hold)
  std::vector<Index> row_numbers;  ///< where rows were left out: the number of each in its file, from 1; else empty
  Vector first_degC;  ///< where the first row was left out: its temperatures, NaN where there was none; else empty
  double begins_s = std::numeric_limits<double>::quiet_NaN();  ///< time 0 of a clock of dates, since 1970; else NaN

  /// Number in its file of a row, from 1. Does not allocate.
  Index number_of(Index row) const {
    return row_numbers.empty() ? row + 1 : row_numbers[static_cast<std::size_t>(row)];
  }

  /// Number of samples, from whichever member has any. Does not allocate.
  Index rows() const {
    if (temperatures.values.cols() > 0) return temperatures.values.rows();
    return errors.values.cols() > 0 ? errors.values.rows() : time_s.size();
  }
  /// Whether the batch has a clock. Does not allocate.
  bool has_time() const { return time_s.size() > 0; }
};

/// The experiments of one machine, with equal temperature points and errors, in a fixed order.
using Campaign = std::vector<Batch>;

}  // namespace thermfit
