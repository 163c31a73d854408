#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/error.hpp"
#include "thermfit/number.hpp"

namespace thermfit {

namespace detail {

/// Time of a row on the clock that all parts share: since 1970 where a clock tells dates.
inline double shared_time_s(const Batch& part, const Batch& first, Index row) {
  const double shift = part.begins_s - first.begins_s;  // NaN where neither tells dates
  return part.time_s(row) + (std::isfinite(shift) ? shift : 0);
}

inline void require_same_channels(const Batch& part, const Batch& first) {
  const std::string place = part.source.empty() ? part.name : part.source;
  if (part.temperatures.names != first.temperatures.names || part.errors.names != first.errors.names ||
      part.inputs.names != first.inputs.names)
    throw Error(place, "has other columns than " + first.name + ", which it is joined to",
                "the same temperatures, errors and inputs in every part",
                "choose common ones with CsvOptions::temperatures, CsvOptions::errors, CsvOptions::inputs");
  if (part.has_time() != first.has_time() || std::isfinite(part.begins_s) != std::isfinite(first.begins_s))
    throw Error(place, "has another clock than " + first.name + ", which it is joined to", "one clock for all parts",
                "leave time out: CsvOptions::time_column = none");
}

}  // namespace detail

/// Several batches as one: a run that a logger split into files. Parts with a clock are put in its order, others stay
/// in theirs; rises and errors start in the first row of the first. Rows are numbered through. Throws Error without
/// parts, where channels differ, and where a part begins before the one before it ends. Allocates.
inline Batch joined(std::vector<Batch> parts, const std::string& name) {
  if (parts.empty()) throw Error(name, "no part to join", "1 or more");
  for (const Batch& part : parts) detail::require_same_channels(part, parts.front());
  const Batch origin = parts.front();
  if (origin.has_time())
    std::stable_sort(parts.begin(), parts.end(), [&](const Batch& a, const Batch& b) {
      return detail::shared_time_s(a, origin, 0) < detail::shared_time_s(b, origin, 0);
    });
  Batch whole = parts.front();
  whole.name = name;
  whole.digest.clear();
  Index rows = 0, in_files = 0;
  for (const Batch& part : parts) rows += part.rows();
  whole.dropped_rows = whole.held_values = 0;
  whole.row_numbers.clear();
  if (whole.has_time()) whole.time_s.resize(rows);
  for (Channels* channels : {&whole.temperatures, &whole.errors, &whole.inputs})
    channels->values.resize(rows, channels->count());
  Index at = 0;
  const Batch* before = nullptr;
  for (const Batch& part : parts) {
    if (before && whole.has_time()) {
      const double begin = detail::shared_time_s(part, parts.front(), 0), end = whole.time_s(at - 1);
      if (!(begin > end))
        throw Error(part.source.empty() ? part.name : part.source,
                    "begins at " + general_text(begin, 10) + " s, and " + before->name +
                        ", which it is joined to, ends at " + general_text(end, 10) + " s",
                    "a clock that goes on from part to part",
                    "where it begins anew in each nobody knows what lies between: write one clock, or leave time out: "
                    "CsvOptions::time_column = none");
    }
    for (Index row = 0; row < part.rows(); ++row) {
      whole.row_numbers.push_back(in_files + part.number_of(row));
      if (whole.has_time()) whole.time_s(at + row) = detail::shared_time_s(part, parts.front(), row);
    }
    const std::pair<Channels*, const Channels*> pairs[] = {
        {&whole.temperatures, &part.temperatures}, {&whole.errors, &part.errors}, {&whole.inputs, &part.inputs}};
    for (const auto& [to, from] : pairs)
      for (Index c = 0; c < to->count(); ++c)
        for (Index row = 0; row < part.rows(); ++row) to->values(at + row, c) = from->values(row, c);
    whole.dropped_rows += part.dropped_rows;
    whole.held_values += part.held_values;
    in_files += part.rows() + part.dropped_rows;
    at += part.rows();
    before = &part;
  }
  if (whole.row_numbers.back() == rows) whole.row_numbers.clear();
  return whole;
}

}  // namespace thermfit
