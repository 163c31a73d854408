#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/error.hpp"

namespace thermfit {

/// How each sensor behaved while it was known to work: what a guard on the controller judges new readings by.
///
/// One entry per sensor in every member; all empty when unknown, the last two also where no batch has a clock.
struct SensorEnvelope {
  Vector lowest_degC;             ///< absolute readings, also for models on temperature rise
  Vector highest_degC;            ///< absolute readings, also for models on temperature rise
  Vector largest_rate_K_per_min;  ///< between neighbouring samples
  Vector longest_still_min;       ///< longest time without any change of the reading

  /// Whether lowest and highest are known.
  bool has_range() const { return lowest_degC.size() > 0; }
  /// Whether rates and still times are known.
  bool has_rates() const { return largest_rate_K_per_min.size() > 0; }
};

/// The envelope of the sensors `names` over all rows of `campaign`, in the order of `names`.
/// Throws Error on a name that a batch lacks. A campaign without rows gives an empty envelope. Allocates the result.
template <typename Scalar = double>
SensorEnvelope sensor_envelope(const Campaign& campaign, const std::vector<std::string>& names) {
  SensorEnvelope envelope;
  const auto start_at_zero = [&](Vector& figure) {
    if (figure.size() == 0) figure = VectorX<Scalar>::Zero(static_cast<Index>(names.size())).template cast<double>();
  };
  for (const Batch& batch : campaign) {
    if (batch.rows() == 0) continue;
    const bool first_batch = !envelope.has_range();
    start_at_zero(envelope.lowest_degC);
    start_at_zero(envelope.highest_degC);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Index column = batch.temperatures.find(names[i]);
      if (column < 0) throw Error(batch.name, "no temperature '" + names[i] + "'");
      const auto sensor = static_cast<Index>(i);
      const auto readings = detail::lazy<Scalar>(batch.temperatures.values).col(column);
      double& lowest = envelope.lowest_degC(sensor);
      double& highest = envelope.highest_degC(sensor);
      lowest = first_batch ? readings.minCoeff() : std::min(lowest, readings.minCoeff());
      highest = first_batch ? readings.maxCoeff() : std::max(highest, readings.maxCoeff());
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
  return envelope;
}

}  // namespace thermfit
