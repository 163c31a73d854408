#include "blind/generator/case.hpp"
#include "support/catch.hpp"

using namespace blind;

TEST_CASE("every effect of the catalogue leaves something that calibration cannot swallow") {
  for (const auto& [name, law] : known_effects()) {
    INFO(name);
    const auto made = make_case(12, 1, Card{{name}});
    const auto& truth = made.truth["truth"][0];
    CHECK(truth["effect"] == name);
    CHECK(truth["detectability"].get<double>() > 2);
    for (const auto& [file, text] : made.batches) CHECK(text.find("nan") == std::string::npos);
  }
}
