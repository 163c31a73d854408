#pragma once

/// A channel with its scale and what is abrupt in it, judged once.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/coincidence.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/findings/slow_jump_findings.hpp"
#include "thermfit/findings/transient_findings.hpp"

namespace thermfit {

/// The readings of a channel, and its spikes and jumps.
struct JudgedChannel {
  Series series;                   ///< readings that are finite
  SeriesScale scale;               ///< of them
  std::vector<Finding> transient;  ///< spikes and jumps
  std::vector<Finding> slow;       ///< jumps over several rows: faults only where nothing else moves
  bool held = false;               ///< whether it is read now and then and held in between
};

/// When a channel is read now and then and held in between.
struct HeldLimits {
  double moving_share = 0.5;    ///< it moves in at most this share of the rows, …
  std::size_t least_moves = 4;  ///< … at least so often, …
  double move_steps = 3;        ///< … typically by more steps of its resolution
};

namespace detail {

/// The first reading of each run of equal ones, where the channel is held: what it does from one to the next is no
/// jump. Nothing for any other.
inline std::optional<Series> held_readings(const Series& series, const SeriesScale& scale, const HeldLimits& limits) {
  Series read = series;
  std::vector<double> moves;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (i > 0 && series.values[i] == series.values[i - 1]) continue;
    if (i > 0) moves.push_back(std::abs(series.values[i] - series.values[i - 1]));
    read.values[kept] = series.values[i];
    read.rows[kept++] = series.rows[i];
  }
  if (static_cast<double>(moves.size()) > limits.moving_share * static_cast<double>(series.size()) ||
      moves.size() < limits.least_moves || median(moves) <= limits.move_steps * scale.resolution)
    return std::nullopt;
  read.values.resize(kept);
  read.rows.resize(kept);
  return read;
}

/// Spikes and jumps among held readings, counted in readings, told in rows: a reading holds until the next.
inline std::vector<Finding> transient_of_held(Series read, Index last_row, const std::vector<Index>& switching,
                                              const std::string& name, const std::string& unit,
                                              const TransientLimits& limits) {
  const std::vector<Index> rows = read.rows;
  std::vector<Index> switched;
  for (const Index row : switching) switched.push_back(std::lower_bound(rows.begin(), rows.end(), row) - rows.begin());
  for (std::size_t i = 0; i < read.size(); ++i) read.rows[i] = static_cast<Index>(i);
  std::vector<Finding> findings = transient_findings(read, series_scale(read), switched, name, unit, limits);
  for (Finding& one : findings) {
    const auto first = static_cast<std::size_t>(one.first_row), last = static_cast<std::size_t>(one.last_row);
    one.first_row = rows[first];
    one.last_row = one.rule != FindingRule::spike ? rows[last] : last + 1 < rows.size() ? rows[last + 1] - 1 : last_row;
  }
  return findings;
}

}  // namespace detail

/// Judges the channels, each by itself; those with fewer than `fewest` readings have no findings. `switching` holds
/// rows in order, `unit` is that of the channels. Allocates.
inline std::vector<JudgedChannel> judged_channels(const Channels& channels, const std::string& unit,
                                                  const std::vector<Index>& switching, std::size_t fewest,
                                                  const TransientLimits& limits = {}, const HeldLimits& held = {}) {
  std::vector<JudgedChannel> all;
  for (Index c = 0; c < channels.count(); ++c) {
    const std::string& name = channels.names[static_cast<std::size_t>(c)];
    all.push_back({Series(channels.values.col(c)), {}, {}, {}, false});
    JudgedChannel& one = all.back();
    one.scale = series_scale(one.series);
    if (one.series.size() < fewest) continue;
    if (const auto read = detail::held_readings(one.series, one.scale, held)) {
      one.held = true;
      one.transient = detail::transient_of_held(*read, one.series.rows.back(), switching, name, unit, limits);
      continue;
    }
    one.transient = transient_findings(one.series, one.scale, switching, name, unit, limits);
    for (Finding& slow : slow_jump_findings(one.series, one.scale, name, unit, limits)) {
      const auto switched = std::lower_bound(switching.begin(), switching.end(), slow.first_row - limits.settling_rows);
      if (switched == switching.end() || *switched > slow.last_row) one.slow.push_back(std::move(slow));
    }
  }
  return all;
}

/// Takes off the findings of `temperatures` and `errors` what other channels of the batch show to be the machine's
/// doing: a jump, or three rows and more off the course, during which a channel of another sensor moves abruptly too. A
/// jump over several rows is told where there are other channels and none moves. One or two rows off are no machine's
/// doing. Allocates.
inline void consult_others(const Batch& batch, std::vector<JudgedChannel>& temperatures,
                           std::vector<JudgedChannel>& errors, const TransientLimits& transient = {},
                           const CoincidenceLimits& limits = {}) {
  // Whether `moved(column, jump limit)` holds for a channel that may show what channel `own` did.
  const auto others_show = [&](bool is_error, std::size_t own, auto&& moved) {
    for (std::size_t c = 0; c < temperatures.size(); ++c)
      if ((is_error || c != own) &&
          moved(batch.temperatures.values.col(static_cast<Index>(c)), transient.jump_of(temperatures[c].scale) / 2))
        return true;
    for (std::size_t c = 0; !is_error && c < errors.size(); ++c)
      if (moved(batch.errors.values.col(static_cast<Index>(c)), transient.jump_of(errors[c].scale) / 2)) return true;
    return false;
  };
  const auto others_move = [&](bool is_error, std::size_t own, Index first, Index last) {
    return others_show(is_error, own, [&](const auto& column, double least) {
      return moves_between(column, first, last, 1.5 * least, limits);
    });
  };
  const auto others_leave = [&](bool is_error, std::size_t own, const Finding& one) {
    return others_show(is_error, own, [&](const auto& column, double least) {
      return leaves_its_course(column, one.first_row, one.last_row, std::max(least, limits.least_share * one.figure));
    });
  };
  for (const bool is_error : {false, true}) {
    std::vector<JudgedChannel>& channels = is_error ? errors : temperatures;
    const bool alone = temperatures.size() + errors.size() < 2;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      std::vector<Finding> kept;
      for (Finding& one : channels[c].transient) {
        const bool lasting = one.rule == FindingRule::jump && one.last_row == one.first_row + 1;
        const bool shown = lasting ? others_move(is_error, c, one.first_row, one.last_row)
                                   : one.last_row > one.first_row + 1 && one.first_row > 0 &&
                                         one.last_row + 1 < batch.rows() &&
                                         others_move(is_error, c, one.first_row - 1, one.first_row) &&
                                         others_move(is_error, c, one.last_row, one.last_row + 1);
        if (!shown) kept.push_back(std::move(one));
      }
      for (Finding& one : channels[c].slow) {
        const bool told = std::any_of(kept.begin(), kept.end(), [&](const Finding& other) {
          return other.first_row <= one.last_row && other.last_row >= one.first_row;
        });
        if (!alone && !told && !others_leave(is_error, c, one)) kept.push_back(std::move(one));
      }
      channels[c].transient = std::move(kept);
      channels[c].slow.clear();
    }
  }
}

}  // namespace thermfit
