#pragma once

/// `--error-reference`, for commands that fit, compare or judge thermal errors, and what there is to say about it.

#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/console.hpp"
#include "thermfit/batch/error_reference.hpp"
#include "thermfit/model/trained_model.hpp"
#include "thermfit/moments/moments.hpp"

namespace thermfit::cli {

Option error_reference_option();

/// What the option says, `otherwise` without it. Throws UsageError together with --absolute.
ErrorReference error_reference(const Arguments& arguments, ErrorReference otherwise = ErrorReference::recorded);

/// "as recorded", "relative to the start of each batch" or "about each batch's own intercept".
std::string in_words(ErrorReference reference);

/// Says which errors start with a reading that is off, and which rises and errors count from a later row than the
/// first: in what is learned from wherever the first row was left out, in what is predicted where it lacks a
/// temperature.
void note_starts(const Campaign& campaign, ErrorReference reference, bool learning, const Console& console);

/// Says where the levels of batches are most of an error, or most of what temperatures leave of it, and no temperature
/// tells them: the probe's zero. `points`: temperature columns a model reads; empty: all.
void note_levels(const Campaign& campaign, const std::vector<Index>& points, TemperatureReference temperatures,
                 ErrorReference reference, const Console& console);

/// The same from the moments of the batches as a model reads them, `counted` so.
void note_levels(const Campaign& campaign, const std::vector<Moments<>>& counted, const std::vector<Index>& points,
                 TemperatureReference temperatures, ErrorReference reference, const Console& console);

/// Says which errors of a model stand at a probe's zero or a machine coordinate (probe_level_um).
void note_probe_levels(const TrainedModel& model, const Console& console);

}  // namespace thermfit::cli
