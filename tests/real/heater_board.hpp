#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "support/catch.hpp"
#include "support/scratch_folder.hpp"
#include "thermfit/io/csv/reader.hpp"

/// A board with two heaters and two thermometers as a simulator would describe it before it has seen a measurement: one
/// node a heater, numbers from the literature (capacity 6.2 J/K, .0417 W/K to the room, 3.2 W), no link, no lag.
inline nlohmann::json heater_board() {
  return nlohmann::json::parse(R"({
    "format": "thermfit-machine/1", "name": "two heaters on a board", "reference_temperature_C": 20,
    "ambient": {"first_sample_of": "T2"},
    "nodes": [{"name": "heater1", "capacity_J_per_K": 6.2, "ambient_W_per_K": 0.0417},
              {"name": "heater2", "capacity_J_per_K": 6.2, "ambient_W_per_K": 0.0417}],
    "heat_sources": [
      {"name": "heater 1", "input": "Q1", "scale": 100, "exponent": 1, "power_W": 3.2, "into": {"heater1": 1}},
      {"name": "heater 2", "input": "Q2", "scale": 100, "exponent": 1, "power_W": 3.2, "into": {"heater2": 1}}],
    "sensors": {"T1": {"node": "heater1"}, "T2": {"node": "heater2"}},
    "initial": "measured"})");
}

/// Commands as a user would give them, on files of a folder of its own.
class Bench {
 public:
  explicit Bench(const std::string& runs) : runs_(runs) {}

  /// Paths of measured runs.
  std::vector<std::string> runs(const std::vector<std::string>& names) const {
    std::vector<std::string> paths;
    for (const std::string& name : names) paths.push_back(runs_ + "/" + name + ".csv");
    return paths;
  }

  std::string path(const std::string& name) const { return folder_.path(name); }
  std::string write(const std::string& name, const nlohmann::json& document) const {
    return folder_.write(name, document.dump(1));
  }
  std::string write_text(const std::string& name, const std::string& text) const { return folder_.write(name, text); }

  /// The document of `thermfit diagnose machine batches --json` and further words.
  nlohmann::json diagnose(const std::string& machine, const std::vector<std::string>& batches,
                          const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"diagnose", machine, "--json", "-o", path("diagnosis.json")};
    words.insert(words.end(), batches.begin(), batches.end());
    words.insert(words.end(), more.begin(), more.end());
    REQUIRE(thermfit::cli::run(words) <= 1);
    std::ifstream file(path("diagnosis.json"));
    const nlohmann::json said = nlohmann::json::parse(file);
    UNSCOPED_INFO(said.at("verdict").dump() << ' ' << said.at("effects").dump() << ' ' << said.at("gap").dump());
    return said;
  }

  void calibrate(const std::string& machine, const std::vector<std::string>& batches, const std::string& to) const {
    std::vector<std::string> words{"calibrate", machine, "--keep-failed", "-o", to};
    words.insert(words.end(), batches.begin(), batches.end());
    REQUIRE(thermfit::cli::run(words) <= 1);
  }

  /// rms of measured minus simulated over all temperatures of one run, K.
  double gap_K(const std::string& machine, const std::string& run) const {
    const std::string simulated = path("simulated.csv");
    REQUIRE(thermfit::cli::run({"simulate", machine, run, "--decimals", "4", "-o", simulated}) == 0);
    const thermfit::Matrix difference = thermfit::read_campaign({run}).batches[0].temperatures.values -
                                        thermfit::read_campaign({simulated}).batches[0].temperatures.values;
    return std::sqrt(difference.squaredNorm() / static_cast<double>(difference.size()));
  }

 private:
  std::string runs_;
  ScratchFolder folder_;
};

inline bool names(const nlohmann::json& said, const std::string& effect, const std::string& location = "") {
  for (const auto& one : said.at("effects"))
    if (one.at("effect") == effect && (location.empty() || one.at("location") == location)) return true;
  return false;
}

/// The largest confidence with which anything but `true_effects` is named.
inline double confidence_in_others(const nlohmann::json& said, const std::vector<std::string>& true_effects) {
  double largest = 0;
  for (const auto& one : said.at("effects"))
    if (std::find(true_effects.begin(), true_effects.end(), one.at("effect")) == true_effects.end())
      largest = std::max(largest, one.at("confidence").get<double>());
  return largest;
}
