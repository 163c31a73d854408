#include "cli/arguments.hpp"

#include <algorithm>

#include "thermfit/io/nearest.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

const Option* find_option(const std::vector<Option>& options, std::string_view word) {
  for (const Option& option : options) {
    if (option.name == word) return &option;
    if (word.size() == 2 && word[0] == '-' && option.letter && word[1] == option.letter) return &option;
  }
  return nullptr;
}

[[noreturn]] void unknown_option(std::string_view word, const std::vector<Option>& options) {
  std::vector<std::string> names;
  for (const Option& option : options) names.push_back(option.name);
  throw UsageError("unknown option " + std::string(word) + did_you_mean(word, names));
}

/// A word that starts with a dash and is not a number nor stdin.
bool looks_like_option(const std::string& word) { return word.size() > 1 && word[0] == '-' && !parse_number(word); }

}  // namespace

Arguments::Arguments(const std::vector<std::string>& words, const std::vector<Option>& options) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--") {
      positionals_.insert(positionals_.end(), words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end());
      return;
    }
    if (!looks_like_option(word)) {
      positionals_.push_back(word);
      continue;
    }
    const auto equals = word.rfind("--", 0) == 0 ? word.find('=') : std::string::npos;
    const std::string name = word.substr(0, equals);
    const Option* option = find_option(options, name);
    if (!option) unknown_option(name, options);
    if (!option->repeats && has(option->name)) throw UsageError(option->name + " is given twice");
    if (option->value.empty()) {
      if (equals != std::string::npos) throw UsageError(option->name + " takes no value");
      given_.emplace_back(option->name, "");
    } else if (equals != std::string::npos) {
      given_.emplace_back(option->name, word.substr(equals + 1));
    } else {
      if (i + 1 == words.size() || (looks_like_option(words[i + 1]) && find_option(options, words[i + 1])))
        throw UsageError(option->name + " needs a value " + option->value + ": " + option->help);
      given_.emplace_back(option->name, words[++i]);
    }
  }
}

bool Arguments::has(std::string_view name) const { return value(name).has_value(); }

std::optional<std::string> Arguments::value(std::string_view name) const {
  for (const auto& [given, text] : given_)
    if (given == name) return text;
  return std::nullopt;
}

std::string Arguments::value_or(std::string_view name, std::string fallback) const {
  return value(name).value_or(std::move(fallback));
}

std::vector<std::string> Arguments::values(std::string_view name) const {
  std::vector<std::string> all;
  for (const auto& [given, text] : given_)
    if (given == name) all.push_back(text);
  return all;
}

std::vector<std::string> Arguments::list(std::string_view name) const {
  std::vector<std::string> items;
  for (const std::string& text : values(name)) {
    items.emplace_back();
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == ',')
        items.back() += text[++i];
      else if (text[i] == ',')
        items.emplace_back();
      else
        items.back() += text[i];
    }
  }
  for (const std::string& item : items)
    if (item.empty()) throw UsageError(std::string(name) + " has an empty entry; write A,B,C");
  return items;
}

std::optional<double> Arguments::number(std::string_view name, double lowest, double highest) const {
  const auto text = value(name);
  if (!text) return std::nullopt;
  const auto parsed = parse_number(*text);
  if (!parsed || *parsed < lowest || *parsed > highest)
    throw UsageError(std::string(name) + " is '" + *text + "'; allowed: a number from " + exact_text(lowest) + " to " +
                     exact_text(highest));
  return parsed;
}

std::optional<long> Arguments::integer(std::string_view name, long lowest, long highest) const {
  const auto text = value(name);
  if (!text) return std::nullopt;
  long parsed = 0;
  const auto [end, status] = std::from_chars(text->data(), text->data() + text->size(), parsed);
  if (status != std::errc() || end != text->data() + text->size() || parsed < lowest || parsed > highest)
    throw UsageError(std::string(name) + " is '" + *text + "'; allowed: a whole number from " + std::to_string(lowest) +
                     " to " + std::to_string(highest));
  return parsed;
}

std::string Arguments::choice(std::string_view name, const std::vector<std::string>& allowed,
                              std::string fallback) const {
  const auto text = value(name);
  if (!text) return fallback;
  if (std::find(allowed.begin(), allowed.end(), *text) != allowed.end()) return *text;
  throw UsageError(std::string(name) + " is '" + *text + "'; allowed: " + name_list(allowed) +
                   did_you_mean(*text, allowed));
}

std::vector<std::pair<std::string, std::string>> Arguments::words() const {
  std::vector<std::pair<std::string, std::string>> all = given_;
  for (const std::string& word : positionals_) all.emplace_back("", word);
  return all;
}

}  // namespace thermfit::cli
