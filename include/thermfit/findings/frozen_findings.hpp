#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/constants.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"

namespace thermfit {

/// When a run of one value cannot be what it seems. Lengths are in rows: short runs of a coarse or slow thermometer are
/// ordinary, and a point far from the heat begins late.
struct FrozenLimits {
  std::size_t judged_runs = 3;  ///< the longest runs of a channel, so many, are judged
  std::size_t moved_rows =
      5;                   ///< a run so long is suspicious where the other temperatures say that the channel moved …
  double moved_steps = 4;  ///< … by more steps of its resolution than this …
  double moved_scatter = 6;         ///< … and more standard deviations of that prediction
  std::size_t improbable_rows = 8;  ///< one so long, where the channel's own noise makes it improbable:
  double improbable = 1e-6;         ///< to happen by chance in the whole batch
  std::size_t clipped_rows =
      10;                    ///< one so long at the end of a thermal error's range, where it is reached by a step …
  double clipped_steps = 5;  ///< … of more steps of the resolution than this
  std::size_t first_rows = 10;  ///< at the start of a batch shorter runs are not judged
};

/// When a thermal error is read less often than it is written down.
struct StaleLimits {
  std::size_t slowest_rows = 60;   ///< longest period that is looked for
  std::size_t fewest_changes = 6;  ///< changes there must be, and half of those possible
  std::size_t in_step = 19;        ///< so many of `of` changes are in step
  std::size_t of = 20;             ///< see `in_step`
};

namespace detail {

/// Rows that a prediction needs beyond its columns, and the ridge it takes as a share of the mean variance.
constexpr Index rows_beside_prediction = 8;
constexpr double prediction_ridge = 1e-4;

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

/// Temperatures of a batch (despiked) about their means, and their products, so that a regression that leaves a few
/// rows out need not visit the others. Only where every number is there.
template <typename Scalar>
struct RowSums {
  MatrixX<Scalar> values, products;
};

template <typename Scalar>
std::optional<RowSums<Scalar>> row_sums(const MatrixX<Scalar>& temperatures) {
  if (temperatures.rows() == 0 || temperatures.cols() == 0 || !temperatures.allFinite()) return std::nullopt;
  RowSums<Scalar> sums{temperatures.rowwise() - temperatures.colwise().mean(), {}};
  sums.products = sums.values.transpose() * sums.values;
  return sums;
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
  if (others.cols() == 0 || count < rows_beside_prediction) return std::nullopt;
  if (count < others.cols() + rows_beside_prediction) others = others.rowwise().mean().eval();
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
  normal.diagonal().array() += prediction_ridge * normal.trace() / static_cast<double>(columns) + 1e-30;
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

/// The same from sums: `channel` is a temperature, `own` its column, or an error (`own` -1).
template <typename Scalar>
std::optional<ExpectedMove> expected_move(const RowSums<Scalar>& sums, const Eigen::Ref<const VectorX<Scalar>>& channel,
                                          Index own, Index first, Index last) {
  std::vector<Index> others;
  for (Index c = 0; c < sums.values.cols(); ++c)
    if (c != own) others.push_back(c);
  const auto columns = static_cast<Index>(others.size());
  const Index length = last - first + 1, count = sums.values.rows() - length;
  if (columns == 0 || count < columns + rows_beside_prediction || !channel.allFinite()) return std::nullopt;
  const VectorX<Scalar> centred = channel.array() - channel.mean();
  const MatrixX<Scalar> inside = sums.values.middleRows(first, length);
  const VectorX<Scalar> inside_own = centred.segment(first, length);
  const VectorX<Scalar> sum = inside.colwise().sum();  // all sum to nothing, so those outside sum to minus that
  const VectorX<Scalar> all = sums.values.transpose() * centred;
  const Scalar sum_own = inside_own.sum(), rows = static_cast<Scalar>(count);
  MatrixX<Scalar> normal(columns, columns), moved(length, columns);
  VectorX<Scalar> target(columns);
  for (Index i = 0; i < columns; ++i) {
    const Index a = others[static_cast<std::size_t>(i)];
    target(i) = all(a) - inside.col(a).dot(inside_own) - sum(a) * sum_own / rows;
    moved.col(i) = inside.col(a);
    for (Index j = 0; j <= i; ++j) {
      const Index b = others[static_cast<std::size_t>(j)];
      normal(i, j) = normal(j, i) = sums.products(a, b) - inside.col(a).dot(inside.col(b)) - sum(a) * sum(b) / rows;
    }
  }
  const MatrixX<Scalar> plain = normal;
  normal.diagonal().array() += prediction_ridge * normal.trace() / static_cast<double>(columns) + 1e-30;
  const VectorX<Scalar> weights = normal.ldlt().solve(target);
  const VectorX<Scalar> predicted = moved * weights;
  const double own_left = centred.squaredNorm() - inside_own.squaredNorm() - sum_own * sum_own / rows;
  const double left = own_left - 2 * weights.dot(target) + weights.dot(plain * weights);
  return ExpectedMove{predicted.maxCoeff() - predicted.minCoeff(),
                      std::sqrt(std::max(left, 0.0) / static_cast<double>(count - columns))};
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
/// A run is suspicious when the other temperatures say that the channel moved, when the channel's own noise makes it
/// improbable, and, at the end of a thermal error's range, when it is reached in full motion.
/// `column` counts within the temperatures or, where `is_error`, the thermal errors; `series` and `scale` are those of
/// that channel; `sums`, where given, are those of the batch, and spare the visit of all rows. Allocates.
template <typename Scalar>
std::optional<Finding> frozen_finding(const Batch& batch, const MatrixX<Scalar>& temperatures, Index column,
                                      bool is_error, const Series& series, const SeriesScale& scale,
                                      const FrozenLimits& limits = {},
                                      const std::optional<detail::RowSums<Scalar>>& sums = std::nullopt) {
  const Channels& channels = is_error ? batch.errors : batch.temperatures;
  const std::string unit = is_error ? "um" : "K";
  std::vector<detail::EqualRun> runs = detail::equal_runs(series.values);
  std::stable_sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.length() > b.length(); });
  if (runs.size() > limits.judged_runs) runs.resize(limits.judged_runs);
  // Two normal readings fall on the same step of the resolution with probability resolution / (2 sqrt(pi) noise).
  const double same = scale.noise > 0 ? std::min(1.0, scale.resolution / (2 * std::sqrt(pi) * scale.noise)) : 1;
  for (const detail::EqualRun& run : runs) {
    if (run.length() < limits.moved_rows) break;
    if (run.first == 0 && run.length() < limits.first_rows) continue;
    const Index first = series.rows[run.first], last = series.rows[run.last];
    const bool improbable =
        run.length() >= limits.improbable_rows && static_cast<double>(run.length() - 1) * std::log(same) <
                                                      std::log(limits.improbable / static_cast<double>(series.size()));
    std::optional<detail::ExpectedMove> move;
    if (sums)
      move = detail::expected_move<Scalar>(*sums, channels.values.col(column), is_error ? -1 : column, first, last);
    if (!move)
      move = detail::expected_move<Scalar>(is_error ? temperatures : detail::without_column(temperatures, column),
                                           channels.values.col(column), first, last);
    const double limit =
        move ? std::max(limits.moved_steps * scale.resolution, limits.moved_scatter * move->scatter) : 0;
    const bool moved = move && move->range > limit;
    const double value = series.values[run.first];
    const bool at_end = value == scale.highest || value == scale.lowest;
    const double arrival = run.first > 0 ? std::abs(value - series.values[run.first - 1]) : 0;
    const bool clipped =
        is_error && at_end && run.length() >= limits.clipped_rows && arrival > limits.clipped_steps * scale.resolution;
    if (!improbable && !moved && !clipped) continue;
    const FindingRule rule = is_error && at_end ? FindingRule::saturated : FindingRule::stuck;
    const std::string rows = std::to_string(run.length()) + " rows of one value";
    const std::string& name = channels.names[static_cast<std::size_t>(column)];
    if (moved)
      return Finding{rule, name, first, last, move->range, limit, unit, rows + "; by the other points it moved"};
    if (clipped)
      return Finding{rule,    name,
                     first,   last,
                     arrival, limits.clipped_steps * scale.resolution,
                     unit,    rows + ", reached in full motion"};
    return Finding{rule, name, first, last, 0, scale.noise, unit, rows + "; its noise elsewhere rules that out"};
  }
  return std::nullopt;
}

/// A thermal error that changes only every m-th row, m from 2 on: enough changes, and nearly all of them in step.
/// Nothing for any other. Allocates.
inline std::optional<Finding> stale_finding(const Series& series, const std::string& name,
                                            const StaleLimits& limits = {}) {
  const std::vector<detail::EqualRun> runs = detail::equal_runs(series.values);
  for (std::size_t every = limits.slowest_rows; every >= 2; --every) {
    if (runs.size() <= limits.fewest_changes || 2 * runs.size() * every < series.size()) continue;
    std::vector<std::size_t> in_step(every, 0);
    for (std::size_t r = 1; r < runs.size(); ++r) ++in_step[runs[r].first % every];
    if (limits.of * *std::max_element(in_step.begin(), in_step.end()) < limits.in_step * (runs.size() - 1)) continue;
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
