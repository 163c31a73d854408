#include "cli/help.hpp"

#include <algorithm>

#include "cli/table.hpp"

namespace thermfit::cli {
namespace {

std::string usage_line(const Command& command) {
  std::string text = "usage: thermfit " + command.name + " [options]";
  if (!command.positional.empty()) text += ' ' + command.positional;
  return text + '\n';
}

std::string label(const Option& option) {
  std::string text = option.letter ? std::string{'-', option.letter, ',', ' '} : "    ";
  text += option.name;
  if (!option.value.empty()) text += ' ' + option.value;
  return text;
}

std::string examples(const Command& command, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most, command.examples.size()); ++i)
    text += "  " + command.examples[i].line + "\n      " + command.examples[i].what + '\n';
  return text;
}

}  // namespace

Option help_option() { return {"--help", "", "this text; -h for the short one", 'h', false}; }

std::string overview() {
  std::string text =
      "thermfit: thermal error models of machine tools, how far to trust them, and why a\n"
      "simulation of the machine disagrees with the machine.\n\n"
      "usage: thermfit COMMAND [options] FILES\n\n";
  for (const Command& command : all_commands())
    text += "  " + command.name + std::string(11 - std::min<std::size_t>(10, command.name.size()), ' ') +
            command.summary + '\n';
  text += "\n'thermfit COMMAND -h' is a short help, '--help' the whole one; 'thermfit --version'.\n";
  for (const HelpTopic& topic : help_topics()) text += "'thermfit help " + topic.name + "': " + topic.summary + ".\n";
  text += "Exit codes: 0 done; 1 done and the finding is negative; 2 could not be done.\n";
  return text;
}

std::string short_help(const Command& command) {
  std::string text = command.summary + "\n\n" + usage_line(command) + '\n' + examples(command, 2) + '\n';
  std::string names = "options:";
  for (const Option& option : command.options) names += ' ' + option.name;
  return text + wrap(names, 80, 2) + "'thermfit " + command.name + " --help' explains them.\n";
}

std::string full_help(const Command& command) {
  std::string text = command.summary + "\n\n" + usage_line(command) + '\n' + wrap(command.details, 80, 0);
  text += "\noptions:\n";
  std::vector<Option> options = command.options;
  options.push_back(help_option());
  for (const Option& option : options) {
    const std::string left = "  " + label(option);
    const bool fits = left.size() < 31;
    const std::string body = wrap(std::string(32, ' ') + option.help, 80, 32);
    text += fits ? left + body.substr(left.size()) : left + '\n' + body;
  }
  if (!command.examples.empty()) text += "\nexamples:\n" + examples(command, command.examples.size());
  return text;
}

}  // namespace thermfit::cli
