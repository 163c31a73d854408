#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/climate.hpp"
#include "thermfit/batch/error_reference.hpp"
#include "thermfit/batch/known_inputs.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/features/lag.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/moments/moments.hpp"

namespace thermfit {

/// What the method `transfer` is given beside the points: known inputs, and differences of two points.
struct TransferExtras {
  std::vector<std::string> inputs;                   ///< columns of Batch::inputs
  std::vector<std::pair<Index, Index>> differences;  ///< of points: the rise of the first less that of the second
};

/// One batch as the method `transfer` sees it: mean products about zero of (rises, lagged rises, changes of the inputs,
/// lagged inputs, differences, 1, errors) for every lag that may be chosen, and its climate.
template <typename Scalar = double>
struct TransferBatch {
  Index rows = 0;           ///< it has
  Index points = 0;         ///< temperatures
  bool has_lag = false;     ///< whether there are lagged rises and inputs
  Scalar climate_degC = 0;  ///< mean temperature of its points at its start
  std::vector<MatrixX<Scalar>>
      products;           ///< per lag, divided by rows; one without lagged columns where there is no lag
  Index inputs = 0;       ///< known inputs
  Index differences = 0;  ///< of two points

  /// Everything but errors, which come behind: the last is the constant.
  Index columns() const { return first_difference() + differences + 1; }
  /// Column of the first input's change.
  Index first_input() const { return (has_lag ? 2 : 1) * points; }
  /// Column of the first difference.
  Index first_difference() const { return first_input() + (has_lag ? 2 : 1) * inputs; }
};

/// Lags that batches can tell, in steps of about the root of two (10, 14, 20, 28 min …), from four sampling intervals,
/// below which a lagged rise is the rise of a few rows ago, to a third of the duration, within which it settles (both
/// of the median batch). None where a batch has no clock. Allocates.
inline std::vector<double> visible_lags_min(const Campaign& campaign) {
  std::vector<double> steps, durations;
  for (const Batch& batch : campaign) {
    if (!batch.has_time()) return {};
    if (batch.rows() < 2) continue;
    durations.push_back((batch.time_s(batch.rows() - 1) - batch.time_s(0)) / 60);
    steps.push_back(durations.back() / static_cast<double>(batch.rows() - 1));
  }
  if (steps.empty()) return {};
  const auto median = [](std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
  };
  constexpr double intervals = 4, settled = 3;  // exp(-3): 5 % are left
  const double shortest = intervals * median(steps), longest = median(durations) / settled;
  std::vector<double> lags;
  for (int power = -20; power <= 20; ++power) {
    for (const double lag : {std::ldexp(10, power), std::ldexp(14, power)})
      if (lag >= shortest && lag <= longest) lags.push_back(lag);
  }
  return lags;
}

/// A batch through the temperature columns `points`, errors as `reference` counts them (referenced()); with
/// ErrorReference::batch all columns are taken about their means, so that the batch has an intercept of its own. Rows
/// without a reading of every error are seen by the lags, not by the products. Values that are not finite, and a known
/// input that is not there: Error. One pass a lag; allocates.
template <typename Scalar = double>
TransferBatch<Scalar> transfer_batch(const Batch& batch, const std::vector<Index>& points,
                                     const std::vector<double>& lags_min,
                                     ErrorReference reference = ErrorReference::recorded,
                                     const TransferExtras& extras = {}) {
  TransferBatch<Scalar> result;
  const Batch counted = referenced<Lazy<double, Scalar>>(batch, reference);
  const MatrixX<Scalar> rises = model_temperatures<Scalar>(counted, TemperatureReference::rise)(Eigen::all, points);
  std::vector<Index> measured;
  for (Index row = 0; row < counted.rows(); ++row)
    if (detail::lazy<Scalar>(counted.errors.values).row(row).allFinite()) measured.push_back(row);
  const MatrixX<Scalar> errors =
      detail::lazy<Scalar>(counted.errors.values)(measured, Eigen::all).template cast<Scalar>();
  const Index p = rises.cols(), q = errors.cols();
  result.rows = errors.rows();
  result.points = p;
  result.has_lag = !lags_min.empty();
  result.inputs = static_cast<Index>(extras.inputs.size());
  result.differences = static_cast<Index>(extras.differences.size());
  const MatrixX<Scalar> inputs = known_inputs<Scalar>(batch, extras.inputs);
  result.climate_degC = static_cast<Scalar>(climate_degC(counted, points));
  const auto add = [&](const MatrixX<Scalar>& columns) {
    const Moments<Scalar> moments(MatrixX<Scalar>(columns(measured, Eigen::all)), errors);
    const Index c = columns.cols();
    MatrixX<Scalar> products = MatrixX<Scalar>::Zero(c + 1 + q, c + 1 + q);
    const Scalar rows = static_cast<Scalar>(std::max<Index>(1, moments.rows()));
    products.topLeftCorner(c, c) = moments.temperature_products() / rows;
    products.topRightCorner(c, q) = moments.cross_products() / rows;
    products.bottomLeftCorner(q, c) = moments.cross_products().transpose() / rows;
    products.bottomRightCorner(q, q) = moments.error_products() / rows;
    VectorX<Scalar> mean(c + 1 + q);
    mean << moments.temperature_mean(), Scalar(1), moments.error_mean();
    if (reference != ErrorReference::batch) products += mean * mean.transpose();
    result.products.push_back(std::move(products));
  };
  MatrixX<Scalar> columns(rises.rows(), result.columns() - 1);
  columns.leftCols(p) = rises;
  const Index k = result.inputs, first = result.first_input();
  for (Index i = 0; i < k && rises.rows() > 0; ++i) columns.col(first + i) = inputs.col(i).array() - inputs(0, i);
  for (Index d = 0; d < result.differences; ++d) {
    const auto& [one, other] = extras.differences[static_cast<std::size_t>(d)];
    columns.col(result.first_difference() + d) = rises.col(one) - rises.col(other);
  }
  if (lags_min.empty()) add(columns);
  for (const double lag : lags_min) {
    const VectorX<Scalar> time_s = detail::lazy<Scalar>(batch.time_s).template cast<Scalar>();
    columns.middleCols(p, p) = lagged(rises, time_s, static_cast<Scalar>(60 * lag));
    columns.middleCols(first + k, k) = lagged(inputs, time_s, static_cast<Scalar>(60 * lag));
    add(columns);
  }
  return result;
}

}  // namespace thermfit
