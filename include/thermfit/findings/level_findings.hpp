#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/error_reference.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/number.hpp"

namespace thermfit {

/// A finding of the campaign's error `name`, and the batch whose start is farthest off the others'.
struct LevelFinding {
  std::size_t batch;  ///< index in the campaign
  Finding finding;    ///< its figure and limit are standard deviations: of starts, and within batches, um
};

/// Whether batches start an error further apart than it moves in one of them. Where rises are 0 no temperature tells
/// batches apart: the probe's zero does. Batches with fewer than `least_rows` readings say nothing; none of fewer than
/// two others. Allocates.
inline std::optional<LevelFinding> level_finding(const Campaign& campaign, const std::string& name,
                                                 std::size_t least_rows = 12) {
  std::vector<double> starts;
  std::vector<std::size_t> batches;
  double squares = 0, freedom = 0;
  for (std::size_t b = 0; b < campaign.size(); ++b) {
    const Index column = campaign[b].errors.find(name);
    if (column < 0) continue;
    const Vector error = campaign[b].errors.values.col(column);
    const Series series(error);
    if (series.size() < least_rows) continue;
    const ErrorStart start = error_start(error);
    starts.push_back(start.value_um);
    batches.push_back(b);
    double mean = 0;
    for (const double value : series.values) mean += value / static_cast<double>(series.size());
    for (const double value : series.values) squares += (value - mean) * (value - mean);
    freedom += static_cast<double>(series.size() - 1);
  }
  if (starts.size() < 2 || freedom < 1) return std::nullopt;
  double mean = 0, spread = 0;
  for (const double start : starts) mean += start / static_cast<double>(starts.size());
  for (const double start : starts) spread += (start - mean) * (start - mean);
  spread = std::sqrt(spread / static_cast<double>(starts.size() - 1));
  const double within = std::sqrt(squares / freedom), middle = median(starts);
  if (!(spread > within)) return std::nullopt;
  std::size_t farthest = 0;
  for (std::size_t i = 1; i < starts.size(); ++i)
    if (std::abs(starts[i] - middle) > std::abs(starts[farthest] - middle)) farthest = i;
  const auto [lowest, highest] = std::minmax_element(starts.begin(), starts.end());
  return LevelFinding{batches[farthest],
                      {FindingRule::level, name, 0, 0, spread, within, "um",
                       "starts at " + fixed_text(*lowest, 1) + " … " + fixed_text(*highest, 1) + " um in " +
                           std::to_string(starts.size()) +
                           " batches, further apart than it moves in one: was the probe set to zero anew in each? "
                           "TrainingPlan::error_reference = start counts errors from there"}};
}

}  // namespace thermfit
