#pragma once

/// Inputs that a single batch makes vary: without that batch, what they drive is known by its prior alone, so that the
/// batch cannot judge what the others have learnt.

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/gap/observations.hpp"

namespace thermfit {

struct LoneInput {
  Index input = 0;
  std::size_t batch = 0;
};

/// Inputs constant over all batches but one. With fewer than three batches "all but one" means nothing: none.
inline std::vector<LoneInput> lone_inputs(const MachineRecord& seen) {
  std::vector<LoneInput> result;
  const std::vector<Excitation>& all = seen.excitations;
  for (Index i = 0; all.size() > 2 && i < all[0].inputs.cols(); ++i)
    for (std::size_t alone = 0; alone < all.size(); ++alone) {
      double low = INFINITY, high = -INFINITY;
      for (std::size_t b = 0; b < all.size(); ++b) {
        if (b == alone) continue;
        low = std::min(low, all[b].inputs.col(i).minCoeff());
        high = std::max(high, all[b].inputs.col(i).maxCoeff());
      }
      if (low == high && (all[alone].inputs.col(i).array() != low).any()) result.push_back({i, alone});
    }
  return result;
}

inline bool drives_alone(const MachineRecord& seen, std::size_t batch) {
  const std::vector<LoneInput> lone = lone_inputs(seen);
  return std::any_of(lone.begin(), lone.end(), [&](const LoneInput& one) { return one.batch == batch; });
}

}  // namespace thermfit
