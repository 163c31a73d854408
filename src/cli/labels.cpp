#include "cli/labels.hpp"

#include <algorithm>
#include <set>

#include "cli/table.hpp"

namespace thermfit::cli {
namespace {

bool is_mark(char c) { return c == ' ' || c == '_' || c == '-' || c == '.' || c == '/' || c == ':'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t widest_of(const std::vector<std::string>& names) {
  std::size_t widest = 0;
  for (const std::string& name : names) widest = std::max(widest, display_width(name));
  return widest;
}

/// How many bytes all names begin with, cut back to the end of a word: behind a mark, or between a letter and a digit.
std::size_t common_words(const std::vector<std::string>& names) {
  std::size_t common = names.front().size();
  for (const std::string& name : names)
    common = static_cast<std::size_t>(
        std::mismatch(names.front().begin(),
                      names.front().begin() + static_cast<std::ptrdiff_t>(std::min(common, name.size())), name.begin())
            .first -
        names.front().begin());
  const auto ends_word = [&](std::size_t at) {
    return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
      return at < name.size() && (is_mark(name[at - 1]) || (is_digit(name[at]) && !is_digit(name[at - 1])));
    });
  };
  while (common > 0 && !ends_word(common)) --common;
  return common;
}

}  // namespace

Labels::Labels(std::vector<std::string> names, char letter, std::size_t widest)
    : names_(std::move(names)), labels_(names_) {
  if (names_.size() < 2 || widest_of(names_) <= widest) return;
  cut_common_words();
  const std::set<std::string> different(labels_.begin(), labels_.end());
  const bool readable =
      different.size() == std::set<std::string>(names_.begin(), names_.end()).size() && widest_of(labels_) <= widest;
  if (!readable) number(letter);
}

void Labels::cut_common_words() {
  std::size_t front = common_words(labels_);
  const auto starts_with_digit = [&](const std::string& name) { return is_digit(name[front]); };
  if (front > 0 && std::any_of(labels_.begin(), labels_.end(), starts_with_digit)) {  // a number alone says too little
    while (front > 0 && is_mark(labels_.front()[front - 1])) --front;
    while (front > 0 && !is_mark(labels_.front()[front - 1])) --front;
  }
  before_ = labels_.front().substr(0, front);
  for (std::string& label : labels_) label.erase(0, front);
  std::vector<std::string> reversed = labels_;
  for (std::string& label : reversed) std::reverse(label.begin(), label.end());
  std::size_t back = common_words(reversed);
  while (back > 0 && is_digit(reversed.front()[back - 1]) && !is_mark(reversed.front()[back])) --back;
  behind_ = labels_.front().substr(labels_.front().size() - back);
  for (std::string& label : labels_) label.erase(label.size() - back);
}

void Labels::number(char letter) {
  before_.clear();
  behind_.clear();
  numbered_ = true;
  const std::size_t digits = std::to_string(names_.size()).size();
  std::string first(1, letter);
  const auto is_taken = [&](const std::string& label) {
    return std::find(names_.begin(), names_.end(), label) != names_.end();
  };
  for (bool again = true; again;) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const std::string count = std::to_string(i + 1);
      labels_[i] = first + std::string(digits - count.size(), '0') + count;
    }
    again = std::any_of(labels_.begin(), labels_.end(), is_taken);
    if (again) first += letter;
  }
}

std::string Labels::legend() const {
  if (!numbered_) {
    if (before_.empty() && behind_.empty()) return {};
    return "Names are shown without" + (before_.empty() ? "" : " '" + before_ + "' before them") +
           (before_.empty() || behind_.empty() ? "" : " and") +
           (behind_.empty() ? "" : " '" + behind_ + "' behind them") + ".\n";
  }
  const std::size_t cell = labels_.front().size() + 2 + widest_of(names_);
  const std::size_t columns = std::max<std::size_t>(1, (80 + 3) / (cell + 3));
  const std::size_t lines = (names_.size() + columns - 1) / columns;
  std::string text;
  for (std::size_t line = 0; line < lines; ++line) {
    std::string row;
    for (std::size_t i = line; i < names_.size(); i += lines) {
      if (i > line) row += "   ";
      std::string one = labels_[i] + "  " + names_[i];
      if (i + lines < names_.size()) one += std::string(cell - display_width(one), ' ');
      row += one;
    }
    text += row + '\n';
  }
  return text;
}

std::string legends(const Labels& batches, const Labels& points) {
  std::string text;
  for (const auto& [heading, labels] : {std::pair("Batches", &batches), std::pair("Temperature points", &points)})
    if (const std::string legend = labels->legend(); !legend.empty())
      text += std::string("\n") + heading + '\n' + legend;
  return text;
}

std::size_t label_width(std::size_t count) {
  return std::clamp<std::size_t>(160 / std::max<std::size_t>(1, count), 8, 18) - 2;
}

}  // namespace thermfit::cli
