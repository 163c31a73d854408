#include "cli/command.hpp"

#include <csignal>
#include <new>

#include "cli/help.hpp"
#include "thermfit/error.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/version.hpp"

namespace thermfit::cli {
namespace {

int code(Exit exit) { return static_cast<int>(exit); }

const Command* find_command(const std::string& name) {
  for (const Command& command : all_commands())
    if (command.name == name) return &command;
  return nullptr;
}

int unknown_command(const std::string& word, Console& console) {
  std::vector<std::string> names;
  for (const Command& command : all_commands()) names.push_back(command.name);
  console.note("unknown command '" + word + "'" + did_you_mean(word, names) +
               " ('thermfit --help' lists the commands)");
  return code(Exit::failed);
}

int run_command(const Command& command, const std::vector<std::string>& words, Console& console) {
  for (const std::string& word : words) {
    if (word == "--") break;
    if (word != "-h" && word != "--help") continue;
    console.print(word == "-h" ? short_help(command) : full_help(command));
    console.finish();
    return code(Exit::done);
  }
  std::vector<Option> options = command.options;
  options.push_back(help_option());
  try {
    const Exit exit = command.run(Arguments(words, options), console);
    console.finish();
    return code(exit);
  } catch (const UsageError& error) {
    console.note(std::string(error.what()) + " ('thermfit " + command.name + " --help' tells more)");
  } catch (const Error& error) {
    console.note(error.what());
  } catch (const std::bad_alloc&) {
    console.note("out of memory; nothing was written");
  } catch (const std::exception& error) {
    console.note(std::string("internal error: ") + error.what());
  }
  return code(Exit::failed);
}

}  // namespace

int run(const std::vector<std::string>& words, Console::Wording wording) {
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is met as a failed write, where it can be judged
  Console console(wording);
  if (words.empty()) {
    console.note("a command is missing\n" + overview());
    return code(Exit::failed);
  }
  const std::string& first = words.front();
  try {
    if (first == "--version" || first == "-V") {
      console.line("thermfit " THERMFIT_VERSION);
      console.finish();
      return code(Exit::done);
    }
    if (first == "--help" || first == "-h" || (first == "help" && words.size() == 1)) {
      console.print(overview());
      console.finish();
      return code(Exit::done);
    }
    if (first == "help") {
      for (const HelpTopic& topic : help_topics()) {
        if (topic.name != words[1]) continue;
        console.print(topic.text());
        console.finish();
        return code(Exit::done);
      }
      const Command* command = find_command(words[1]);
      return command ? run_command(*command, {"--help"}, console) : unknown_command(words[1], console);
    }
    const Command* command = find_command(first);
    if (!command) return unknown_command(first, console);
    return run_command(*command, {words.begin() + 1, words.end()}, console);
  } catch (const Error& error) {
    console.note(error.what());
    return code(Exit::failed);
  }
}

}  // namespace thermfit::cli
