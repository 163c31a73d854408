#pragma once

#include <algorithm>
#include <cstddef>

#include "thermfit/calibration/held_out.hpp"
#include "thermfit/calibration/misfit.hpp"
#include "thermfit/diagnosis/judgement/thresholds.hpp"

namespace thermfit {

/// What an account does on held-out batches to the gap that calibration leaves. Channels weigh by the log score that
/// the account gains in them: a wandering thermometer elsewhere on the machine speaks neither for nor against it.
struct Closure {
  double share = 1;  ///< of the squared gap beyond expectation that it closes; 1 where there was nothing to close
  double left = 0;   ///< squared gap beyond expectation that it leaves, in units of what is expected
};

/// Of an account `after` beside what is left `before`. Allocates.
template <typename Scalar = double>
Closure closure_of(const MachineRecord& seen, const HeldOut& before, const HeldOut& after) {
  const VectorX<Scalar>&score_before = before.by_channel, &score_after = after.by_channel;
  const VectorX<Scalar> gained = (score_after - score_before).cwiseMax(0);
  if (!(gained.sum() > 0)) return {0, excess_of(misfit_of<Scalar>(seen, after.residual))};
  const VectorX<Scalar> from = (misfit_of<Scalar>(seen, before.residual).array() - 1).max(0);
  const VectorX<Scalar> to = (misfit_of<Scalar>(seen, after.residual).array() - 1).max(0);
  Closure result{0, 0};
  for (Index c = 0; c < gained.size(); ++c) {
    const double weight = gained(c) / gained.sum();
    result.share += weight * (from(c) > 0 ? std::clamp(1 - to(c) / from(c), 0.0, 1.0) : 1.0);
    result.left += weight * to(c);
  }
  return result;
}

/// Whether calibration leaves what no right machine would.
template <typename Scalar = double>
bool gap_is_real(const MachineRecord& seen, const ChannelResiduals& calibrated, const Thresholds& thresholds) {
  const VectorX<Scalar> misfit = misfit_of<Scalar>(seen, calibrated);
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    if (is_real(seen.channels[c], misfit(static_cast<Index>(c)), thresholds)) return true;
  return false;
}

/// Closure of an account of how heat moves through the machine, which must also close what is really open
/// (gap_is_real), wherever that is: the worse of both counts. Channels with a real gap weigh by it.
template <typename Scalar = double>
Closure closure_of_heat(const MachineRecord& seen, const HeldOut& before, const HeldOut& after,
                        const Thresholds& thresholds) {
  Closure result = closure_of<Scalar>(seen, before, after);
  const VectorX<Scalar> from = misfit_of<Scalar>(seen, before.residual), to = misfit_of<Scalar>(seen, after.residual);
  double excess = 0, share = 0, left = 0;
  for (std::size_t k = 0; k < seen.channels.size(); ++k) {
    const Index c = static_cast<Index>(k);
    if (!is_real(seen.channels[k], from(c), thresholds)) continue;
    const double weight = from(c) - 1, remains = std::max(0.0, to(c) - 1);
    excess += weight;
    share += std::max(0.0, weight - remains);
    left += weight * remains;
  }
  if (excess <= 0) return result;
  return {std::min(result.share, share / excess), std::max(result.left, left / excess)};
}

}  // namespace thermfit
