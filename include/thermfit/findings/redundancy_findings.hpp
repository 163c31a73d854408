#pragma once

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"

namespace thermfit {

/// When a temperature is redundant. Independent readings differ by what rounding leaves, a copy by nothing: a quarter
/// lies between with room on both sides.
struct RedundancyLimits {
  double of_rounding = 0.25;  ///< what is left of a copy, over what rounding alone leaves between independent readings
  double moved_steps = 8;     ///< a channel that moved by fewer steps of its resolution tells nothing
  Index rows_beside = 12;     ///< rows that there must be beyond the columns a channel is compared with
};

/// Temperatures that earlier ones give, as a straight line of one or a linear combination of all, to less than
/// `of_rounding` of what rounding alone leaves between independent readings: sqrt(sum (b_i r_i)^2 / 12) with
/// resolutions r_i. Each such channel is told once. Ordinary collinearity of thermometers is no fault. A batch with a
/// missing temperature tells nothing. Allocates.
template <typename Scalar = double>
std::vector<Finding> redundancy_findings(const Batch& batch, const RedundancyLimits& limits = {}) {
  std::vector<Finding> findings;
  const MatrixX<Scalar>& values = batch.temperatures.values;
  if (!values.allFinite()) return findings;
  const Index rows = values.rows();
  std::vector<Index> used;
  std::vector<double> resolutions;
  const MatrixX<Scalar> centred = values.rowwise() - values.colwise().mean();
  const MatrixX<Scalar> products = centred.transpose() * centred;
  // The same as `ratio` from products, which are dear once only; sure where it is far from the limit and from rounding.
  const auto far_from_redundant = [&](Index column, double resolution, const std::vector<std::size_t>& chosen) {
    const auto count = static_cast<Index>(chosen.size());
    MatrixX<Scalar> normal(count, count);
    VectorX<Scalar> target(count);
    for (Index i = 0; i < count; ++i) {
      const Index a = used[chosen[static_cast<std::size_t>(i)]];
      target(i) = products(a, column);
      for (Index j = 0; j < count; ++j) normal(i, j) = products(a, used[chosen[static_cast<std::size_t>(j)]]);
    }
    const VectorX<Scalar> weights = normal.ldlt().solve(target);
    double floor = resolution * resolution;
    for (Index i = 0; i < count; ++i)
      floor += std::pow(weights(i) * resolutions[chosen[static_cast<std::size_t>(i)]], 2);
    const double left = products(column, column) - weights.dot(target);
    return left > 1e-8 * products(column, column) &&
           left / static_cast<double>(rows - count - 1) > std::pow(2 * limits.of_rounding, 2) * floor / 12;
  };
  // How far `column` is from what `columns` give: residual scatter over rounding floor.
  const auto ratio = [&](Index column, double resolution, const std::vector<std::size_t>& chosen) {
    if (far_from_redundant(column, resolution, chosen)) return HUGE_VAL;
    const auto count = static_cast<Index>(chosen.size());
    MatrixX<Scalar> design(rows, count + 1);
    design.col(0).setOnes();
    for (Index i = 0; i < count; ++i) design.col(i + 1) = values.col(used[chosen[static_cast<std::size_t>(i)]]);
    const VectorX<Scalar> weights = design.colPivHouseholderQr().solve(values.col(column));
    double floor = resolution * resolution;
    for (Index i = 0; i < count; ++i)
      floor += std::pow(weights(i + 1) * resolutions[chosen[static_cast<std::size_t>(i)]], 2);
    const double scatter =
        (values.col(column) - design * weights).squaredNorm() / static_cast<double>(rows - count - 1);
    return std::sqrt(scatter / (floor / 12));
  };
  for (Index c = 0; c < values.cols(); ++c) {
    const SeriesScale scale = series_scale(Series(values.col(c)));
    if (scale.range() < limits.moved_steps * scale.resolution || scale.range() == 0) continue;
    const std::string& name = batch.temperatures.names[static_cast<std::size_t>(c)];
    const auto add = [&](double figure, const std::string& note) {
      findings.push_back({FindingRule::collinear, name, 0, rows - 1, figure, limits.of_rounding, "of rounding", note});
    };
    bool redundant = false;
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < used.size() && !redundant && rows >= limits.rows_beside; ++i) {
      all.push_back(i);
      const double figure = ratio(c, scale.resolution, {i});
      redundant = figure < limits.of_rounding;
      if (redundant)
        add(figure, "the same as " + batch.temperatures.names[static_cast<std::size_t>(used[i])] + ": a copy?");
    }
    if (!redundant && all.size() > 1 && rows >= static_cast<Index>(all.size()) + limits.rows_beside) {
      const double figure = ratio(c, scale.resolution, all);
      redundant = figure < limits.of_rounding;
      if (redundant) add(figure, "a combination of the points before it: computed?");
    }
    if (redundant) continue;
    used.push_back(c);
    resolutions.push_back(scale.resolution);
  }
  return findings;
}

}  // namespace thermfit
