#include "thermfit/diagnosis/outputs/diagnose_outputs.hpp"

#include "support/catch.hpp"
#include "support/withheld.hpp"

using namespace thermfit;

namespace {
Diagnosis diagnose(const std::string& name, const PairedOptions& options = {}) {
  return diagnose_paired(withheld_campaign(name, "real"), withheld_campaign(name, "sim"), options);
}
}  // namespace

TEST_CASE("a displacement that jumps with speed is named from the outputs alone, with its size", "[gap]") {
  const Diagnosis found = diagnose("case-05");
  REQUIRE(found.verdict == Verdict::effect);
  CHECK(found.effects[0].effect == "speed-shift");
  CHECK(found.effects[0].location == "displacement");
  CHECK(found.effects[0].driver == "spindle_rpm");
  CHECK(found.gap.output == "Z");
  CHECK(found.gap.rms.with_effect < 1.2 * found.gap.rms.noise);
  CHECK(found.gap.shrink_ci95_percent.low > 80);
  CHECK(found.where.places[0].name == "Z");
}

TEST_CASE("a drifting sensor is named, and the gap is told for that sensor", "[gap]") {
  const Diagnosis found = diagnose("case-07");
  REQUIRE(found.verdict == Verdict::effect);
  CHECK(found.effects[0].effect == "sensor-drift");
  CHECK(found.effects[0].location == "T1");
  CHECK(found.gap.output == "T1");
  CHECK(found.gap.unit == "K");
}

TEST_CASE("no gap and mere miscalibration raise no alarm", "[gap]") {
  CHECK(diagnose("case-12").verdict == Verdict::none);
  CHECK(diagnose("case-23").verdict == Verdict::miscalibration);
}

TEST_CASE("with the true effect taken out of the catalogue no other is named for it with confidence", "[gap]") {
  PairedOptions options;
  options.without = {"speed-shift"};
  const Diagnosis found = diagnose("case-05", options);
  CHECK((found.verdict == Verdict::unknown || found.effects.empty() || found.effects[0].confidence < .5));
}

TEST_CASE("the number of threads does not change the result", "[gap]") {
  PairedOptions one, two;
  one.threads = 1;
  two.threads = 2;
  one.effects = two.effects = {"sensor-drift", "sensor-gain", "speed-shift"};
  const Diagnosis a = diagnose("case-07", one), b = diagnose("case-07", two);
  CHECK(a.effects[0].confidence == b.effects[0].confidence);
  CHECK(a.gap.rms.with_effect == b.gap.rms.with_effect);
}

TEST_CASE("a single batch is diagnosed with the weaker claim said", "[gap]") {
  const Diagnosis found =
      diagnose_paired({withheld_campaign("case-05", "real")[0]}, withheld_campaign("case-05", "sim"));
  CHECK_FALSE(found.gap.held_out);
  bool said = false;
  for (const std::string& claim : found.weaker_claims) said = said || claim.find("one batch only") == 0;
  CHECK(said);
}
