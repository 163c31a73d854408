#pragma once

#include "thermfit/findings/finding.hpp"

namespace thermfit::detail {

/// What a finding says about the data of its channel.
enum class Unfit {
  nothing,  ///< worth knowing, but the readings are what they are
  rows,     ///< first_row … last_row are no readings of the channel
  after,    ///< what follows last_row has another zero than what precedes first_row
  channel,  ///< the channel is not what it says, in the whole batch
  batch     ///< the batch is no experiment of its own
};

/// What a rule says. Does not allocate.
inline Unfit unfit(FindingRule rule) {
  switch (rule) {
    case FindingRule::spike:
    case FindingRule::impossible:
    case FindingRule::stuck:
    case FindingRule::saturated:
      return Unfit::rows;
    case FindingRule::jump:
      return Unfit::after;
    case FindingRule::drift:
    case FindingRule::gain:
    case FindingRule::dead:
    case FindingRule::swapped:
    case FindingRule::disagrees:
    case FindingRule::sign:
    case FindingRule::constant:
    case FindingRule::unit:
      return Unfit::channel;
    case FindingRule::copy:
      return Unfit::batch;
    default:
      return Unfit::nothing;
  }
}

}  // namespace thermfit::detail
