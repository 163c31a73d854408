#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/error.hpp"
#include "thermfit/statistics/reading_step.hpp"
#include "thermfit/statistics/white_noise.hpp"

namespace thermfit {

/// How each sensor behaved while it was known to work: what a guard on the controller judges new readings by.
///
/// One entry per sensor in every member; all empty when unknown, rates and still times also where no batch has a clock.
struct SensorEnvelope {
  Vector lowest_degC;             ///< absolute readings, also for models on temperature rise
  Vector highest_degC;            ///< absolute readings, also for models on temperature rise
  Vector largest_rate_K_per_min;  ///< between neighbouring samples
  Vector longest_still_min;       ///< longest time without any change of the reading
  Vector first_lowest_degC;       ///< absolute readings at the beginning of a batch: median of up to five
  Vector first_highest_degC;      ///< the same
  Vector scatter_K;  ///< readings of a machine at rest lie within this of each other: 6 sigma of noise, 2 steps

  /// Whether lowest and highest are known.
  bool has_range() const { return lowest_degC.size() > 0; }
  /// Whether rates and still times are known.
  bool has_rates() const { return largest_rate_K_per_min.size() > 0; }
  /// Whether beginnings and scatter are known.
  bool has_starts() const { return first_lowest_degC.size() > 0; }
};

namespace detail {

/// Where a series begins: the median of its first five values, so that one bad reading is no beginning.
inline double first_reading(const Vector& series) {
  Vector first = series.head(std::min<Index>(5, series.size()));
  std::nth_element(first.data(), first.data() + first.size() / 2, first.data() + first.size());
  return first(first.size() / 2);
}

}  // namespace detail

/// The envelope of the sensors `names` over all rows of `campaign`, in the order of `names`.
/// Throws Error on a name that a batch lacks. A campaign without rows gives an empty envelope. Allocates the result.
template <typename Scalar = double>
SensorEnvelope sensor_envelope(const Campaign& campaign, const std::vector<std::string>& names) {
  SensorEnvelope envelope;
  const auto start_at_zero = [&](Vector& figure) {
    if (figure.size() == 0) figure = VectorX<Scalar>::Zero(static_cast<Index>(names.size())).template cast<double>();
  };
  std::vector<SeriesByBatch> series(names.size());
  for (const Batch& batch : campaign) {
    if (batch.rows() == 0) continue;
    const bool first_batch = !envelope.has_range();
    start_at_zero(envelope.lowest_degC);
    start_at_zero(envelope.highest_degC);
    start_at_zero(envelope.first_lowest_degC);
    start_at_zero(envelope.first_highest_degC);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Index column = batch.temperatures.find(names[i]);
      if (column < 0) throw Error(batch.name, "no temperature '" + names[i] + "'");
      const auto sensor = static_cast<Index>(i);
      const auto readings = detail::lazy<Scalar>(batch.temperatures.values).col(column);
      double& lowest = envelope.lowest_degC(sensor);
      double& highest = envelope.highest_degC(sensor);
      lowest = first_batch ? readings.minCoeff() : std::min(lowest, readings.minCoeff());
      highest = first_batch ? readings.maxCoeff() : std::max(highest, readings.maxCoeff());
      const double begin = detail::first_reading(batch.temperatures.values.col(column));
      double& first_lowest = envelope.first_lowest_degC(sensor);
      double& first_highest = envelope.first_highest_degC(sensor);
      first_lowest = first_batch ? begin : std::min(first_lowest, begin);
      first_highest = first_batch ? begin : std::max(first_highest, begin);
      series[i].push_back(batch.temperatures.values.col(column));
      if (!batch.has_time()) continue;
      start_at_zero(envelope.largest_rate_K_per_min);
      start_at_zero(envelope.longest_still_min);
      double& rate = envelope.largest_rate_K_per_min(sensor);
      double& still = envelope.longest_still_min(sensor);
      for (Index row = 1, changed = 0; row < batch.rows(); ++row) {
        const double change = std::abs(readings(row) - readings(row - 1));
        rate = std::max(rate, 60 * change / (batch.time_s(row) - batch.time_s(row - 1)));
        if (change > 0) changed = row;
        still = std::max(still, (batch.time_s(row) - batch.time_s(changed)) / 60);
      }
    }
  }
  if (envelope.has_range()) envelope.scatter_K.resize(static_cast<Index>(names.size()));
  for (Index i = 0; i < envelope.scatter_K.size(); ++i) {
    const SeriesByBatch& own = series[static_cast<std::size_t>(i)];
    double step = 0;
    for (const Vector& one : own) step = std::max(step, step_of(one));
    envelope.scatter_K(i) = std::max(6 * white_noise(own), 2 * step);
  }
  return envelope;
}

}  // namespace thermfit
