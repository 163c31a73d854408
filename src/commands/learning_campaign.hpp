#pragma once

/// Batches as a command that learns from them, or judges by them, sees them: what about them changes its answer is
/// said.

#include <string>

#include "cli/arguments.hpp"
#include "cli/console.hpp"
#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/temperature_rise.hpp"

namespace thermfit::cli {

/// `--leave-out`, which learning_campaign() reads.
Option leave_out_option();

/// Reads the batches of the command line, without what is at fault where --leave-out says so, and says which columns
/// read like temperatures and are not used, what note_faults() and what note_first_rows() say. Throws as
/// read_campaign() does, and where nothing is left.
Campaign learning_campaign(const Arguments& arguments, const Console& console, TemperatureReference reference);

/// Says in a line which faults of the batches may change an answer, and `remedy` after where to read of them.
void note_faults(const Campaign& campaign, const Console& console, const std::string& remedy = {});

/// Says, where temperatures count from the first row, which first readings are off those that follow: they move every
/// row of their batch.
void note_first_rows(const Campaign& campaign, TemperatureReference reference, const Console& console);

}  // namespace thermfit::cli
