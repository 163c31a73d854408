/// Two heaters on a board, measured. Known from the literature: the thermometer follows its heater late (about 18 s),
/// the heaters exchange heat, radiation adds almost nothing; runs of different days differ by 1 to 4 K without known
/// cause.

#include "real/heater_board.hpp"

#include "support/shared_data.hpp"

TEST_CASE(
    "on a measured board the lag of its thermometer and the missing link are named, and unseen runs agree better") {
  REQUIRE_SHARED_DATA(data);
  const Bench bench(data + "/real/tclab/real");
  const std::string machine = bench.write("machine.json", heater_board());
  const std::vector<std::string> one_day{"sin_5_run_1", "sin_5_run_2", "step_run_1", "step_run_2"},
      other_day{"sin_5_run_2", "sin_5_run_3", "step_run_1", "step_run_3"};
  for (const auto& [seen, unseen] : {std::pair{one_day, std::vector<std::string>{"sin_5_run_3", "step_run_3"}},
                                     std::pair{other_day, std::vector<std::string>{"sin_5_run_1", "step_run_2"}}}) {
    const std::string with_effects = bench.path("with_effects.json"), calibrated = bench.path("calibrated.json");
    const nlohmann::json said = bench.diagnose(machine, bench.runs(seen), {"--write", with_effects});
    CHECK(said.at("effects").size() == 2);
    CHECK(names(said, "missing-link", "heater1-heater2"));
    CHECK(names(said, "sensor-lag", "T1"));
    for (const auto& one : said.at("effects"))
      if (one.at("effect") == "sensor-lag") CHECK(one.at("parameters").at("lag_s").at("value") == Approx(18).margin(3));

    bench.calibrate(machine, bench.runs(seen), calibrated);
    double before = 0, after = 0;
    for (const std::string& run : bench.runs(unseen)) {
      before += std::pow(bench.gap_K(calibrated, run), 2) / 2;
      after += std::pow(bench.gap_K(with_effects, run), 2) / 2;
    }
    const double shrink = 100 * (1 - std::sqrt(after / before));
    const auto interval = said.at("gap").at("shrink_ci95_percent");
    WARN("unseen runs: " << std::sqrt(before) << " K calibrated, " << std::sqrt(after)
                         << " K with both effects, shrink " << shrink << " %; said "
                         << said.at("gap").at("shrink_percent") << " % " << interval
                         << "; remains: " << said.at("remaining").at("looks_like"));
    CHECK(shrink > 20);
    CHECK(shrink > interval.at(0).get<double>() - 10);
    // What remains is what runs with the same inputs differ by, from day to day, and no cause is named for it.
    CHECK(said.at("gap").at("noise") > 0.5);
    CHECK(said.at("gap").at("with_effect").get<double>() < 1.5 * said.at("gap").at("noise").get<double>());
  }
}

TEST_CASE("radiation is not named on the measured board, even where nothing else may be") {
  REQUIRE_SHARED_DATA(data);
  const Bench bench(data + "/real/tclab/real");
  const nlohmann::json said = bench.diagnose(bench.write("machine.json", heater_board()),
                                             bench.runs({"sin_5_run_1", "sin_5_run_2", "step_run_1", "step_run_2"}),
                                             {"--effects", "radiation"});
  CHECK(said.at("verdict") == "unknown");
  CHECK(said.at("effects").empty());
}

TEST_CASE("no name is given with certainty where one run alone drives an input, or where there is one run") {
  REQUIRE_SHARED_DATA(data);
  const Bench bench(data + "/real/tclab/real");
  const std::string machine = bench.write("machine.json", heater_board());
  const std::vector<std::string> known{"missing-link", "sensor-lag"};

  const nlohmann::json all = bench.diagnose(
      machine, bench.runs({"apm_mimo_599", "sin_5_run_1", "sin_5_run_2", "sin_5_run_3", "step_run_1", "step_run_2"}));
  CHECK(confidence_in_others(all, known) <= 0.5);
  CHECK(all.at("weaker_claims").dump().find("Input Q2 is on in batch apm_mimo_599 alone") != std::string::npos);

  const nlohmann::json alone = bench.diagnose(machine, bench.runs({"apm_mimo_599"}));
  CHECK(alone.at("verdict") != "effect");
  CHECK(confidence_in_others(alone, {}) <= 0.5);
  CHECK(alone.at("weaker_claims").dump().find("One batch only") != std::string::npos);

  const nlohmann::json steps = bench.diagnose(machine, bench.runs({"step_run_1", "step_run_2", "step_run_3"}));
  CHECK(confidence_in_others(steps, known) <= 0.5);  // one constant level of one heater
}
