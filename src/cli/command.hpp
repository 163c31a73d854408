#pragma once

/// What every command is: a name, its options, its help, and a function.

#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/console.hpp"

namespace thermfit::cli {

/// How a command ends; the process exit code.
enum class Exit {
  done = 0,      ///< done
  negative = 1,  ///< done, and the finding is negative: faults found, a gap without a name, a limit exceeded
  failed = 2     ///< could not be done: usage, file, numbers, output
};

struct Example {
  std::string line;  ///< runs as it stands from the project's top folder: ctest does
  std::string what;
};

struct Command {
  std::string name;
  std::string summary;     ///< one line for the table of commands
  std::string positional;  ///< "BATCH.csv …" or "model.json BATCH.csv …"
  std::string details;     ///< paragraphs for --help: what it does, what it prints, exit codes
  std::vector<Option> options;
  std::vector<Example> examples;
  Exit (*run)(const Arguments&, Console&);
};

/// The commands, in the order of the work; defined in commands/all.cpp.
const std::vector<Command>& all_commands();

/// A text that `thermfit help NAME` prints.
struct HelpTopic {
  std::string name, summary;
  std::string (*text)();
};

/// What help there is besides that of commands; defined in commands/all.cpp.
const std::vector<HelpTopic>& help_topics();

/// Runs the command that `words` (argv without the program) names; prints errors in the `wording` of
/// the command line (none: as they come); returns the process exit code.
int run(const std::vector<std::string>& words, Console::Wording wording = nullptr);

}  // namespace thermfit::cli
