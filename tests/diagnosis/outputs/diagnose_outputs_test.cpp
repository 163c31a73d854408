#include "thermfit/diagnosis/outputs/diagnose_outputs.hpp"

#include "support/catch.hpp"
#include "support/small_machine.hpp"
#include "support/withheld.hpp"

using namespace thermfit;

namespace {
Diagnosis diagnose(const std::string& name, const OutputsOptions& options = {}) {
  return diagnose_outputs(withheld_campaign(name, "real"), withheld_campaign(name, "sim"), standard_effects(), options);
}

/// A shop door that is open for an hour and lets cold air in.
class OpenDoor : public Effect {
 public:
  std::string name() const override { return "open-door"; }
  Stage stage() const override { return Stage::boundary; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting&) const override { return {}; }
  std::vector<EffectParameter> parameters(const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    return {linear_parameter("drop_K", "K", 3)};
  }
  void act(ThermalSystem& system, const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    system.ambient_becomes(
        [](const Moment& now, const double* p) { return now.ambient_degC - (open(now.time_s) ? p[0] : 0); });
  }
  void trace(OutputTraces& traces) const override {
    traces.heat_flow("ambient", "time",
                     [](const PairedBatch& batch, Index k) { return open(batch.time_s(k)) ? 1. : 0.; });
  }
  std::string meaning() const override { return "cold air comes in"; }
  PlannedBlock shown_by(const ThermalNetwork::AddedEffect&, double batch_hours) const override {
    return block_that_shows(ScheduleKind::toggle, "shop door", 2 * batch_hours);
  }

 private:
  static bool open(double time_s) { return time_s > 7200 && time_s < 10800; }
};
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
  OutputsOptions options;
  options.without = {"speed-shift"};
  const Diagnosis found = diagnose("case-05", options);
  CHECK((found.verdict == Verdict::unknown || found.effects.empty() || found.effects[0].confidence < .5));
}

TEST_CASE("the number of threads does not change the result", "[gap]") {
  OutputsOptions one, two;
  one.threads = 1;
  two.threads = 2;
  one.effects = two.effects = {"sensor-drift", "sensor-gain", "speed-shift"};
  const Diagnosis a = diagnose("case-07", one), b = diagnose("case-07", two);
  CHECK(a.effects[0].confidence == b.effects[0].confidence);
  CHECK(a.gap.rms.with_effect == b.gap.rms.with_effect);
}

TEST_CASE("a single batch is diagnosed with the weaker claim said", "[gap]") {
  const Diagnosis found = diagnose_outputs({withheld_campaign("case-05", "real")[0]},
                                           withheld_campaign("case-05", "sim"), standard_effects());
  CHECK_FALSE(found.gap.held_out);
  bool said = false;
  for (const WeakerClaim& claim : found.weaker_claims) said = said || claim.kind == WeakerClaim::Kind::one_batch;
  CHECK(said);
}

TEST_CASE("an effect of one's own is found in the outputs, told by its meaning, and shown by its own schedule",
          "[gap]") {
  EffectLibrary library = standard_effects();
  library.add(std::make_shared<OpenDoor>());
  ThermalNetwork machine = small_machine();
  const Campaign nominal = small_campaign(machine, 4);
  machine.effects = {{"open-door", "ambient", "time", {{"drop_K", 6}}}};
  const Campaign real = small_campaign(machine, 4, 1, library);

  const Diagnosis found = diagnose_outputs(real, nominal, library);
  REQUIRE(found.effects.size() == 1);
  CHECK(found.effects[0].effect == "open-door");
  CHECK(found.effects[0].location == "ambient");
  CHECK(found.effects[0].meaning == "cold air comes in");
  CHECK(diagnose_outputs(real, nominal, standard_effects()).verdict != Verdict::effect);

  FoundEffect doubtful = found.effects[0];
  doubtful.alternatives = {{"radiation", "T1", "", .2}};
  const NextExperiment next = experiment_by_kind(doubtful, library, 6);
  REQUIRE(next.plan.size() == 2);
  CHECK(next.plan[0].kind == ScheduleKind::toggle);
  CHECK(next.plan[0].subject == "shop door");
  CHECK(next.plan[0].machine_hours == 12);
  CHECK(next.plan[1].kind == ScheduleKind::cool_down);
}
