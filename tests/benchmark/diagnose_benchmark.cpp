/// thermfit_diagnose_benchmark [case folder]: what a diagnosis over the whole catalogue costs, and how that grows with
/// batches, rows and nodes. CPU seconds are those of all threads: on a shared machine they tell more than the clock.
/// Starts from data/withheld/case-01: 9 batches of 121 rows, 16 nodes.

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/table.hpp"
#include "thermfit/io/files/atomic_file.hpp"
#include "thermfit/number.hpp"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

struct Campaign {
  Json machine;
  std::vector<Lines> batches;  ///< header, then one line a row
};

Campaign read(const fs::path& folder) {
  Campaign campaign;
  std::ifstream machine(folder / "machine.json");
  campaign.machine = Json::parse(machine);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder / "real")) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    std::ifstream stream(file);
    campaign.batches.emplace_back();
    for (std::string line; std::getline(stream, line);) campaign.batches.back().push_back(line);
  }
  return campaign;
}

Campaign with_batches(Campaign campaign, std::size_t count) {
  campaign.batches.resize(std::min(count, campaign.batches.size()));
  return campaign;
}

/// Every `keep`-th row.
Campaign thinned(Campaign campaign, std::size_t keep) {
  for (Lines& lines : campaign.batches) {
    Lines kept{lines.front()};
    for (std::size_t row = 1; row < lines.size(); row += keep) kept.push_back(lines[row]);
    lines = kept;
  }
  return campaign;
}

/// The `count` heaviest nodes cut into two halves, well joined: the same machine with more nodes.
Campaign with_halves(Campaign campaign, std::size_t count) {
  Json& nodes = campaign.machine["nodes"];
  std::vector<std::size_t> order(nodes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto capacity = [&](std::size_t i) { return nodes[i]["capacity_J_per_K"].get<double>(); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return capacity(a) > capacity(b); });
  for (std::size_t i = 0; i < count; ++i) {
    Json half = nodes[order[i]];
    for (const char* key : {"capacity_J_per_K", "ambient_W_per_K"}) half[key] = half[key].get<double>() / 2;
    nodes[order[i]] = half;
    const std::string name = half["name"];
    half["name"] = name + "_far";
    nodes.push_back(half);
    campaign.machine["links"].push_back({{"between", {name, name + "_far"}}, {"conductance_W_per_K", 200}});
  }
  return campaign;
}

struct Cost {
  double seconds, cpu_seconds;
};

Cost cost_of(const Campaign& campaign) {
  const fs::path folder = fs::temp_directory_path() / "thermfit_diagnose_benchmark";
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::vector<std::string> words{"diagnose", (folder / "machine.json").string()};
  thermfit::write_atomically(words.back(), campaign.machine.dump(1));
  for (std::size_t b = 0; b < campaign.batches.size(); ++b) {
    std::string text;
    for (const std::string& line : campaign.batches[b]) text += line + "\n";
    words.push_back((folder / ("K" + std::to_string(10 + b) + ".csv")).string());
    thermfit::write_atomically(words.back(), text);
  }
  words.insert(words.end(), {"--json", "-o", (folder / "diagnosis.json").string()});
  const auto before = std::chrono::steady_clock::now();
  const std::clock_t cpu_before = std::clock();
  const int exit = thermfit::cli::run(words);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
  const double cpu = static_cast<double>(std::clock() - cpu_before) / CLOCKS_PER_SEC;
  fs::remove_all(folder);
  if (exit > 1) throw std::runtime_error("the diagnosis failed");
  return {took.count(), cpu};
}

}  // namespace

int main(int count, char** words) {
  try {
    const Campaign base = read(count > 1 ? words[1] : THERMFIT_SOURCE_DIR "/data/withheld/case-01");
    thermfit::cli::Table table({"campaign", "batches", "rows", "nodes", "seconds", "CPU seconds"});
    const auto add = [&](const std::string& what, const Campaign& campaign) {
      const Cost cost = cost_of(campaign);
      table.add({what, std::to_string(campaign.batches.size()), std::to_string(campaign.batches[0].size() - 1),
                 std::to_string(campaign.machine["nodes"].size()), thermfit::fixed_text(cost.seconds, 2),
                 thermfit::fixed_text(cost.cpu_seconds, 2)});
    };
    add("as given", base);
    for (const std::size_t batches : {3u, 5u, 7u}) add("fewer batches", with_batches(base, batches));
    for (const std::size_t keep : {2u, 4u}) add("fewer rows", thinned(base, keep));
    for (const std::size_t more : {4u, 8u}) add("more nodes", with_halves(base, more));
    std::cout << table.text();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "thermfit_diagnose_benchmark: " << error.what() << "\n";
    return 2;
  }
}
