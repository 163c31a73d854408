#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/series_scale.hpp"

namespace thermfit {

/// When a change of an input is a switch that may make readings jump.
struct SwitchLimits {
  double least_share = 0.05;    ///< of the input's range: less is a measured input that dithers, or a counter
  double busiest_share = 0.25;  ///< of the rows: an input that changes more often is not switched
};

/// Rows in which a known input is switched to another level, increasing. Allocates.
inline std::vector<Index> switching_rows(const Channels& inputs, const SwitchLimits& limits = {}) {
  std::vector<Index> rows;
  for (Index c = 0; c < inputs.count(); ++c) {
    const Series series(inputs.values.col(c));
    const SeriesScale scale = series_scale(series);
    std::vector<Index> own;
    for (std::size_t i = 1; i < series.size(); ++i)
      if (std::abs(series.values[i] - series.values[i - 1]) > limits.least_share * scale.range())
        own.push_back(series.rows[i]);
    if (static_cast<double>(own.size()) <= limits.busiest_share * static_cast<double>(inputs.values.rows()))
      rows.insert(rows.end(), own.begin(), own.end());
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

}  // namespace thermfit
