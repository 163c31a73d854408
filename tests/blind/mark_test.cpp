#include "blind/score/mark.hpp"

#include "blind/score/summary.hpp"
#include "support/catch.hpp"

using namespace blind;

namespace {

const TrueEffect coolant{{"coolant"}, {"head_front", "head_tip"}};

Truth one_effect() {
  Truth truth;
  truth.family = "coolant";
  truth.verdict = "effect";
  truth.effects = {coolant};
  return truth;
}

Json report(const std::string& verdict, const std::string& effects) {
  return Json::parse(
      R"({"verdict": ")" + verdict + R"(", "effects": )" + effects +
      R"(, "gap": {"calibrated": 4, "with_effect": 1, "shrink_percent": 75, "shrink_ci95_percent": [60, 80]}})");
}

}  // namespace

TEST_CASE("the true effect at a neighbouring place is right, elsewhere only the name is") {
  const Truth truth = one_effect();
  auto seen = mark(truth, report("effect", R"([{"effect": "coolant", "location": "head_tip", "confidence": 0.9}])"));
  CHECK(seen.top);
  CHECK(seen.place);
  CHECK(seen.claims.at(0).right);
  seen = mark(truth, report("effect", R"([{"effect": "coolant", "location": "bed", "confidence": 0.9}])"));
  CHECK(seen.top);
  CHECK_FALSE(seen.place);
  CHECK_FALSE(seen.claims.at(0).right);
  CHECK_FALSE(seen.confident_wrong);
  seen = mark(truth, report("effect", R"([{"effect": "coolant", "location": "bed", "confidence": 0.9,
                                           "same_place": ["head_front"]}])"));
  CHECK(seen.place);
}

TEST_CASE("the truth among the alternatives is in the set and not first") {
  const auto seen = mark(one_effect(), report("ambiguous", R"([{"effect": "radiation", "location": "bed",
      "confidence": 0.6, "alternatives": [{"effect": "coolant", "location": "head_front", "confidence": 0.3}]}])"));
  CHECK_FALSE(seen.top);
  CHECK(seen.in_set);
  CHECK(seen.place);
  CHECK(seen.confident_wrong);
}

TEST_CASE("an effect listed under the verdict unknown is not named") {
  const auto seen = mark(one_effect(), report("unknown", R"([{"effect": "coolant", "location": "head_front"}])"));
  CHECK_FALSE(seen.named);
  CHECK_FALSE(seen.in_set);
}

TEST_CASE("the truth as a part of the cause or a suspicion is within what is told, and no name") {
  for (const char* grade : {"parts", "suspected"}) {
    Json document = report("unknown", "[]");
    document[grade] = Json::parse(R"([{"effect": "coolant", "location": "head_tip", "confidence": 0.4}])");
    const auto seen = mark(one_effect(), document);
    CHECK_FALSE(seen.named);
    CHECK_FALSE(seen.in_set);
    CHECK(seen.within);
    CHECK_FALSE(seen.confident_wrong);
    REQUIRE(seen.suspicions.size() == 1);
    CHECK(seen.suspicions[0].right);
  }
}

TEST_CASE("another simulator's outputs show a place by the thermometer on it, or by those next to it") {
  const Json machine = Json::parse(R"({"nodes": [{"name": "head_front"}, {"name": "head_tip"}, {"name": "bed"}],
      "links": [{"between": ["head_front", "bed"]}], "heat_sources": [{"input": "rpm"}],
      "sensors": {"T1": {"node": "bed"}, "T2": {"node": "head_tip"}}})");
  Truth truth = one_effect();
  CHECK(acceptable(seen_in_outputs(truth, machine).effects[0].locations, "T2"));
  CHECK_FALSE(acceptable(seen_in_outputs(truth, machine).effects[0].locations, "T1"));
  truth.effects[0].locations = {"head_front"};
  CHECK(acceptable(seen_in_outputs(truth, machine).effects[0].locations, "T1"));
}

TEST_CASE("of a pair both must be found") {
  Truth truth = one_effect();
  truth.effects.push_back({{"speed-shift"}, {"displacement"}});
  const std::string first = R"({"effect": "coolant", "location": "head_front", "confidence": 0.9})";
  const std::string second = R"({"effect": "speed-shift", "location": "displacement", "confidence": 0.9})";
  CHECK_FALSE(mark(truth, report("effect", "[" + first + "]")).top);
  CHECK(mark(truth, report("effect", "[" + second + "," + first + "]")).top);
}

TEST_CASE("joined places count when each part is acceptable") {
  CHECK(acceptable({"a", "b"}, "a, b"));
  CHECK(acceptable({"a", "b"}, "a+b"));
  CHECK_FALSE(acceptable({"a", "b"}, "a, c"));
  CHECK(acceptable({"a-b"}, "a-b"));
}

TEST_CASE("a name on a null case is a false alarm and miscalibration there is not") {
  Truth truth;
  truth.family = truth.verdict = "none";
  Summary summary;
  summary.add(truth, mark(truth, report("miscalibration", "[]")));
  summary.add(truth, mark(truth, report("effect", R"([{"effect": "coolant", "location": "bed", "confidence": 0.9}])")));
  summary.add(truth, mark(truth, report("none", "[]")));
  const auto figures = summary.figures();
  CHECK(figures.at("false_alarm_none") == Approx(1. / 3));
  CHECK(figures.at("none_right") == Approx(1. / 3));
}

TEST_CASE("confidence that comes true as often as it says has no calibration error") {
  std::vector<Claim> claims;
  for (int i = 0; i < 10; ++i) claims.push_back({.9, i < 9});
  CHECK(calibration_error(claims) == Approx(0).margin(1e-12));
  for (Claim& claim : claims) claim.right = false;
  CHECK(calibration_error(claims) == Approx(.9));
}
