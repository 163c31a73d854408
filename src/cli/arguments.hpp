#pragma once

/// The command line as strings: which options exist, which were given. Meaning is the commands' business.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace thermfit::cli {

/// One option a command takes. `value` names its argument in help ("N", "FILE"); empty makes it a flag.
struct Option {
  std::string name;  ///< with dashes: "--components"
  std::string value;
  std::string help;
  char letter = 0;       ///< short form: 'o' for -o; 0 for none
  bool repeats = false;  ///< may be given several times
};

/// What a user typed after the command's name, checked against its options.
class Arguments {
 public:
  /// Parses `words`. Accepts `--name value`, `--name=value`, `-o value`, flags, and `--` before positionals that begin
  /// with a dash. Throws UsageError naming the nearest option on an unknown one, on a missing or surplus value, and on
  /// a repeated option that does not repeat.
  Arguments(const std::vector<std::string>& words, const std::vector<Option>& options);

  bool has(std::string_view name) const;
  std::optional<std::string> value(std::string_view name) const;
  std::string value_or(std::string_view name, std::string fallback) const;
  std::vector<std::string> values(std::string_view name) const;  ///< all of a repeating option
  std::vector<std::string> list(std::string_view name) const;    ///< comma-separated; a backslash keeps a comma
  std::optional<double> number(std::string_view name, double lowest, double highest) const;
  std::optional<long> integer(std::string_view name, long lowest, long highest) const;
  /// The value when it is one of `allowed`; throws UsageError with the nearest otherwise.
  std::string choice(std::string_view name, const std::vector<std::string>& allowed, std::string fallback) const;

  const std::vector<std::string>& positionals() const { return positionals_; }
  /// Everything that was given: the option and its value, an empty option for positionals.
  std::vector<std::pair<std::string, std::string>> words() const;

 private:
  std::vector<std::pair<std::string, std::string>> given_;
  std::vector<std::string> positionals_;
};

/// The command line itself is wrong. Printed with a pointer to `--help`; exit code 2.
class UsageError : public std::exception {
 public:
  explicit UsageError(std::string message) : message_(std::move(message)) {}
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  std::string message_;
};

}  // namespace thermfit::cli
