#pragma once

/// Inputs that are on in a single batch: without that batch, what they drive is known by its prior alone, so that the
/// batch cannot judge what the others have learnt.

#include <algorithm>
#include <string>
#include <vector>

#include "thermfit/calibration/machine_record.hpp"
#include "thermfit/lazy.hpp"

namespace thermfit {

/// An input and the one batch it is on in.
struct LoneInput {
  Index input = 0;        ///< column of Excitation::inputs
  std::size_t batch = 0;  ///< in the order of the campaign
};

/// Inputs of the machine's heat sources and effects that are 0 in all batches but one. With fewer than three batches
/// "all but one" means nothing: none.
template <typename Scalar = double>
std::vector<LoneInput> lone_inputs(const ThermalNetwork& network, const Lazy<MachineRecord, Scalar>& seen) {
  std::vector<LoneInput> result;
  const Lazy<std::vector<Excitation>, Scalar>& all = seen.excitations;
  const auto drives = [&](const std::string& name) {
    return std::any_of(network.heat_sources.begin(), network.heat_sources.end(),
                       [&](const auto& source) { return source.input == name; }) ||
           std::any_of(network.effects.begin(), network.effects.end(),
                       [&](const auto& effect) { return effect.driver == name; });
  };
  for (Index i = 0; all.size() > 2 && i < all[0].inputs.cols(); ++i) {
    if (!drives(all[0].input_names[static_cast<std::size_t>(i)])) continue;
    for (std::size_t alone = 0; alone < all.size(); ++alone) {
      bool others = false;
      for (std::size_t b = 0; b < all.size(); ++b)
        others = others || (b != alone && (all[b].inputs.col(i).array() != 0).any());
      if (!others && (all[alone].inputs.col(i).array() != 0).any()) result.push_back({i, alone});
    }
  }
  return result;
}

}  // namespace thermfit
