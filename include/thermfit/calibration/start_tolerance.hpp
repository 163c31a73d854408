#pragma once

#include <cmath>

#include "thermfit/calibration/machine_record.hpp"

namespace thermfit {

/// By how much the parts of a right machine may stand off the room when a batch begins, each by its own air: within
/// this, a start off ambient is no fault.
constexpr double start_tolerance_K = 0.25;

/// Prior standard deviation of ThermalNetwork::Initial::share, so that a share s costs what its starts do: the starts
/// s r of nodes that first read r above ambient have density exp(-sum (s r)^2 / (2 tolerance^2)). Wide where all read
/// nearly ambient, narrow where some are far off it.
inline double start_share_sd(const ThermalNetwork& network, const MachineRecord& seen) {
  double squares = 0;
  for (const Excitation& one : seen.excitations)
    for (Index s = 0; s < one.first_reading_degC.size(); ++s)
      if (network.sensors[static_cast<std::size_t>(s)].node >= 0 && std::isfinite(one.first_reading_degC(s)))
        squares += std::pow(one.first_reading_degC(s) - one.ambient_degC(0), 2);
  return squares > 0 ? start_tolerance_K / std::sqrt(squares) : 0;
}

}  // namespace thermfit
