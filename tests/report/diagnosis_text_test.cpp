#include "report/diagnosis_text.hpp"

#include <regex>
#include <string>

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

namespace {
FoundEffect coolant(double confidence, double closes) {
  FoundEffect found;
  found.effect = "coolant";
  found.location = "head_front";
  found.driver = "pump";
  found.confidence = confidence;
  found.closes = closes;
  return found;
}

/// The text on one line, runs of blanks as one.
std::string unbroken(const std::string& text) { return std::regex_replace(text, std::regex("\\s+"), " "); }
}  // namespace

TEST_CASE("a part of the cause is told first, with its place, its driver and what it closes, and is no name",
          "[report]") {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::unknown;
  diagnosis.parts = {coolant(.5, .64)};
  const std::string text = unbroken(cli::diagnosis_text(diagnosis));
  CHECK(
      text.find("The gap is real and part of its cause is found: something acts at head_front, driven by pump, and its "
                "nearest law in the catalogue, coolant, closes 64 % of the squared gap") == 0);
  CHECK(text.find("confidence") == std::string::npos);
}

TEST_CASE("a suspicion is told with its probability, and the machine is not said to lack nothing", "[report]") {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::miscalibration;
  CHECK(unbroken(cli::diagnosis_text(diagnosis)).find("lacks nothing") != std::string::npos);
  diagnosis.suspected = {coolant(.34, .95)};
  const std::string text = unbroken(cli::diagnosis_text(diagnosis));
  CHECK(text.find("lacks nothing") == std::string::npos);
  CHECK(text.find("Suspected - coolant at head_front (driven by pump), 34 %: the best account of what is left") !=
        std::string::npos);
}

TEST_CASE("a number that calibration moved by more than three prior deviations is told as a finding about its part",
          "[report]") {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::miscalibration;
  diagnosis.calibration = {{"offset of T5", "K", 0, 2.7, 5, true}, {"capacity of bed", "J/K", 1e4, 2e4, 2, true}};
  const std::string text = unbroken(cli::diagnosis_text(diagnosis));
  CHECK(text.find("Calibrated beyond belief - offset of T5: 2.7 K instead of 0, 5.0 prior deviations") !=
        std::string::npos);
  CHECK(text.find("lacks nothing") == std::string::npos);
  CHECK(text.find("capacity of bed: 2") == std::string::npos);
}
