#pragma once

#include <algorithm>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/findings/clock_findings.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/frozen_findings.hpp"
#include "thermfit/findings/redundancy_findings.hpp"
#include "thermfit/findings/transient_findings.hpp"
#include "thermfit/findings/unit_findings.hpp"

namespace thermfit {

/// Everything suspicious about a batch, in the order of its channels and rows. Values that are not finite count as
/// missing. Thresholds are multiples of each channel's own noise and resolution, so that they need no tuning and a
/// coarse thermometer is not taken for a stuck one. Batches of less than 12 rows are checked for clock, missing and
/// constant values only. Allocates.
template <typename Scalar = double>
std::vector<Finding> find_faults(const Batch& batch) {
  std::vector<Finding> findings = clock_findings(batch);
  std::vector<Index> switching = switching_rows(batch.inputs);
  for (const Finding& one : findings) switching.push_back(one.last_row);  // what happened in a gap is not known
  std::sort(switching.begin(), switching.end());
  const MatrixX<Scalar> smooth = detail::despiked<Scalar>(batch.temperatures.values);
  const auto check = [&](const Channels& channels, bool is_error) {
    for (Index c = 0; c < channels.count(); ++c) {
      const Series series(channels.values.col(c));
      const std::string& name = channels.names[static_cast<std::size_t>(c)];
      const std::string unit = is_error ? "um" : "K";
      const SeriesScale scale = series_scale(series);
      if (const auto lost = missing_finding(channels.values.col(c), name)) findings.push_back(*lost);
      if (series.size() < 2) continue;
      if (scale.range() == 0) {
        if (series.size() >= 10)
          findings.push_back({FindingRule::constant, name, series.rows.front(), series.rows.back(), 0, scale.resolution,
                              unit, "never moves: not connected, or a set value?"});
        continue;
      }
      if (series.size() < 12) continue;
      if (is_error) {
        if (const auto stale = stale_finding(series, name)) {
          findings.push_back(*stale);
          continue;
        }
      }
      const auto frozen = frozen_finding<Scalar>(batch, smooth, c, is_error, series, scale);
      if (frozen) findings.push_back(*frozen);
      for (Finding& one : transient_findings(series, scale, switching, name, unit))
        if (!frozen || one.last_row < frozen->first_row || one.first_row > frozen->last_row + 1)
          findings.push_back(std::move(one));
    }
  };
  check(batch.temperatures, false);
  check(batch.errors, true);
  for (Finding& one : redundancy_findings<Scalar>(batch)) findings.push_back(std::move(one));
  for (Finding& one : unit_findings(batch)) findings.push_back(std::move(one));
  return findings;
}
THERMFIT_COMPILED_TEMPLATE(std::vector<Finding> find_faults<double>(const Batch&));

}  // namespace thermfit
