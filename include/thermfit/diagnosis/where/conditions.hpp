#pragma once

/// Under which conditions the gap arises: its square, split by input, ambient, phase and batch.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/statistics/held_levels.hpp"

namespace thermfit {

namespace detail {

/// Sums of squares of the gap by label, in order of first appearance.
class ShareTable {
 public:
  explicit ShareTable(std::vector<ConditionShare> rows)
      : rows_(std::move(rows)), squares_(rows_.size(), 0), samples_(rows_.size(), 0) {}

  void add(std::size_t row, double residual) {
    squares_[row] += residual * residual;
    ++samples_[row];
  }

  /// Appends every row that has samples to `result`.
  void append_to(std::vector<ConditionShare>& result) const {
    double square = 0, count = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) square += squares_[k], count += samples_[k];
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (samples_[k] == 0) continue;
      result.push_back(rows_[k]);
      result.back().share = square > 0 ? squares_[k] / square : 0;
      result.back().rms = std::sqrt(squares_[k] / samples_[k]);
      result.back().share_of_time = samples_[k] / count;
    }
  }

 private:
  std::vector<ConditionShare> rows_;
  std::vector<double> squares_, samples_;
};

/// Levels of a numeric factor: each of two values by itself, otherwise up to three ranges between quantiles of the
/// distinct values. Empty where the factor never changes.
inline std::vector<Interval> factor_levels(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<Interval> levels;
  if (values.size() < 2) return levels;
  const std::size_t count = std::min<std::size_t>(3, values.size());
  for (std::size_t k = 0; k < count; ++k)
    levels.push_back({values[k * values.size() / count], values[(k + 1) * values.size() / count - 1]});
  return levels;
}

inline std::size_t level_of(const std::vector<Interval>& levels, double value) {
  std::size_t k = 0;
  while (k + 1 < levels.size() && value > levels[k].high) ++k;
  return k;
}

/// One column of every batch, as a factor.
template <class Column>
void add_factor(const std::string& name, const Campaign& batches, const std::vector<Vector>& residuals, Column column,
                bool input, std::vector<ConditionShare>& result) {
  HeldLevels held;
  for (const Batch& batch : batches) count_held(held, column(batch));
  const bool settable = input && is_set(std::move(held));
  std::vector<double> values;
  for (const Batch& batch : batches)
    for (Index row = 0; row < batch.rows(); ++row) values.push_back(column(batch)(row));
  const std::vector<Interval> levels = factor_levels(values);
  if (levels.empty()) return;
  const bool on_off = levels.size() == 2 && levels[0].low == 0 && levels[0].high == 0;
  std::vector<ConditionShare> rows;
  for (std::size_t k = 0; k < levels.size(); ++k)
    rows.push_back({name, on_off ? (k ? "on" : "off") : "", !on_off, settable, levels[k], 0, 0, 0});
  ShareTable table(std::move(rows));
  for (std::size_t b = 0; b < batches.size(); ++b)
    for (Index row = 0; row < residuals[b].size(); ++row)
      table.add(level_of(levels, column(batches[b])(row)), residuals[b](row));
  table.append_to(result);
}

}  // namespace detail

/// Slopes below this share of the steepest count as steady.
constexpr double steady_share = .15;

/// What the mean temperature of a machine does.
enum class ThermalPhase {
  warm_up,   ///< rises
  steady,    ///< hardly changes
  cool_down  ///< falls
};

/// The phase of every sample by the slope of the mean temperature over about a twentieth of the batch; slopes below 15
/// % of the steepest count as steady. Without temperatures or time everything is steady.
template <typename Scalar = double>
std::vector<ThermalPhase> thermal_phases(const Batch& batch) {
  const Index rows = batch.rows(), half = std::max<Index>(1, rows / 40);
  std::vector<ThermalPhase> phases(static_cast<std::size_t>(rows), ThermalPhase::steady);
  if (!batch.has_time() || batch.temperatures.count() == 0 || rows < 3) return phases;
  const MatrixX<Scalar>& temperatures = batch.temperatures.values;
  const VectorX<Scalar> mean_degC = temperatures.rowwise().mean();
  VectorX<Scalar> slope(rows);
  for (Index row = 0; row < rows; ++row) {
    const Index first = std::max<Index>(0, row - half), last = std::min(rows - 1, row + half);
    slope(row) = (mean_degC(last) - mean_degC(first)) / (batch.time_s(last) - batch.time_s(first));
  }
  const double threshold = steady_share * slope.cwiseAbs().maxCoeff();
  for (Index row = 0; row < rows; ++row)
    if (std::abs(slope(row)) > threshold)
      phases[static_cast<std::size_t>(row)] = slope(row) > 0 ? ThermalPhase::warm_up : ThermalPhase::cool_down;
  return phases;
}

/// Shares of sum(residual^2) by input (on/off or up to three ranges), by ambient where `ambient_column` names a
/// temperature, by phase and by batch. `residuals[b]` belongs to `batches[b]`, one value a row; within a factor the
/// shares add up to one.
template <typename Scalar = double>
std::vector<ConditionShare> condition_shares(const Campaign& batches, const std::vector<Vector>& residuals,
                                             const std::string& ambient_column = {}) {
  std::vector<ConditionShare> result;
  if (batches.empty()) return result;
  for (Index i = 0; i < batches[0].inputs.count(); ++i)
    detail::add_factor(
        batches[0].inputs.names[static_cast<std::size_t>(i)], batches, residuals,
        [i](const Batch& batch) { return batch.inputs.values.col(i); }, true, result);
  const Index ambient = batches[0].temperatures.find(ambient_column);
  if (ambient >= 0)
    detail::add_factor(
        ambient_column, batches, residuals,
        [ambient](const Batch& batch) { return batch.temperatures.values.col(ambient); }, false, result);

  detail::ShareTable phases({{"phase", "warm-up", false, false, {}, 0, 0, 0},
                             {"phase", "steady", false, false, {}, 0, 0, 0},
                             {"phase", "cool-down", false, false, {}, 0, 0, 0}});
  std::vector<ConditionShare> names;
  for (const Batch& batch : batches) names.push_back({"batch", batch.name, false, false, {}, 0, 0, 0});
  detail::ShareTable per_batch(std::move(names));
  for (std::size_t b = 0; b < batches.size(); ++b) {
    const std::vector<ThermalPhase> phase = thermal_phases(batches[b]);
    for (Index row = 0; row < residuals[b].size(); ++row) {
      phases.add(static_cast<std::size_t>(phase[static_cast<std::size_t>(row)]), residuals[b](row));
      per_batch.add(b, residuals[b](row));
    }
  }
  phases.append_to(result);
  per_batch.append_to(result);
  return result;
}

}  // namespace thermfit
