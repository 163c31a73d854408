#pragma once

/// Structured Text as text: literals, statements, indentation.

#include <cctype>
#include <limits>
#include <string>
#include <type_traits>

#include "export/source_text.hpp"

namespace thermfit::cli {

/// Collects lines of Structured Text whose reals are of the type that holds Scalar.
template <class Scalar>
class StText {
 public:
  inline static const std::string most_steps = "1000000000";  ///< counters stop there: none leaves a DINT

  static std::string type() { return std::is_same_v<Scalar, float> ? "REAL" : "LREAL"; }
  static std::string number(std::size_t index) { return std::to_string(index + 1); }
  static std::string numbered(const std::string& name, std::size_t index) { return name + number(index); }
  static std::string real(Scalar value) {
    const std::string text = upper_case(real_text(value));
    return value < 0 ? "(" + text + ")" : text;
  }
  /// A variable of one sensor.
  static std::string of(std::size_t i, const std::string& what) { return "s" + number(i) + "_" + what; }
  static std::string of_steps(const std::string& steps) { return "UDINT_TO_" + type() + "(" + steps + ")"; }
  static std::string finite(const std::string& value) {
    const std::string most = real(std::numeric_limits<Scalar>::max());
    return value + " >= (-" + most + ") AND " + value + " <= " + most;
  }
  static std::string within(const std::string& value, Scalar lowest, Scalar highest) {
    return value + " >= " + real(lowest) + " AND " + value + " <= " + real(highest);
  }

  /// One line, indented by the blocks that are open.
  void line(const std::string& text) {
    const auto starts = [&](const char* word) { return text.rfind(word, 0) == 0; };
    const bool closed_in_line = text.find("END_IF;") != std::string::npos && !starts("END_IF");
    if ((starts("END_") && !starts("END_FUNCTION")) || starts("ELSE") || starts("ELSIF")) indent_ -= 2;
    text_ += std::string(indent_, ' ') + text + '\n';
    if (!closed_in_line &&
        (starts("IF ") || starts("ELSE") || starts("ELSIF") || starts("WHILE") || starts("CASE") || starts("VAR")))
      indent_ += 2;
  }
  void set(const std::string& variable, const std::string& value) { line(variable + " := " + value + ";"); }
  void set_if(const std::string& condition, const std::string& variable, const std::string& value) {
    line("IF " + condition + " THEN " + variable + " := " + value + "; END_IF;");
  }
  void without_sign(const std::string& variable) { set_if(variable + " < 0.0", variable, "-" + variable); }
  void count(const std::string& counter) { set_if(counter + " <= " + most_steps, counter, counter + " + steps"); }

  /// All lines so far; begins anew.
  std::string taken() {
    std::string text;
    text.swap(text_);
    return text;
  }

 private:
  std::string text_;
  std::size_t indent_ = 0;
};

/// How often `word` stands in `code` outside comments, in any case.
inline int st_uses(const std::string& code, const std::string& word) {
  const std::string wanted = upper_case(word);
  std::string token;
  int found = 0;
  for (std::size_t at = 0; at < code.size(); ++at) {
    if (code.compare(at, 2, "(*") == 0) at = code.find("*)", at) + 1;
    const char c = code[at];
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
      token += c;
      continue;
    }
    found += upper_case(token) == wanted;
    token.clear();
  }
  return found;
}

}  // namespace thermfit::cli
