#include "options/field_flags.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "cli/command.hpp"
#include "support/catch.hpp"
#include "thermfit/io/problems.hpp"

using namespace thermfit;
namespace fs = std::filesystem;

namespace {

/// Every string literal of a source text, comments left out.
std::vector<std::string> string_literals(const std::string& source) {
  std::vector<std::string> literals;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (source.compare(i, 2, "//") == 0) {
      i = std::min(source.find('\n', i), source.size());
    } else if (source[i] == '\'' && i + 2 < source.size()) {  // a character, no digit separator
      if (source[i + 1] == '\\')
        i = source.find('\'', i + 3);
      else if (source[i + 2] == '\'')
        i += 2;
    } else if (source[i] == '"') {
      std::string literal;
      for (++i; i < source.size() && source[i] != '"'; ++i) {
        literal += source[i];
        if (source[i] == '\\') literal += source[++i];
      }
      literals.push_back(literal);
    }
  }
  return literals;
}

std::vector<std::pair<std::string, std::string>> library_strings() {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& entry : fs::recursive_directory_iterator(THERMFIT_SOURCE_DIR "/include")) {
    if (entry.path().extension() != ".hpp") continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    for (const std::string& literal : string_literals(text.str())) all.emplace_back(entry.path().string(), literal);
  }
  return all;
}

}  // namespace

TEST_CASE("a field in a message becomes its flag, and an assignment what is typed") {
  CHECK(cli::with_flags("use CsvOptions::missing = hold or CsvOptions::missing = drop") ==
        "use --missing hold or --missing drop");
  CHECK(cli::with_flags("no column 'Q' (CsvOptions::errors)") == "no column 'Q' (--errors)");
  CHECK(cli::with_flags("CsvOptions::time_unit says h") == "--time-unit says h");
  CHECK(cli::with_flags("CsvOptions::columns") == "--columns");
}

TEST_CASE("what is no field of the table stays as it is") {
  for (const char* text : {"", "no such file", "CsvOptions::missing_link", "CsvOptions::plain = true", "a = b"})
    CHECK(cli::with_flags(text) == text);
}

TEST_CASE("the library names no option of the command line") {
  for (const auto& [file, text] : library_strings()) {
    INFO(file << ": " << text);
    CHECK_FALSE(std::regex_search(text, std::regex("--[a-z]")));
  }
}

TEST_CASE("every field that a message of the library names has a flag") {
  std::set<std::string> known;
  for (const cli::FieldFlag& one : cli::field_flags()) known.emplace(one.field);
  const std::regex field("[A-Z][A-Za-z]*(Options|Plan)::[a-z_]+");
  std::size_t named = 0;
  for (const auto& [file, text] : library_strings())
    for (std::sregex_iterator found(text.begin(), text.end(), field), end; found != end; ++found, ++named) {
      INFO(file << ": " << text);
      CHECK(known.count(found->str()) == 1);
    }
  CHECK(named > 20);
}

TEST_CASE("every flag of the table is an option of a command") {
  std::set<std::string> options;
  for (const cli::Command& command : cli::all_commands())
    for (const cli::Option& option : command.options) options.insert(option.name);
  for (const cli::FieldFlag& one : cli::field_flags()) {
    INFO(one.flag);
    CHECK(options.count(std::string(one.flag.substr(one.flag.find("--")))) == 1);
  }
}

TEST_CASE("one problem of the options, met in every file, is told once") {
  const Error problem("CsvOptions::columns", "column 2 has no name", "a name for each column");
  CHECK(std::string(Errors({problem, problem}).what()) == problem.what());
}
