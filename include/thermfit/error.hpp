#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace thermfit {

/// Bad input, told so that the user can mend it: where, what was found, what is allowed, what to do next.
///
/// `place` is `file:line:column`, a key path such as `machine.json: nodes[3].capacity_J_per_K`, or the name of an
/// argument. Empty parts are left out of `what()`, which reads `place: found; allowed: …; remedy`.
/// Numerical outcomes (rank, convergence, condition) are results and never thrown.
class Error : public std::runtime_error {
 public:
  /// Keeps the four parts and joins them to what(); empty parts are left out. Allocates.
  explicit Error(std::string place, std::string found, std::string allowed = {}, std::string remedy = {})
      : std::runtime_error(sentence(place, found, allowed, remedy)),
        place_(std::move(place)),
        found_(std::move(found)),
        allowed_(std::move(allowed)),
        remedy_(std::move(remedy)) {}

  /// Where: `file:line:column`, a key path or the name of an argument; may be empty.
  const std::string& place() const noexcept { return place_; }
  /// What stands there, in words.
  const std::string& found() const noexcept { return found_; }
  /// What may stand there; may be empty.
  const std::string& allowed() const noexcept { return allowed_; }
  /// What to do next; may be empty.
  const std::string& remedy() const noexcept { return remedy_; }

 private:
  static std::string sentence(const std::string& place, const std::string& found, const std::string& allowed,
                              const std::string& remedy) {
    std::string text = place.empty() ? found : place + ": " + found;
    if (!allowed.empty()) text += "; allowed: " + allowed;
    if (!remedy.empty()) text += "; " + remedy;
    return text;
  }

  std::string place_, found_, allowed_, remedy_;
};

}  // namespace thermfit
