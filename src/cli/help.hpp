#pragma once

/// Help texts, made from the one table of options that also parses them.

#include <string>

#include "cli/command.hpp"

namespace thermfit::cli {

Option help_option();
std::string overview();                          ///< `thermfit --help`
std::string short_help(const Command& command);  ///< `thermfit fit -h`: purpose, two examples, option names
std::string full_help(const Command& command);   ///< `thermfit fit --help`

}  // namespace thermfit::cli
