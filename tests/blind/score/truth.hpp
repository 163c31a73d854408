#pragma once

/// What a case holds, from its truth.json or from the answers.json beside its folder.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace blind {

using Json = nlohmann::json;

struct TrueEffect {
  std::vector<std::string> names;      ///< effect and what counts as the same
  std::vector<std::string> locations;  ///< all acceptable
};

struct Truth {
  std::string family;   ///< what the table lists it under
  std::string verdict;  ///< none, miscalibration, effect, unknown
  std::vector<TrueEffect> effects;
  std::vector<std::string> without;  ///< taken out of the catalogue
  bool poor = false;                 ///< one speed only: "cannot tell" is a right answer
  bool detectable = true;            ///< calibration and noise cannot hide any of it
};

struct Case {
  std::string name;
  std::filesystem::path folder;
  Truth truth;
};

inline Json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  return Json::parse(file);
}

/// The truth as another simulator's outputs can show it: a place is a thermometer on it, or next to it where it has
/// none; a link is any two of them, a source is one.
inline Truth seen_in_outputs(Truth truth, const Json& machine) {
  const auto on = [&](const std::vector<std::string>& nodes) {
    std::vector<std::string> columns;
    for (const auto& [column, sensor] : machine.at("sensors").items())
      if (std::find(nodes.begin(), nodes.end(), sensor.value("node", "")) != nodes.end()) columns.push_back(column);
    return columns;
  };
  for (TrueEffect& effect : truth.effects) {
    std::vector<std::string> nodes, beside;
    for (const Json& node : machine.at("nodes")) {
      const std::string name = node.at("name");
      for (const std::string& place : effect.locations)
        if (place.find(name) != std::string::npos) nodes.push_back(name);
    }
    if (on(nodes).empty())
      for (const Json& link : machine.at("links")) {
        const std::string a = link.at("between").at(0), b = link.at("between").at(1);
        for (const std::string& node : nodes)
          if (node == a || node == b) beside.push_back(node == a ? b : a);
      }
    const std::vector<std::string> columns = on(on(nodes).empty() ? beside : nodes);
    for (const std::string& one : columns) {
      effect.locations.push_back(one);
      for (const std::string& other : columns) effect.locations.push_back(one + "-" + other);
    }
    for (const Json& source : machine.value("heat_sources", Json::array()))
      effect.locations.push_back("source driven by " + source.value("input", ""));
  }
  return truth;
}

/// Left after calibration, in units of the floor, from which an effect counts as detectable.
constexpr double detectable_from = 8;

inline Truth truth_of(const Json& given) {
  Truth truth;
  for (const Json& one : given.at("truth")) {
    truth.family += (truth.family.empty() ? "" : " + ") + one.at("family").get<std::string>();
    truth.verdict = one.value("verdict", "effect");
    truth.detectable = truth.detectable && one.value("detectability", detectable_from) >= detectable_from;
    if (!one.contains("effect")) continue;
    TrueEffect effect;
    effect.names = {one.at("effect").get<std::string>()};
    if (one.contains("also"))
      for (const Json& name : one["also"]) effect.names.push_back(name);
    for (const Json& place : one.at("location")) effect.locations.push_back(place);
    truth.effects.push_back(effect);
  }
  if (given.contains("without"))
    for (const Json& name : given["without"]) truth.without.push_back(name);
  truth.poor = given.value("campaign", "") == "one-speed";
  return truth;
}

/// All cases below `folder`, in the order of their names.
inline std::vector<Case> find_cases(const std::filesystem::path& folder) {
  std::vector<Case> cases;
  const auto answers = folder / "answers.json";
  if (std::filesystem::exists(answers)) {
    for (const Json& one : read_json(answers)) {
      const std::string name = one.at("case");
      cases.push_back({name, folder / name, truth_of(one)});
    }
  } else {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (std::filesystem::exists(entry.path() / "truth.json"))
        cases.push_back(
            {entry.path().filename().string(), entry.path(), truth_of(read_json(entry.path() / "truth.json"))});
  }
  std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.name < b.name; });
  return cases;
}

}  // namespace blind
