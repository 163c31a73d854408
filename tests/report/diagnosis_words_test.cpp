#include "report/diagnosis_words.hpp"

#include "report/diagnosis_text.hpp"
#include "support/catch.hpp"
#include "thermfit/effects/catalogue.hpp"

using namespace thermfit;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("no word names an input or a part that the machine may not have", "[report]") {
  std::vector<std::string> texts;
  for (const std::string& name : standard_effects().names()) texts.push_back(standard_effects().at(name).meaning());
  for (const ScheduleKind kind :
       {ScheduleKind::speed_stair, ScheduleKind::single_high_speed, ScheduleKind::cool_down, ScheduleKind::toggle,
        ScheduleKind::only, ScheduleKind::idle_day, ScheduleKind::repeat, ScheduleKind::sensor_swap})
    for (const SchedulePurpose purpose :
         {SchedulePurpose::separates, SchedulePurpose::shows, SchedulePurpose::locates, SchedulePurpose::pins}) {
      const PlannedBlock block{kind, purpose, "Q1", "Q2", "run1", 100, 1, 1};
      texts.push_back(cli::schedule_of(block));
      texts.push_back(cli::settings_of(block));
    }
  for (const std::string& text : texts)
    for (const char* word : {"spindle", "speed", "pump", "bearing"}) {
      INFO(text);
      CHECK_FALSE(contains(text, word));
    }
}

TEST_CASE("what closes most of the gap is not ruled out, and one batch leaves nothing out", "[report]") {
  for (const bool held_out : {true, false}) {
    Diagnosis diagnosis;
    diagnosis.gap.held_out = held_out;
    diagnosis.ruled_out = {{"radiation", "bed", RuledOutBy::remains, .7},
                           {"play", "displacement", RuledOutBy::share, .1}};
    const std::string text = cli::diagnosis_text(diagnosis);
    const std::size_t ruled = text.find("Ruled out");
    REQUIRE(ruled != std::string::npos);
    CHECK(text.find("radiation") < ruled);
    CHECK(text.find("play") > ruled);
    CHECK(contains(text, "not used for fitting") == held_out);
    CHECK_FALSE(contains(text, "held-out"));
  }
}

TEST_CASE("a remedy says what to write, on the side where it is wrong", "[report]") {
  DataProblem problem;
  problem.kind = DataProblem::Kind::unit;
  problem.names = {"Z"};
  problem.unit = "mm";
  problem.figure = 1e-3;
  CHECK(contains(cli::remedy_of(problem, SimulatorKind::outputs), "--units 'Z=mm' --sim-units 'Z=um'"));
  CHECK(contains(cli::remedy_of(problem, SimulatorKind::network), "\"channels\": {\"Z\": {\"unit\": \"mm\"}}"));
  problem.side = DataProblem::Side::simulated;
  CHECK(cli::remedy_of(problem, SimulatorKind::outputs).find("--sim-units 'Z=mm'") == 0);
  CHECK(contains(cli::remedy_of(problem, SimulatorKind::network), "multiply them by 1000"));
  problem.batches = {"K04"};
  CHECK(contains(cli::remedy_of(problem, SimulatorKind::outputs), "in the header of K04: Z [mm]"));
  problem = {};
  problem.kind = DataProblem::Kind::clock_unit;
  problem.figure = 60;
  CHECK(contains(cli::remedy_of(problem, SimulatorKind::network), "--time-unit s; "));
  problem.side = DataProblem::Side::either;
  CHECK(contains(cli::what_of(problem), "one side"));
}
