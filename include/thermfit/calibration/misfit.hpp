#pragma once

/// How far off a machine is, in units of what is expected of a right one.

#include <cmath>
#include <cstddef>

#include "thermfit/calibration/linearized.hpp"

namespace thermfit {

/// Mean square of each channel over that of what is expected of a right machine: noise and lumping tolerance,
/// floor^2 + least_slow^2. Missing samples (NaN) are left out; 0 for a channel without samples. Allocates the result.
template <typename Scalar = double>
VectorX<Scalar> misfit_of(const MachineRecord& seen, const ChannelResiduals& residual) {
  VectorX<Scalar> result = VectorX<Scalar>::Zero(static_cast<Index>(seen.channels.size()));
  for (std::size_t c = 0; c < residual.size(); ++c) {
    const ObservedChannel& channel = seen.channels[c];
    double squares = 0, count = 0;
    for (const VectorX<Scalar>& r : residual[c])
      for (Index k = 0; k < r.size(); ++k)
        if (!std::isnan(r(k))) squares += r(k) * r(k), ++count;
    const double expected = std::hypot(channel.floor, channel.bounds.least_slow);
    if (count > 0 && expected > 0) result(static_cast<Index>(c)) = squares / count / (expected * expected);
  }
  return result;
}

/// What is beyond expectation, summed over channels: sum of max(0, misfit - 1).
template <typename Derived>
typename Derived::Scalar excess_of(const Eigen::MatrixBase<Derived>& misfit) {
  return (misfit.array() - 1).max(0).sum();
}

}  // namespace thermfit
