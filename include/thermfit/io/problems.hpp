#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "thermfit/error.hpp"

namespace thermfit {
namespace detail {

using Parts = std::initializer_list<std::string_view>;

inline std::string joined(Parts parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

/// An Error told in parts, which are joined here and not in each of the many places that complain.
inline Error problem(const std::string& place, Parts found, Parts allowed = {}, Parts remedy = {}) {
  return Error(place, joined(found), joined(allowed), joined(remedy));
}

}  // namespace detail

/// Several problems of one input, told at once. `what()` has a line each; place() and the rest are the first's. What is
/// wrong alike with several files as a whole, such as a column that none of them has, is one line.
class Errors : public Error {
 public:
  /// Keeps the problems and joins them and `last_line` to what(). Throws std::out_of_range without a problem.
  /// Allocates.
  explicit Errors(std::vector<Error> problems, std::string last_line = {})
      : Error(problems.at(0)), problems_(std::move(problems)) {
    std::vector<bool> told(problems_.size(), false);
    for (std::size_t i = 0; i < problems_.size(); ++i) {
      if (told[i]) continue;
      std::size_t more = 0;
      const std::string& place = problems_[i].place();
      for (std::size_t j = i + 1; j < problems_.size(); ++j) {
        if (!alike(problems_[i], problems_[j])) continue;
        told[j] = true;
        more += problems_[j].place() != place;
      }
      std::string line = problems_[i].what();
      if (more > 0) line.insert(place.size(), " and " + std::to_string(more) + " more");
      text_ += (text_.empty() ? "" : "\n") + line;
    }
    if (!last_line.empty()) text_ += '\n' + last_line;
  }

  /// A line for each problem, one for those that are alike, then the last line. Does not allocate.
  const char* what() const noexcept override { return text_.c_str(); }
  /// All of them, also those that are alike, in the order of the constructor; never empty. Does not allocate.
  const std::vector<Error>& problems() const noexcept { return problems_; }

 private:
  static bool is_of_whole_file(const Error& problem) {
    return !problem.place().empty() && problem.place().find(':') == std::string::npos;
  }

  /// The same, or the same but for the file and not about one line of it.
  static bool alike(const Error& a, const Error& b) {
    return (a.place() == b.place() || (is_of_whole_file(a) && is_of_whole_file(b))) && a.found() == b.found() &&
           a.allowed() == b.allowed() && a.remedy() == b.remedy();
  }

  std::vector<Error> problems_;
  std::string text_;
};

/// Collects problems, so that a user mends a file once and not once per mistake.
class Problems {
 public:
  /// The `most`th problem is the last: it is thrown with those before it; 0 counts as 1. Does not allocate.
  explicit Problems(std::size_t most) : most_(most == 0 ? 1 : most) {}

  /// Keeps one more; throws all of them when the limit is reached.
  void add(Error problem) {
    all_.push_back(std::move(problem));
    if (all_.size() < most_) return;
    if (all_.size() == 1) throw all_.front();
    throw Errors(std::move(all_),
                 "stopped after " + std::to_string(most_) + " errors; CsvOptions::max_errors = N shows more");
  }

  /// Throws what was collected, if anything: the Error itself when it is the only one.
  void throw_if_any() {
    if (all_.empty()) return;
    if (all_.size() == 1) throw all_.front();
    throw Errors(std::move(all_));
  }

  /// How many it has collected so far. Does not allocate.
  std::size_t count() const { return all_.size(); }

 private:
  std::size_t most_;
  std::vector<Error> all_;
};

}  // namespace thermfit
