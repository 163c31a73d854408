#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"

namespace thermfit {

namespace detail {

/// Readings first … last of a series that are all the same.
struct EqualRun {
  std::size_t first, last;
  std::size_t length() const { return last - first + 1; }
};

inline std::vector<EqualRun> equal_runs(const std::vector<double>& values) {
  std::vector<EqualRun> runs;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0 || values[i] != values[i - 1])
      runs.push_back({i, i});
    else
      runs.back().last = i;
  }
  return runs;
}

/// Each column as the running median of five rows: a course without spikes of one or two.
template <typename Scalar>
MatrixX<Scalar> despiked(const MatrixX<Scalar>& values) {
  MatrixX<Scalar> smooth = values;
  for (Index column = 0; column < values.cols(); ++column)
    for (Index row = 2; row + 2 < values.rows(); ++row) {
      if (!values.col(column).segment(row - 2, 5).allFinite()) continue;
      std::array<Scalar, 5> window;
      std::copy_n(values.col(column).data() + row - 2, 5, window.begin());
      std::nth_element(window.begin(), window.begin() + 2, window.end());
      smooth(row, column) = window[2];
    }
  return smooth;
}

/// How far the other temperatures say that a channel moved within rows first … last: least squares outside these rows
/// (a little ridge, since thermometers are collinear), used inside. Range of the prediction and residual scatter. Where
/// the rows outside are too few for all, the mean of the others stands for them.
struct ExpectedMove {
  double range = 0, scatter = 0;
};

template <typename Scalar>
std::optional<ExpectedMove> expected_move(MatrixX<Scalar> others, const Eigen::Ref<const VectorX<Scalar>>& channel,
                                          Index first, Index last) {
  std::vector<Index> outside;
  for (Index row = 0; row < channel.size(); ++row)
    if ((row < first || row > last) && std::isfinite(channel(row)) && others.row(row).allFinite())
      outside.push_back(row);
  const Index count = static_cast<Index>(outside.size());
  if (others.cols() == 0 || count < 8) return std::nullopt;
  if (count < others.cols() + 8) others = others.rowwise().mean().eval();
  const Index columns = others.cols();
  MatrixX<Scalar> design(count, columns);
  VectorX<Scalar> target(count);
  for (Index i = 0; i < count; ++i) {
    design.row(i) = others.row(outside[static_cast<std::size_t>(i)]);
    target(i) = channel(outside[static_cast<std::size_t>(i)]);
  }
  const Eigen::Matrix<Scalar, 1, Eigen::Dynamic> means = design.colwise().mean();
  design.rowwise() -= means;
  target.array() -= target.mean();
  MatrixX<Scalar> normal = design.transpose() * design;
  normal.diagonal().array() += 1e-4 * normal.trace() / static_cast<double>(columns) + 1e-30;
  const VectorX<Scalar> weights = normal.ldlt().solve(design.transpose() * target);
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (Index row = first; row <= last; ++row) {
    if (!others.row(row).allFinite()) continue;
    const double predicted = (others.row(row) - means).dot(weights);
    low = std::min(low, predicted);
    high = std::max(high, predicted);
  }
  if (low > high) return std::nullopt;
  return ExpectedMove{high - low,
                      std::sqrt((target - design * weights).squaredNorm() / static_cast<double>(count - columns))};
}

template <typename Scalar>
MatrixX<Scalar> without_column(const MatrixX<Scalar>& matrix, Index column) {
  MatrixX<Scalar> others(matrix.rows(), matrix.cols() - 1);
  others.leftCols(column) = matrix.leftCols(column);
  others.rightCols(others.cols() - column) = matrix.rightCols(others.cols() - column);
  return others;
}

}  // namespace detail

/// The longest run of one value that cannot be what it seems, or nothing. `temperatures` are those of the batch,
/// despiked.
///
/// A run of five rows or more is suspicious when the other temperatures say that the channel moved by more than four
/// steps of its resolution and six times the scatter of that prediction; a run of eight or more also when the channel's
/// own noise makes it improbable (less than one in a million in the whole batch); a run of ten or more at the end of a
/// thermal error's range also when it is reached by a step of more than five times the resolution. The three longest
/// runs are judged; one at the start of the batch from ten rows on, since a point far from the heat begins late.
/// `column` counts within the temperatures or, where `is_error`, the thermal errors; `series` and `scale` are those of
/// that channel. Allocates.
template <typename Scalar>
std::optional<Finding> frozen_finding(const Batch& batch, const MatrixX<Scalar>& temperatures, Index column,
                                      bool is_error, const Series& series, const SeriesScale& scale) {
  const Channels& channels = is_error ? batch.errors : batch.temperatures;
  const std::string unit = is_error ? "um" : "K";
  std::vector<detail::EqualRun> runs = detail::equal_runs(series.values);
  std::stable_sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.length() > b.length(); });
  if (runs.size() > 3) runs.resize(3);
  // Two normal readings fall on the same step of the resolution with probability resolution / (2 sqrt(pi) noise).
  const double same = scale.noise > 0 ? std::min(1.0, scale.resolution / (2 * std::sqrt(M_PI) * scale.noise)) : 1;
  for (const detail::EqualRun& run : runs) {
    if (run.length() < 5) break;
    if (run.first == 0 && run.length() < 10) continue;
    const Index first = series.rows[run.first], last = series.rows[run.last];
    const bool improbable = run.length() >= 8 && static_cast<double>(run.length() - 1) * std::log(same) <
                                                     std::log(1e-6 / static_cast<double>(series.size()));
    const auto move =
        detail::expected_move<Scalar>(is_error ? temperatures : detail::without_column(temperatures, column),
                                      channels.values.col(column), first, last);
    const double limit = move ? std::max(4 * scale.resolution, 6 * move->scatter) : 0;
    const bool moved = move && move->range > limit;
    const double value = series.values[run.first];
    const bool at_end = value == scale.highest || value == scale.lowest;
    const double arrival = run.first > 0 ? std::abs(value - series.values[run.first - 1]) : 0;
    const bool clipped = is_error && at_end && run.length() >= 10 && arrival > 5 * scale.resolution;
    if (!improbable && !moved && !clipped) continue;
    const FindingRule rule = is_error && at_end ? FindingRule::saturated : FindingRule::stuck;
    const std::string rows = std::to_string(run.length()) + " rows of one value";
    const std::string& name = channels.names[static_cast<std::size_t>(column)];
    if (moved)
      return Finding{rule, name, first, last, move->range, limit, unit, rows + "; by the other points it moved"};
    if (clipped)
      return Finding{rule, name, first, last, arrival, 5 * scale.resolution, unit, rows + ", reached in full motion"};
    return Finding{rule, name, first, last, 0, scale.noise, unit, rows + "; its noise elsewhere rules that out"};
  }
  return std::nullopt;
}

/// A thermal error that changes only every m-th row, m from 2 to 60: at least six changes and half of those possible,
/// 19 of 20 of them in step. Nothing for any other. Allocates.
inline std::optional<Finding> stale_finding(const Series& series, const std::string& name) {
  const std::vector<detail::EqualRun> runs = detail::equal_runs(series.values);
  for (std::size_t every = 60; every >= 2; --every) {
    if (runs.size() < 7 || 2 * runs.size() * every < series.size()) continue;
    std::vector<std::size_t> in_step(every, 0);
    for (std::size_t r = 1; r < runs.size(); ++r) ++in_step[runs[r].first % every];
    if (20 * *std::max_element(in_step.begin(), in_step.end()) < 19 * (runs.size() - 1)) continue;
    return Finding{FindingRule::stale,
                   name,
                   series.rows.front(),
                   series.rows.back(),
                   static_cast<double>(every),
                   1,
                   "rows",
                   "new only every " + std::to_string(every) + " rows: read less often than written"};
  }
  return std::nullopt;
}

}  // namespace thermfit
