#include "cli/command.hpp"

namespace thermfit::cli {

const std::vector<Command>& all_commands() {
  static const std::vector<Command> commands{};
  return commands;
}

}  // namespace thermfit::cli
