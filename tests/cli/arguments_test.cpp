#include "cli/arguments.hpp"

#include "support/catch.hpp"

using thermfit::cli::Arguments;
using thermfit::cli::Option;
using thermfit::cli::UsageError;

namespace {
const std::vector<Option> options{{"--components", "N", "latent variables", 0, false},
                                  {"--json", "", "machine output", 0, false},
                                  {"--output", "FILE", "write there", 'o', false},
                                  {"--temperatures", "NAME,…", "points", 0, true}};
}

TEST_CASE("options are read as --name value, --name=value and by their letter", "[cli]") {
  const Arguments arguments({"--components", "2", "a.csv", "-o", "m.json", "--temperatures=T1,T2", "--json"}, options);
  CHECK(arguments.integer("--components", 1, 9) == 2);
  CHECK(arguments.value("--output") == "m.json");
  CHECK(arguments.list("--temperatures") == std::vector<std::string>{"T1", "T2"});
  CHECK(arguments.has("--json"));
  CHECK(arguments.positionals() == std::vector<std::string>{"a.csv"});
}

TEST_CASE("a negative number and a lone dash are no options", "[cli]") {
  const Arguments arguments({"-", "-3.5", "--", "--json"}, options);
  CHECK(arguments.positionals() == std::vector<std::string>{"-", "-3.5", "--json"});
  CHECK_FALSE(arguments.has("--json"));
}

TEST_CASE("a mistyped option names the nearest one", "[cli]") {
  try {
    Arguments({"--componets", "2"}, options);
    FAIL("accepted");
  } catch (const UsageError& error) {
    CHECK(std::string(error.what()) == "unknown option --componets; did you mean --components?");
  }
}

TEST_CASE("a missing value, a surplus value and a second occurrence are refused", "[cli]") {
  CHECK_THROWS_AS(Arguments({"--components"}, options), UsageError);
  CHECK_THROWS_AS(Arguments({"--components", "--json"}, options), UsageError);
  CHECK_THROWS_AS(Arguments({"--json=1"}, options), UsageError);
  CHECK_THROWS_AS(Arguments({"--components", "1", "--components", "2"}, options), UsageError);
  CHECK_THROWS_AS(Arguments({"--components", "0"}, options).integer("--components", 1, 9), UsageError);
  CHECK_THROWS_AS(Arguments({"--components", "2x"}, options).integer("--components", 1, 9), UsageError);
}

TEST_CASE("a backslash keeps a comma inside a name of a list", "[cli]") {
  const Arguments arguments({"--temperatures", R"(Oil\, in,T2)"}, options);
  CHECK(arguments.list("--temperatures") == std::vector<std::string>{"Oil, in", "T2"});
}
