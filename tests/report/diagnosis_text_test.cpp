#include "report/diagnosis_text.hpp"

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("an effect of one's own is told by its meaning, its place and its driver", "[report]") {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::effect;
  FoundEffect found;
  found.effect = "open-door";
  found.location = "ambient";
  found.driver = "time";
  found.meaning = "cold air comes in";
  found.confidence = .97;
  diagnosis.effects = {found};
  CHECK(cli::diagnosis_text(diagnosis).find("t ambient cold air comes in (open-door driven by time") !=
        std::string::npos);
}
