#include "report/diagnosis_json.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "support/catch.hpp"

using namespace thermfit;

namespace {
Diagnosis example() {
  Diagnosis diagnosis;
  diagnosis.machine = "case-01";
  diagnosis.batches = {"K01"};
  diagnosis.verdict = Verdict::effect;
  FoundEffect found;
  found.effect = "friction-law";
  found.location = "front bearing friction";
  found.driver = "spindle_rpm";
  found.confidence = .97;
  found.parameters = {{"P2", "W", 12.3456789, 1.5}, {"m", "1", 2, -1}};
  found.alternatives = {{"forced-convection", "head_front", "", .02}};
  diagnosis.effects = {found};
  diagnosis.gap.output = "Z";
  diagnosis.gap.unit = "um";
  diagnosis.gap.rms = {7.1, 2.7, .33, .27};
  diagnosis.gap.per_batch = {{"K01", {7, 2, 1, .3}}};
  diagnosis.gap.per_sensor = {{"T1", "K", {.5, .2, .1, .05}}};
  diagnosis.where.stages = {{"heat", .9}};
  diagnosis.where.places = {{"head_front", .8}};
  diagnosis.where.conditions = {{"spindle_rpm", "", true, true, {4500, 6000}, .7, 3, .3},
                                {"phase", "warm-up", false, false, {}, .6, 2, .2}};
  diagnosis.where.frequency = {{{300, std::numeric_limits<double>::infinity()}, .4}};
  return diagnosis;
}

nlohmann::ordered_json document_of(const Diagnosis& diagnosis) {
  return nlohmann::ordered_json::parse(cli::diagnosis_json(diagnosis));
}
}  // namespace

TEST_CASE("a diagnosis prints the keys of thermfit-diagnosis/1 with the meaning the format gives them", "[report]") {
  const auto json = document_of(example());
  CHECK(json["format"] == "thermfit-diagnosis/1");
  CHECK(json["verdict"] == "effect");
  CHECK(json["effects"][0]["driver"] == "spindle_rpm");
  CHECK(json["effects"][0]["parameters"]["P2"]["value"] == 12.3457);
  CHECK(json["effects"][0]["parameters"]["P2"]["unit"] == "W");
  CHECK(json["effects"][0]["parameters"]["m"]["standard_error"].is_null());
  CHECK(json["effects"][0]["alternatives"][0] ==
        nlohmann::ordered_json({{"effect", "forced-convection"}, {"location", "head_front"}, {"confidence", .02}}));
  CHECK(json["gap"]["with_effect"] == .33);
  CHECK(json["gap"]["shrink_ci95_percent"].size() == 2);
  CHECK(json["gap"]["per_batch"][0]["batch"] == "K01");
  CHECK(json["gap"]["per_sensor"]["T1"]["calibrated"] == .2);
  CHECK_FALSE(json["gap"].contains("S_mean"));
  CHECK(json["where"]["stages"][0]["stage"] == "heat");
  CHECK(json["where"]["places"][0]["place"] == "head_front");
  CHECK(json["where"]["conditions"][0]["range"] == nlohmann::ordered_json({4500., 6000.}));
  CHECK(json["where"]["conditions"][1]["level"] == "warm-up");
  CHECK(json["where"]["frequency"][0]["period_min"][1].is_null());
  CHECK(json["remaining"].contains("white"));
  CHECK(json["next_experiment"]["plan"].is_array());
}

TEST_CASE("a gap of temperatures stands under no key in um", "[report]") {
  Diagnosis diagnosis = example();
  diagnosis.remaining.unexplained = .5;
  CHECK(document_of(diagnosis)["remaining"]["unexplained_um"] == .5);
  diagnosis.gap.output = "";
  diagnosis.gap.unit = "K";
  CHECK(document_of(diagnosis)["gap"]["output"] == "temperatures");
  CHECK_FALSE(document_of(diagnosis)["remaining"].contains("unexplained_um"));
  CHECK(document_of(diagnosis)["remaining"]["unexplained"] == .5);
  CHECK(document_of(diagnosis)["remaining"]["unit"] == "K");
}

TEST_CASE("each verdict prints its own word", "[report]") {
  Diagnosis diagnosis;
  for (const auto& [verdict, word] :
       std::vector<std::pair<Verdict, std::string>>{{Verdict::none, "none"},
                                                    {Verdict::miscalibration, "miscalibration"},
                                                    {Verdict::effect, "effect"},
                                                    {Verdict::ambiguous, "ambiguous"},
                                                    {Verdict::unknown, "unknown"}}) {
    diagnosis.verdict = verdict;
    CHECK(document_of(diagnosis)["verdict"] == word);
  }
}

TEST_CASE("parts of the cause and suspicions stand under their own keys, with the share that they close", "[report]") {
  Diagnosis diagnosis = example();
  diagnosis.verdict = Verdict::unknown;
  FoundEffect found = diagnosis.effects[0];
  found.closes = .64;
  diagnosis.effects = {};
  diagnosis.parts = {found};
  const auto json = document_of(diagnosis);
  CHECK(json["effects"].empty());
  CHECK(json["parts"][0]["effect"] == "friction-law");
  CHECK(json["parts"][0]["closes"] == .64);
  CHECK(json["suspected"].empty());
}
