#pragma once

#include <algorithm>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/findings/clock_findings.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/frozen_findings.hpp"
#include "thermfit/findings/impossible_findings.hpp"
#include "thermfit/findings/judged_channel.hpp"
#include "thermfit/findings/redundancy_findings.hpp"
#include "thermfit/findings/switching_rows.hpp"
#include "thermfit/findings/unit_findings.hpp"

namespace thermfit {

/// What every rule allows. The numbers are choices: with them the clean campaigns of data/ raise no alarm and each
/// fault that tests/findings puts into them is told once.
struct FindingLimits {
  PossibleReadings possible;       ///< numbers that are no readings
  SwitchLimits switching;          ///< what excuses a jump
  ClockLimits clock;               ///< gaps in time
  FrozenLimits frozen;             ///< stuck and saturated channels
  StaleLimits stale;               ///< thermal errors read less often than written
  TransientLimits transient;       ///< spikes and jumps
  HeldLimits held;                 ///< channels that are read now and then
  CoincidenceLimits coincidence;   ///< what the other channels say to a jump
  RedundancyLimits redundancy;     ///< copies and computed temperatures
  UnitLimits units;                ///< values of another unit
  std::size_t constant_rows = 10;  ///< readings from which on a channel that never moves is told
  std::size_t judged_rows =
      12;  ///< readings from which on a channel is judged beyond clock, missing and constant values
};

/// Everything suspicious about a batch, in the order of its channels and rows. Values that are not finite count as
/// missing. Thresholds are multiples of each channel's own noise and resolution, so that they need no tuning and a
/// coarse thermometer is not taken for a stuck one. Allocates.
template <typename Scalar = double>
std::vector<Finding> find_faults(const Batch& as_recorded, const FindingLimits& limits = {}) {
  Batch batch = as_recorded;  // without what no machine can have
  std::vector<Finding> findings = clock_findings(batch, limits.clock);
  std::vector<Index> switching = switching_rows(batch.inputs, limits.switching);
  for (const Finding& one : findings) switching.push_back(one.last_row);  // what happened in a gap is not known
  std::sort(switching.begin(), switching.end());
  for (const bool is_error : {false, true}) {
    Channels& channels = is_error ? batch.errors : batch.temperatures;
    for (Index c = 0; c < channels.count(); ++c)
      for (Finding& one : impossible_findings(channels.values.col(c), is_error,
                                              channels.names[static_cast<std::size_t>(c)], limits.possible))
        findings.push_back(std::move(one));
  }
  std::vector<JudgedChannel> temperatures = judged_channels(batch.temperatures, "K", switching, limits.judged_rows,
                                                            limits.transient, limits.held),
                             errors = judged_channels(batch.errors, "um", switching, limits.judged_rows,
                                                      limits.transient, limits.held);
  consult_others(batch, temperatures, errors, limits.transient, limits.coincidence);
  MatrixX<Scalar> smooth = detail::despiked<Scalar>(batch.temperatures.values);
  for (Index c = 0; c < batch.temperatures.count(); ++c)  // at the ends no median takes a spike out
    for (const Finding& one : temperatures[static_cast<std::size_t>(c)].transient)
      if (one.rule == FindingRule::spike && (one.first_row < 2 || one.last_row + 2 >= batch.rows()))
        smooth.col(c).segment(one.first_row, one.last_row - one.first_row + 1).setConstant(std::nan(""));
  const std::optional<detail::RowSums<Scalar>> sums = detail::row_sums<Scalar>(smooth);
  const auto check = [&](const Channels& channels, const Channels& recorded, bool is_error) {
    for (Index c = 0; c < channels.count(); ++c) {
      const std::string& name = channels.names[static_cast<std::size_t>(c)];
      const std::string unit = is_error ? "um" : "K";
      const JudgedChannel& judged = (is_error ? errors : temperatures)[static_cast<std::size_t>(c)];
      const Series& series = judged.series;
      const SeriesScale& scale = judged.scale;
      if (const auto lost = missing_finding(recorded.values.col(c), name)) findings.push_back(*lost);
      if (series.size() < 2) continue;
      if (scale.range() == 0) {
        if (series.size() >= limits.constant_rows)
          findings.push_back({FindingRule::constant, name, series.rows.front(), series.rows.back(), 0, scale.resolution,
                              unit, "never moves: not connected, or a set value?"});
        continue;
      }
      if (series.size() < limits.judged_rows) continue;
      if (is_error) {
        if (const auto stale = stale_finding(series, name, limits.stale)) {
          findings.push_back(*stale);
          if (judged.held) findings.insert(findings.end(), judged.transient.begin(), judged.transient.end());
          continue;
        }
      }
      const auto frozen = frozen_finding<Scalar>(batch, smooth, c, is_error, series, scale, limits.frozen, sums);
      if (frozen) findings.push_back(*frozen);
      for (const Finding& one : judged.transient)
        if (!frozen || one.last_row < frozen->first_row || one.first_row > frozen->last_row + 1)
          findings.push_back(one);
    }
  };
  check(batch.temperatures, as_recorded.temperatures, false);
  check(batch.errors, as_recorded.errors, true);
  for (Finding& one : redundancy_findings<Scalar>(batch, limits.redundancy)) findings.push_back(std::move(one));
  for (Finding& one : unit_findings(batch, limits.units)) findings.push_back(std::move(one));
  return findings;
}
THERMFIT_COMPILED_TEMPLATE(std::vector<Finding> find_faults<double>(const Batch&, const FindingLimits&));

}  // namespace thermfit
