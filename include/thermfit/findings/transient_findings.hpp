#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"

namespace thermfit {

/// When a reading is a spike or a jump. In multiples of the noise, so that normal noise of any size stays silent in
/// batches of 10 000s of rows; in steps of the resolution where rounding is coarser than the noise.
struct TransientLimits {
  double spike_noise = 8;      ///< a spike leaves the readings around it by so many standard deviations …
  double spike_steps = 5;      ///< … or steps of the resolution, where that is more
  double corner_share = 0.25;  ///< beside a spike the course bends back by this share of it; at a corner it does not
  double jump_noise = 12;      ///< a jump exceeds the local trend by so many standard deviations …
  double jump_steps = 6;       ///< … or steps of the resolution, where that is more
  double jump_over_steps = 4;  ///< … and is so many times as large as each of the steps around it
  double edge_over_steps = 8;  ///< the first or last reading is off when the step to it is so many times as large
  std::size_t back_within_rows = 5;  ///< a jump that is taken back within so many rows is a spike
  double back_share = 0.3;           ///< taken back: but for this share
  Index settling_rows = 2;           ///< so many rows after an input has switched may jump

  /// From where on a reading is a spike in a series of that scale, in its unit.
  double spike_of(const SeriesScale& scale) const {
    return std::max(spike_noise * scale.noise, spike_steps * scale.resolution);
  }
  /// From where on a step is a jump in it.
  double jump_of(const SeriesScale& scale) const {
    return std::max(jump_noise * scale.noise, jump_steps * scale.resolution);
  }
};

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

namespace detail {

/// Steps from one reading to the next that are no part of a smooth course: beyond the limit away from the steps around
/// and so many times as large as each of them, but for one that takes it back. Step i leads to reading i.
inline std::vector<std::size_t> abrupt_steps(const std::vector<double>& values, const TransientLimits& limits,
                                             double limit) {
  const double over_steps = limits.jump_over_steps;
  std::vector<std::size_t> found;
  const auto step = [&](std::size_t i) { return values[i] - values[i - 1]; };
  for (std::size_t i = 3; i + 2 < values.size(); ++i) {
    std::array<double, 4> around{step(i - 2), step(i - 1), step(i + 1), step(i + 2)};
    for (const std::size_t outer : {std::size_t{0}, std::size_t{3}})  // a spike of two rows: the step back is no trend
      if (around[outer] * step(i) < 0 && std::abs(around[outer] + step(i)) < limits.back_share * std::abs(step(i)))
        around[outer] = around[outer == 0 ? 1 : 2];
    std::sort(around.begin(), around.end());
    const double trend = (around[1] + around[2]) / 2, largest = std::max(std::abs(around[0]), std::abs(around[3]));
    if (std::abs(step(i) - trend) > limit && std::abs(step(i)) > over_steps * largest) found.push_back(i);
  }
  return found;
}

}  // namespace detail

/// Spikes and jumps of a series, in order of rows; `switching` holds rows in order.
///
/// A spike leaves the range of the two readings before and the two after, and its neighbours' second differences have
/// the opposite sign: a corner of the true course has not. A jump leaves the local trend and is larger than the steps
/// around it; a jump that is soon taken back is a spike too. Rows just after an input has switched may jump; nothing
/// excuses a spike. The first and last readings are off when they leave the others by a step far larger than the next.
/// `unit` is that of the series. Allocates.
inline std::vector<Finding> transient_findings(const Series& series, const SeriesScale& scale,
                                               const std::vector<Index>& switching, const std::string& name,
                                               const std::string& unit, const TransientLimits& limits = {}) {
  const std::vector<double>& x = series.values;
  const double spike_limit = limits.spike_of(scale), jump_limit = limits.jump_of(scale);
  std::vector<Finding> findings;
  const auto after_gap = [&](std::size_t i) { return series.rows[i] > series.rows[i - 1] + 1; };
  const auto explained = [&](std::size_t i) {
    const Index row = series.rows[i];
    const auto at = std::upper_bound(switching.begin(), switching.end(), row);
    return after_gap(i) || (at != switching.begin() && row <= *std::prev(at) + limits.settling_rows);
  };
  const auto bend = [&](std::size_t i) { return x[i] - (x[i - 1] + x[i + 1]) / 2; };
  std::vector<bool> spiked(x.size(), false);
  const std::size_t last = x.size() - 1;
  for (std::size_t i = 1; x.size() > 4 && i < last; ++i) {
    const auto [low, high] =
        std::minmax({x[i < 2 ? i + 2 : i - 2], x[i - 1], x[i + 1], x[i + 2 > last ? i - 2 : i + 2]});
    const double beyond = std::max(x[i] - high, low - x[i]);
    if (beyond <= spike_limit || after_gap(i)) continue;
    const double sign = x[i] > high ? 1 : -1, size = sign * bend(i), back = limits.corner_share * size;
    if ((i > 1 && -sign * bend(i - 1) < back) || (i + 1 < last && -sign * bend(i + 1) < back)) continue;
    spiked[i] = true;
    findings.push_back({FindingRule::spike, name, series.rows[i], series.rows[i], beyond, spike_limit, unit,
                        "off the readings around it: contact, interference?"});
  }
  const std::vector<std::size_t> steps = detail::abrupt_steps(x, limits, jump_limit);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const std::size_t i = steps[k];
    const double size = x[i] - x[i - 1];
    if (spiked[i] || spiked[i - 1]) continue;
    if (k + 1 < steps.size() && steps[k + 1] - i <= limits.back_within_rows) {
      const double back = x[steps[k + 1]] - x[steps[k + 1] - 1];
      if (size * back < 0 && std::abs(size + back) < limits.back_share * std::abs(size)) {
        findings.push_back({FindingRule::spike, name, series.rows[i], series.rows[steps[k + 1] - 1], std::abs(size),
                            jump_limit, unit, "off the readings around them: contact, interference?"});
        ++k;
        continue;
      }
    }
    if (!explained(i))
      findings.push_back({FindingRule::jump, name, series.rows[i - 1], series.rows[i], std::abs(size), jump_limit, unit,
                          "a lasting step that no input explains: sensor moved, probe zeroed?"});
  }
  const auto edge = [&](std::size_t i, auto step) {  // step(k): from the reading at the edge inwards
    double largest = 0;
    for (int k = 2; k <= 8; ++k) largest = std::max(largest, std::abs(step(k)));
    if (std::abs(step(1)) > std::max(jump_limit, limits.edge_over_steps * largest))
      findings.push_back({FindingRule::spike, name, series.rows[i], series.rows[i], std::abs(step(1)), jump_limit, unit,
                          i == 0 ? "the first reading is off those that follow: a default, a contact?"
                                 : "the last reading is off those before: cut off, a contact?"});
  };
  if (x.size() > 9 && !spiked[1] && !explained(1))
    edge(0, [&](int k) { return x[std::size_t(k)] - x[std::size_t(k) - 1]; });
  if (x.size() > 9 && !spiked[last - 1] && !explained(last))
    edge(last, [&](int k) { return x[last - std::size_t(k)] - x[last - std::size_t(k) + 1]; });
  std::sort(findings.begin(), findings.end(),
            [](const Finding& a, const Finding& b) { return a.first_row < b.first_row; });
  return findings;
}

/// How far the first reading of a temperature is off those that follow, K; 0 where it is not, or may be a start: what a
/// user of rises should hear, since every rise of the batch counts from it. No fault by itself: a machine that was not
/// at rest may begin so.
///
/// It leaves the course of the next four readings, taken back by the median of their steps, by more than a jump does,
/// and gets to them by a step that is not along their course.
inline double first_reading_off_K(const Series& series, const TransientLimits& limits = {}) {
  const std::vector<double>& x = series.values;
  if (x.size() < 5 || series.rows[4] != 4) return 0;
  std::array<double, 3> steps{x[2] - x[1], x[3] - x[2], x[4] - x[3]};
  std::sort(steps.begin(), steps.end());
  const double trend = steps[1], first = x[1] - x[0];
  const double off_K = std::abs(first - trend);
  return first * trend <= 0 && off_K > limits.jump_of(series_scale(series)) ? off_K : 0;
}

}  // namespace thermfit
