#include "blind/generator/case.hpp"
#include "support/catch.hpp"

using namespace blind;

// A weak case may hide in what calibration leaves, and where an effect is bounded and small (missing-expansion) most
// cases are weak: the others are drawn anew until they show. So one seed proves nothing; a few do.
TEST_CASE("every effect of the catalogue has detectable cases, and all that are not weak are") {
  for (const auto& [name, law] : known_effects()) {
    INFO(name);
    double clearest = 0;
    for (std::uint64_t seed = 12; seed < 20 && clearest < 8; ++seed) {
      INFO("seed " << seed);
      const auto made = make_case(seed, 1, Card{{name}});
      const auto& truth = made.truth["truth"][0];
      CHECK(truth["effect"] == name);
      const double detectability = truth["detectability"];
      CHECK((detectability >= 8 || made.truth["strength"] == "weak"));
      clearest = std::max(clearest, detectability);
      for (const auto& [file, text] : made.batches) CHECK(text.find("nan") == std::string::npos);
    }
    CHECK(clearest >= 8);
  }
}
