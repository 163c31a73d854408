#pragma once

/// Options of the method `transfer`, and what there is to say about what it cannot have.

#include "cli/arguments.hpp"
#include "cli/console.hpp"
#include "thermfit/fit/train_transfer.hpp"

namespace thermfit::cli {

/// --features, --lag.
std::vector<Option> transfer_option_table();

/// What the options say for `campaign`, errors counted as `reference`. Throws UsageError on a value that is not
/// allowed: --features names blocks, columns of known inputs and differences of temperatures.
TransferPlan transfer_plan(const Arguments& arguments, const Campaign& campaign, ErrorReference reference);

/// Says which blocks of the method `transfer` these batches cannot have, and why. Throws UsageError where --features
/// asks for one of them by name.
void note_lacking_blocks(const Arguments& arguments, const Campaign& campaign, const TransferPlan& plan,
                         const Console& console);

}  // namespace thermfit::cli
