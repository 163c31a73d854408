#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/findings/transient_findings.hpp"

namespace thermfit {

/// Steps that stay and take 2 to `back_within_rows` rows: a move far beyond what the same number of rows before and
/// after make, and beyond twice the limit of a jump. By itself that may be a heater beside the sensor: only a caller
/// who knows that nothing else moved may call it a fault. In order of rows; `unit` is that of the series. Allocates.
inline std::vector<Finding> slow_jump_findings(const Series& series, const SeriesScale& scale, const std::string& name,
                                               const std::string& unit, const TransientLimits& limits = {}) {
  const std::vector<double>& x = series.values;
  const double least = 2 * limits.jump_of(scale);
  std::vector<Finding> findings;
  for (std::size_t width = 2; width <= limits.back_within_rows; ++width) {
    std::vector<double> usual;  // of as many rows, where nothing jumps: what moves by itself is no fault
    bool any = false;
    for (std::size_t from = width; from + 2 * width < x.size(); ++from) {
      const double before = x[from] - x[from - width], after = x[from + 2 * width] - x[from + width];
      usual.push_back(std::abs(x[from + width] - x[from] - (before + after) / 2));
      any = any || usual.back() > least;
    }
    if (!any) continue;
    const double limit = std::max(least, limits.spike_noise * median(std::move(usual)) / normal_median);
    for (std::size_t from = width; from + 2 * width < x.size(); ++from) {
      const std::size_t to = from + width;
      const double move = x[to] - x[from];
      if (std::abs(move) <= limit) continue;
      const double before = x[from] - x[from - width], after = x[to + width] - x[to];
      if (std::abs(move - (before + after) / 2) <= limit ||
          std::abs(move) <= limits.edge_over_steps * std::max(std::abs(before), std::abs(after)))
        continue;
      bool steady = series.rows[to] - series.rows[from] == static_cast<Index>(width);
      for (std::size_t i = from + 1; i <= to; ++i) steady = steady && (x[i] - x[i - 1]) * move > 0;
      if (!steady) continue;
      const Finding found{FindingRule::jump,
                          name,
                          series.rows[from],
                          series.rows[to],
                          std::abs(move),
                          limit,
                          unit,
                          "rises by that within a few rows and stays, and nothing else moves: a contact?"};
      if (!findings.empty() && findings.back().last_row >= found.first_row &&
          findings.back().first_row <= found.last_row) {
        if (found.figure > findings.back().figure) findings.back() = found;
      } else {
        findings.push_back(found);
      }
    }
  }
  return findings;
}

}  // namespace thermfit
