#pragma once

/// Batches that do not begin in equilibrium: the machine ran before logging began.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/calibration/start_tolerance.hpp"
#include "thermfit/network/excitation.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// Which batches start warm, and where most.
struct WarmStart {
  std::vector<std::string> batches;  ///< that start warm, or cold; empty: none
  std::string batch;                 ///< of the largest rise
  std::string channel;               ///< thermometer of the largest rise
  double rise_K = 0;                 ///< above ambient, or below it

  /// Whether any batch does.
  explicit operator bool() const { return !batches.empty(); }
};

/// How far a first reading must stand off the room to be a start, in standard deviations of what thermometers and parts
/// in equilibrium do (their offsets and start_tolerance_K).
constexpr double warm_sds = 3;

/// The batches whose first readings stand off the room at a quarter of the thermometers on parts, and at two at least
/// where there are two, and off one another: one alone is a thermometer's fault, several alike the room's or an initial
/// gradient. A machine that ran before is warm by as much as each part was heated.
inline WarmStart warm_start(const ThermalNetwork& network, const std::vector<Excitation>& excitations) {
  const double limit_K = warm_sds * std::hypot(start_tolerance_K, network.uncertainty.sensor_offset_K);
  WarmStart result;
  for (const Excitation& one : excitations) {
    std::size_t read = 0, off = 0, most = 0;
    double low = 0, high = 0, largest = 0;  // of those that stand off the room
    for (std::size_t s = 0; s < network.sensors.size(); ++s) {
      const double degC =
          one.first_reading_degC.size() > 0 ? one.first_reading_degC(static_cast<Index>(s)) : std::nan("");
      if (network.sensors[s].node < 0 || !std::isfinite(degC)) continue;
      const double rise = degC - network.sensors[s].offset_K - one.ambient_degC(0);
      ++read;
      if (std::abs(rise) <= limit_K) continue;
      low = off == 0 ? rise : std::min(low, rise);
      high = off == 0 ? rise : std::max(high, rise);
      ++off;
      if (std::abs(rise) > std::abs(largest)) largest = rise, most = s;
    }
    const std::size_t enough = std::max((read + 3) / 4, std::min<std::size_t>(read, 2));
    if (read == 0 || off < enough || (read > 1 && high - low <= warm_sds * start_tolerance_K)) continue;
    result.batches.push_back(one.batch);
    if (std::abs(largest) <= std::abs(result.rise_K)) continue;
    result.rise_K = largest;
    result.batch = one.batch;
    result.channel = network.sensors[most].column;
  }
  return result;
}

/// What a machine file says whose batches start as they were left.
constexpr const char* says_fitted_start = "\"initial\": \"fitted\"";

/// The machine with starts estimated batch by batch, see ThermalNetwork::Initial::Rule::fitted.
inline ThermalNetwork with_fitted_start(ThermalNetwork network) {
  network.initial = {ThermalNetwork::Initial::Rule::fitted, {}, 0};
  return network;
}

}  // namespace thermfit
