#pragma once

#include <string>
#include <utility>
#include <vector>

#include "thermfit/error.hpp"

namespace thermfit {

/// Several problems of one input, told at once. `what()` has a line each; place() and the rest are the first's.
class Errors : public Error {
 public:
  explicit Errors(std::vector<Error> problems, std::string last_line = {})
      : Error(problems.at(0)), problems_(std::move(problems)) {
    for (const Error& problem : problems_) text_ += (text_.empty() ? "" : "\n") + std::string(problem.what());
    if (!last_line.empty()) text_ += '\n' + last_line;
  }

  const char* what() const noexcept override { return text_.c_str(); }
  const std::vector<Error>& problems() const noexcept { return problems_; }

 private:
  std::vector<Error> problems_;
  std::string text_;
};

/// Collects problems, so that a user mends a file once and not once per mistake.
class Problems {
 public:
  explicit Problems(std::size_t most) : most_(most == 0 ? 1 : most) {}

  /// Keeps one more; throws all of them when the limit is reached.
  void add(Error problem) {
    all_.push_back(std::move(problem));
    if (all_.size() < most_) return;
    if (all_.size() == 1) throw all_.front();
    throw Errors(std::move(all_), "stopped after " + std::to_string(most_) + " errors; --max-errors N shows more");
  }

  /// Throws what was collected, if anything: the Error itself when it is the only one.
  void throw_if_any() {
    if (all_.empty()) return;
    if (all_.size() == 1) throw all_.front();
    throw Errors(std::move(all_));
  }

  std::size_t count() const { return all_.size(); }

 private:
  std::size_t most_;
  std::vector<Error> all_;
};

}  // namespace thermfit
