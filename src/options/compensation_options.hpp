#pragma once

/// The options that say how a compensator behaves, for the commands that run one or write one.

#include <vector>

#include "cli/arguments.hpp"
#include "thermfit/controller/settings_for.hpp"

namespace thermfit::cli {

std::vector<Option> compensation_options();
CompensationWishes compensation_wishes(const Arguments& arguments);

}  // namespace thermfit::cli
