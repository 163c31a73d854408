#include "commands/commands.hpp"

namespace thermfit::cli {

const std::vector<Command>& all_commands() {
  // In the order of the work, one a line.
  // clang-format off
  static const std::vector<Command> commands{
      check_command(),
      rank_command(),
      fit_command(),
      predict_command(),
      study_command(),
      inspect_command(),
      simulate_command(),
      calibrate_command(),
      diagnose_command(),
      run_command(),
      export_command(),
  };
  // clang-format on
  return commands;
}

}  // namespace thermfit::cli
