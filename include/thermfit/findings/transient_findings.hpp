#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/course.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/statistics/course_start.hpp"

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

/// Spikes and jumps of a series, in order of rows; `switching` holds rows in order.
///
/// A spike leaves the range of the two readings before and the two after, and its neighbours' second differences have
/// the opposite sign: a corner of the true course has not. Of what remains series_course() tells the readings that are
/// off, several in a row or alternate ones (spikes as well), from breaks (jumps). A break may follow a switch of an
/// input or rows that are missing; nothing excuses a spike. The first and last readings are off when they leave the
/// others by a step far larger than the next. A break that is taken back later is told once. `unit` is that of the
/// series. Allocates.
inline std::vector<Finding> transient_findings(const Series& series, const SeriesScale& scale,
                                               const std::vector<Index>& switching, const std::string& name,
                                               const std::string& unit, const TransientLimits& limits = {}) {
  const std::vector<double>& x = series.values;
  const double spike_limit = limits.spike_of(scale), jump_limit = limits.jump_of(scale);
  std::vector<Finding> findings;
  if (x.size() < 3) return findings;
  const auto explained = [&](std::size_t i, std::size_t before) {
    const Index row = series.rows[i];
    const auto at = std::upper_bound(switching.begin(), switching.end(), row);
    return series.rows[before] + static_cast<Index>(i - before) < row ||
           (at != switching.begin() && row <= *std::prev(at) + limits.settling_rows);
  };
  const auto spike = [&](std::size_t first, std::size_t last, double size, double limit, const char* note) {
    findings.push_back({FindingRule::spike, name, series.rows[first], series.rows[last], size, limit, unit, note});
  };
  std::vector<bool> off(x.size(), false);
  const auto bend = [&](std::size_t i) { return x[i] - (x[i - 1] + x[i + 1]) / 2; };
  const std::size_t last = x.size() - 1;
  for (std::size_t i = 1; x.size() > 4 && i < last; ++i) {
    const auto [low, high] =
        std::minmax({x[i < 2 ? i + 2 : i - 2], x[i - 1], x[i + 1], x[i + 2 > last ? i - 2 : i + 2]});
    const double beyond = std::max(x[i] - high, low - x[i]);
    if (beyond <= spike_limit * (1 + 1e-9)) continue;
    const double sign = x[i] > high ? 1 : -1, size = sign * bend(i), back = limits.corner_share * size;
    if ((i > 1 && -sign * bend(i - 1) < back) || (i + 1 < last && -sign * bend(i + 1) < back)) continue;
    off[i] = true;
    spike(i, i, beyond, spike_limit, "off the readings around it: contact, interference?");
  }
  for (const bool front : {true, false}) {  // at the ends a course has one side only
    const auto at = [&](std::size_t k) { return front ? k : last - k; };
    const auto step = [&](std::size_t k) { return std::abs(x[at(k)] - x[at(k - 1)]); };
    for (std::size_t bad = 1; bad <= limits.back_within_rows && bad + 8 < x.size(); ++bad) {
      if (off[at(bad)]) break;
      double largest = 0;
      for (std::size_t k = bad + 1; k <= bad + 7; ++k) largest = std::max(largest, step(k));
      if (step(bad) <= std::max(jump_limit, limits.edge_over_steps * largest) * (1 + 1e-9)) continue;
      if (front ? explained(bad, bad - 1) : explained(at(bad - 1), at(bad))) break;
      for (std::size_t k = 0; k < bad; ++k) off[at(k)] = true;
      spike(std::min(at(0), at(bad - 1)), std::max(at(0), at(bad - 1)), step(bad), jump_limit,
            front ? "the first readings are off those that follow: a default, a contact?"
                  : "the last readings are off those before: cut off, a contact?");
      break;
    }
  }
  std::vector<std::size_t> kept;
  std::vector<double> values;
  std::vector<Index> rows;
  for (std::size_t i = 0; i <= last; ++i)
    if (!off[i]) {
      kept.push_back(i);
      values.push_back(x[i]);
      rows.push_back(series.rows[i]);
    }
  const SeriesCourse course =
      series_course(values, rows, {jump_limit, limits.jump_over_steps, limits.back_within_rows},
                    [&](std::size_t from, std::size_t to) { return explained(kept[to], kept[from]); });
  std::vector<SeriesCourse::Break> breaks = course.breaks;
  for (std::size_t o = 0; o < course.off.size();) {
    std::size_t end = o + 1;
    while (end < course.off.size() && course.off[end] == course.off[end - 1] + 1) ++end;
    const std::size_t first = course.off[o], final = course.off[end - 1];
    o = end;
    // Readings off the course leave it and come back by a step; what only comes back is a course that broke there.
    const auto away = [&](std::size_t in, std::size_t out, std::size_t further) {
      return std::abs(values[in] - values[out] - (values[out] - values[further])) > jump_limit;
    };
    const auto alone =
        [&](const SeriesCourse::Break& at) {  // far larger than the steps around it, in whatever direction
          double largest = 0;
          for (std::size_t i = at.from < 2 ? 1 : at.from - 1; i <= std::min(at.to + 2, values.size() - 1); ++i)
            if (i != at.to) largest = std::max(largest, std::abs(values[i] - values[i - 1]));
          return std::abs(values[at.to] - values[at.from]) > limits.jump_over_steps * largest;
        };
    const bool leaves = first < 2 || away(first, first - 1, first - 2),
               returns = final + 2 >= values.size() || away(final, final + 1, final + 2);
    const SeriesCourse::Break broken =
        leaves ? SeriesCourse::Break{first - 1, first} : SeriesCourse::Break{final, final + 1};
    if (leaves != returns && alone(broken)) breaks.push_back(broken);
    if (!leaves || !returns) continue;
    double size = 0;
    for (std::size_t i = first; i <= final; ++i) {
      const double along =
          static_cast<double>(rows[i] - rows[first - 1]) / static_cast<double>(rows[final + 1] - rows[first - 1]);
      size = std::max(size, std::abs(values[i] - values[first - 1] - along * (values[final + 1] - values[first - 1])));
    }
    if (size > jump_limit)
      spike(kept[first], kept[final], size, jump_limit,
            first == final ? "off the readings around it: contact, interference?"
                           : "off the readings around them: contact, interference?");
  }
  std::sort(breaks.begin(), breaks.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    const auto size = [&](std::size_t b) { return values[breaks[b].to] - values[breaks[b].from]; };
    const std::size_t from = kept[breaks[k].from], to = kept[breaks[k].to];
    if (k + 1 < breaks.size() && size(k) * size(k + 1) < 0 &&
        std::abs(size(k) + size(k + 1)) < limits.back_share * std::abs(size(k))) {
      // One switch does not move a channel there and back.
      const std::size_t back = kept[breaks[k + 1].from];
      const auto first = std::lower_bound(switching.begin(), switching.end(), series.rows[to] - limits.settling_rows),
                 end = std::upper_bound(switching.begin(), switching.end(), series.rows[back] + 1);
      if (back - to < limits.back_within_rows && end - first == 1) {
        spike(to, back, std::abs(size(k)), jump_limit, "off the readings around them: contact, interference?");
        ++k;
        continue;
      }
    }
    if (explained(to, from)) continue;
    if (k + 1 < breaks.size() && size(k) * size(k + 1) < 0 &&
        std::abs(size(k) + size(k + 1)) < limits.back_share * std::abs(size(k))) {
      const std::size_t back = kept[breaks[k + 1].from];
      if (back - to < x.size() / 2 && !explained(kept[breaks[k + 1].to], back)) {
        findings.push_back({FindingRule::jump, name, series.rows[to], series.rows[back], std::abs(size(k)), jump_limit,
                            unit, "off by that, and back: a contact?"});
        ++k;
        continue;
      }
    }
    findings.push_back({FindingRule::jump, name, series.rows[from], series.rows[to], std::abs(size(k)), jump_limit,
                        unit, "a lasting step that no input explains: sensor moved, probe zeroed?"});
  }
  std::sort(findings.begin(), findings.end(),
            [](const Finding& a, const Finding& b) { return a.first_row < b.first_row; });
  std::vector<Finding> joined;  // spikes of rows that touch are one
  for (Finding& one : findings) {
    if (!joined.empty() && one.rule == FindingRule::spike && joined.back().rule == FindingRule::spike &&
        one.first_row <= joined.back().last_row + 1) {
      joined.back().last_row = std::max(joined.back().last_row, one.last_row);
      joined.back().figure = std::max(joined.back().figure, one.figure);
    } else {
      joined.push_back(std::move(one));
    }
  }
  return joined;
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
  const double trend = x[1] - course_taken_back(x), first = x[1] - x[0];
  const double off_K = std::abs(first - trend);
  return first * trend <= 0 && off_K > limits.jump_of(series_scale(series)) ? off_K : 0;
}

}  // namespace thermfit
