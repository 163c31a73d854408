#include "commands/commands.hpp"

namespace thermfit::cli {

const std::vector<Command>& all_commands() {
  static const std::vector<Command> commands{
      // clang-format off: one a line, in the order of the work
      check_command(),
      inspect_command(),
      diagnose_command(),
      run_command(),
      export_command(),
      // clang-format on
  };
  return commands;
}

}  // namespace thermfit::cli
