/// thermfit_blind_score: runs a diagnosis over blind cases and prints how it did. Usage in tests/blind/README.md.

#include <iostream>
#include <mutex>

#include "run.hpp"
#include "summary.hpp"

namespace {

struct Options {
  blind::Runner runner;
  std::vector<std::string> folders;
  std::vector<std::string> demands;  ///< `top1>=.9`
  int jobs = 2;
  std::size_t first = 1, count = 100000;
  bool oracle = false, each = false, both_ways = false;
};

Options parse(const std::vector<std::string>& words) {
  Options options;
  options.runner.arguments = {"diagnose"};
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const auto value = [&]() -> const std::string& {
      if (i + 1 >= words.size()) throw std::runtime_error(word + " needs a value");
      return words[++i];
    };
    const auto count = [&] {
      const auto number = thermfit::parse_number(value());
      if (!number || *number < 1) throw std::runtime_error(word + ": not a count");
      return static_cast<std::size_t>(*number);
    };
    if (word == "--thermfit")
      options.runner.program = value();
    else if (word == "--baseline")
      options.runner.arguments = {value()};
    else if (word == "--results")
      options.runner.results = value();
    else if (word == "--jobs")
      options.jobs = static_cast<int>(std::min<std::size_t>(2, count()));
    else if (word == "--first")
      options.first = count();
    else if (word == "--count")
      options.count = count();
    else if (word == "--timeout")
      options.runner.seconds_allowed = static_cast<int>(count());
    else if (word == "--oracle")
      options.oracle = true;
    else if (word == "--fresh")
      options.runner.fresh = true;
    else if (word == "--each")
      options.each = true;
    else if (word == "--both-ways")
      options.both_ways = true;
    else if (word == "--require")
      options.demands.push_back(value());
    else if (word.rfind("--", 0) == 0)
      throw std::runtime_error("not understood: " + word);
    else
      options.folders.push_back(word);
  }
  if (options.runner.program.empty() || options.runner.results.empty() || options.folders.empty())
    throw std::runtime_error("usage: thermfit_blind_score --thermfit PROGRAM --results DIR FOLDER…");
  if (options.jobs > 1 && options.runner.arguments[0] == "diagnose")
    options.runner.arguments.insert(options.runner.arguments.end(), {"--threads", "1"});
  return options;
}

/// `name>=bound` or `name<=bound`; a figure that does not exist does not meet it.
bool meets(const std::map<std::string, double>& figures, const std::string& demand) {
  const auto cut = demand.find_first_of("<>");
  if (cut == std::string::npos || !figures.count(demand.substr(0, cut)))
    throw std::runtime_error("--require " + demand + ": no such figure");
  const auto bound = thermfit::parse_number(demand.substr(cut + 2));
  if (!bound) throw std::runtime_error("--require " + demand + ": no bound");
  const double value = figures.at(demand.substr(0, cut));
  return demand[cut] == '<' ? value <= *bound : value >= *bound;
}

/// Diagnoses the cases one way and, where asked for, prints a line each.
blind::Summary scored(const std::vector<blind::Case>& cases, const blind::Runner& runner, const Options& options) {
  std::mutex lock;
  const auto marks =
      blind::judge_all(cases, runner, options.oracle && !runner.by_outputs, options.jobs, [&](std::size_t done) {
        const std::lock_guard<std::mutex> guard(lock);
        if (done % 20 == 0) std::cerr << "thermfit_blind_score: " << done << " of " << cases.size() << "\n";
      });
  blind::Summary summary;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    summary.add(cases[i].truth, marks[i]);
    if (!options.each) continue;
    const blind::Mark& mark = marks[i];
    const bool good = cases[i].truth.verdict == "effect" ? mark.top && mark.place : mark.verdict_right;
    std::cout << cases[i].name
              << (good          ? "  ok    "
                  : mark.failed ? "  FAIL  "
                  : mark.in_set ? "  set   "
                  : mark.within ? "  told  "
                                : "  wrong ")
              << cases[i].truth.family << (cases[i].truth.detectable ? "" : " (hidden)") << ": " << mark.verdict << " "
              << mark.said << (mark.claims.empty() ? "" : " " + thermfit::fixed_text(mark.claims[0].confidence, 2))
              << " shrink " << thermfit::fixed_text(mark.shrink_percent, 0);
    if (mark.interval)
      std::cout << " in " << thermfit::fixed_text(mark.interval->first, 0) << " … "
                << thermfit::fixed_text(mark.interval->second, 0);
    if (mark.fresh) std::cout << ", fresh " << thermfit::fixed_text(mark.fresh->percent, 0);
    std::cout << "\n";
  }
  return summary;
}

int run(const Options& options) {
  std::vector<blind::Case> cases;
  for (const std::string& folder : options.folders)
    for (const blind::Case& one : blind::find_cases(folder)) cases.push_back(one);
  if (options.first > 1)
    cases.erase(cases.begin(), cases.begin() + static_cast<std::ptrdiff_t>(std::min(cases.size(), options.first - 1)));
  if (cases.size() > options.count) cases.resize(options.count);
  if (cases.empty()) throw std::runtime_error("no cases found");

  const blind::Summary summary = scored(cases, options.runner, options);
  std::vector<std::pair<std::string, const blind::Summary*>> ways{{"by the network", &summary}};
  blind::Summary outputs;
  if (options.both_ways) {
    blind::Runner runner = options.runner;
    runner.by_outputs = true;
    runner.fresh = false;
    runner.results /= "outputs";
    std::cout << blind::families_text(summary) << "\n";
    outputs = scored(cases, runner, options);
    ways.emplace_back("by outputs (--sim)", &outputs);
  }
  std::cout << blind::families_text(options.both_ways ? outputs : summary) << "\n" << blind::totals_text(ways);
  const auto figures = summary.figures();
  blind::Json kept = blind::Json::object();
  for (const auto& [name, value] : figures) kept[name] = std::isfinite(value) ? blind::Json(value) : blind::Json();
  thermfit::write_atomically((options.runner.results / "summary.json").string(), kept.dump(1) + "\n");
  bool met = true;
  for (const std::string& demand : options.demands)
    if (!meets(figures, demand)) {
      std::cout << "not met: " << demand << "\n";
      met = false;
    }
  return met ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
  try {
    return run(parse(std::vector<std::string>(words + 1, words + count)));
  } catch (const std::exception& error) {
    std::cerr << "thermfit_blind_score: " << error.what() << "\n";
    return 2;
  }
}
