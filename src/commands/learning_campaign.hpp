#pragma once

/// Batches as a command that learns from them, or judges by them, sees them: what about them changes its answer is
/// said.

#include "cli/arguments.hpp"
#include "cli/console.hpp"
#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/temperature_rise.hpp"

namespace thermfit::cli {

/// Reads the batches of the command line and says which columns read like temperatures and are not used, and what
/// note_faults() says. Throws as read_campaign() does.
Campaign learning_campaign(const Arguments& arguments, const Console& console, TemperatureReference reference);

/// Says, where temperatures count from the first row, which first readings are off those that follow: they move every
/// row of their batch.
void note_faults(const Campaign& campaign, TemperatureReference reference, const Console& console);

}  // namespace thermfit::cli
