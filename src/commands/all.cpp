#include "commands/commands.hpp"
#include "options/campaign_options.hpp"

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

const std::vector<HelpTopic>& help_topics() {
  static const std::vector<HelpTopic> topics{{"dialects", "names for the files of some loggers", dialects_help}};
  return topics;
}

}  // namespace thermfit::cli
