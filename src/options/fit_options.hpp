#pragma once

/// Options of the commands that fit: method settings and which points.

#include "cli/arguments.hpp"
#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/fit/options.hpp"

namespace thermfit::cli {

/// --components, --ridge-lambda, --scaling.
std::vector<Option> fit_option_table();
FitOptions fit_options(const Arguments& arguments);

/// The -o, --output option; `what` is written there.
Option output_option(const std::string& what);

void append(std::vector<Option>& options, const std::vector<Option>& more);

/// --points as a number, 'all', or `fallback` (at most all). Throws UsageError when there are fewer points, and Error
/// when the batches have no error column.
Index require_points(const Arguments& arguments, const Campaign& campaign, Index fallback);

}  // namespace thermfit::cli
