#pragma once

/// What few batches and inputs that hardly move do not allow to say: rules that both ways of a diagnosis share.

#include <cstddef>
#include <string>
#include <vector>

#include "thermfit/diagnosis/diagnosis.hpp"

namespace thermfit {

/// With fewer batches, held-out figures rest on few data.
constexpr std::size_t enough_batches = 4;

/// What `batches` batches, and inputs that never change in any of them, do not allow to say.
inline std::vector<WeakerClaim> weaker_claims(std::size_t batches, const std::vector<std::string>& constant_inputs) {
  using Kind = WeakerClaim::Kind;
  std::vector<WeakerClaim> result;
  if (batches < enough_batches)
    result.push_back({batches < 2 ? Kind::one_batch : Kind::few_batches, "", "", {}, batches});
  for (const std::string& input : constant_inputs) result.push_back({Kind::constant_input, input, "", {}, batches});
  return result;
}

}  // namespace thermfit
