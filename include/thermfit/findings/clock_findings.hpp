#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"

namespace thermfit {

/// When a clock is at fault. Chosen so that clocks of data loggers, which are late by a part of a step, stay silent.
struct ClockLimits {
  double gap_steps = 1.5;     ///< a gap is longer than so many usual steps, the step after it is no shorter for it …
  double gap_scatter = 10;    ///< … and longer than a usual step by so many standard deviations of the steps
  double other_step = 0.2;    ///< another step differs from that of most batches by this share of it
  std::size_t most_gaps = 8;  ///< more gaps in a batch are told as one finding that counts them
};

/// Time that repeats or goes back, and steps longer than the usual one (the median) and its scatter allow.
/// Nothing for a batch with fewer than three times. Allocates.
inline std::vector<Finding> clock_findings(const Batch& batch, const ClockLimits& limits = {}) {
  std::vector<Finding> back, gaps;
  const Series clock(batch.time_s);
  if (clock.size() <= 2) return {};  // one step has no usual one beside it
  std::vector<double> steps;
  for (std::size_t i = 1; i < clock.size(); ++i) steps.push_back(clock.values[i] - clock.values[i - 1]);
  const double usual = median(steps);
  std::vector<double> scatter;
  for (const double step : steps) scatter.push_back(std::abs(step - usual));
  const double limit = std::max(limits.gap_steps * usual, usual + limits.gap_scatter * median(scatter) / normal_median);
  const auto made_up = [&](std::size_t i) {  // a row written late, beside a step as much shorter
    const double next = i + 1 < steps.size() ? steps[i + 1] : usual, before = i > 0 ? steps[i - 1] : usual;
    return steps[i] + std::min(next, before) < (limits.gap_steps + 1) * usual;
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] <= 0)
      back.push_back(
          {FindingRule::time_back, "time", clock.rows[i + 1], clock.rows[i + 1], steps[i], 0, "s",
           steps[i] == 0 ? "stands still: a row written twice?" : "goes back: runs joined, or a clock set?"});
    else if (steps[i] > limit && usual > 0 && !made_up(i))
      gaps.push_back({FindingRule::time_gap, "time", clock.rows[i], clock.rows[i + 1], steps[i], limit, "s",
                      "rows are missing, the usual step is " + std::to_string(std::lround(usual)) + " s"});
  }
  if (gaps.size() > limits.most_gaps) {
    Finding all = gaps.front();
    all.last_row = gaps.back().last_row;
    for (const Finding& gap : gaps) all.figure = std::max(all.figure, gap.figure);
    all.note = std::to_string(gaps.size()) + " gaps, this is the longest step";
    gaps.assign(1, all);
  }
  back.insert(back.end(), gaps.begin(), gaps.end());
  return back;
}

/// The usual step of a batch's clock, s; 0 without one. Allocates.
inline double usual_step_s(const Batch& batch) {
  std::vector<double> steps;
  for (Index row = 1; row < batch.time_s.size(); ++row) steps.push_back(batch.time_s(row) - batch.time_s(row - 1));
  return steps.empty() ? 0 : median(std::move(steps));
}

/// That a batch has another usual step (`own`, s, beyond `limits.other_step` of it) than most of those of a campaign
/// (`all`); nothing where no more than half of them agree. Allocates.
inline std::optional<Finding> step_finding(double own, const std::vector<double>& all, const ClockLimits& limits = {}) {
  const double usual = median(all);
  const auto same = [&](double step) { return std::abs(step - usual) <= limits.other_step * usual; };
  if (all.size() < 3 || same(own) || 2 * std::count_if(all.begin(), all.end(), same) <= std::ptrdiff_t(all.size()))
    return std::nullopt;
  return Finding{FindingRule::step,
                 "time",
                 0,
                 0,
                 own,
                 usual,
                 "s",
                 "another time step than most batches: the unit of the clock, rows left out?"};
}

/// Cells of a channel (rows, any unit) that hold no finite number, as one finding that counts them; nothing where all
/// do. Allocates the finding.
inline std::optional<Finding> missing_finding(const Eigen::Ref<const Vector>& column, const std::string& name) {
  Index count = 0, first = 0, last = 0;
  for (Index row = 0; row < column.size(); ++row) {
    if (std::isfinite(column(row))) continue;
    if (count++ == 0) first = row;
    last = row;
  }
  if (count == 0) return std::nullopt;
  return Finding{
      FindingRule::missing,       name, first,    last,
      static_cast<double>(count), 0,    "values", "CsvOptions::missing = drop or hold decides what becomes of them"};
}

}  // namespace thermfit
