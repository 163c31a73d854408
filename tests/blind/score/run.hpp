#pragma once

/// Runs the diagnosis of many cases, two at once at most, and keeps every document so that a broken run resumes.

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <thread>

#include "fresh.hpp"
#include "mark.hpp"
#include "thermfit/io/files/atomic_file.hpp"
#include "thermfit/number.hpp"

namespace blind {

namespace fs = std::filesystem;

inline std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

inline std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

inline std::vector<fs::path> batches_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// How to call the diagnosis and where to keep what it says.
struct Runner {
  std::string program;                 ///< the thermfit command, or a baseline
  std::vector<std::string> arguments;  ///< before the machine: `diagnose`, or the baseline's name
  fs::path results;
  bool by_outputs = false;  ///< the machine's simulated batches instead of the machine: diagnose --sim
  bool fresh = false;       ///< measure the shrink on fresh batches too: needs --write and the calibrate command
  int seconds_allowed = 120;

  /// The document for one case, from `results` when it is newer than the program and the case; nothing on failure.
  std::optional<Json> document(const Case& one, const std::string& what, const std::vector<std::string>& options,
                               double& seconds) const {
    const fs::path kept = results / (one.name + what + ".json"), clock = results / (one.name + what + ".seconds");
    const auto newer = [&](const fs::path& than) { return fs::last_write_time(kept) > fs::last_write_time(than); };
    if (!(fs::exists(kept) && fs::exists(clock) && newer(program) && newer(one.folder / "machine.json"))) {
      fs::create_directories(results);
      const fs::path part = kept.string() + ".part";
      std::string line = "timeout " + std::to_string(seconds_allowed) + " " + quoted(program);
      for (const std::string& word : arguments) line += " " + quoted(word);
      line += by_outputs ? " --sim " + quoted(simulated(one).string())
                         : " " + quoted((one.folder / "machine.json").string());
      line += real_batches(one);
      line += " --json";
      for (const std::string& word : options) line += " " + quoted(word);
      line += " > " + quoted(part.string()) + " 2> " + quoted((results / (one.name + what + ".err")).string());
      const auto before = std::chrono::steady_clock::now();
      const int status = std::system(line.c_str());
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
      // Exit 1 is an answer (a gap without a name); anything above is none.
      if (status == -1 || !WIFEXITED(status) || WEXITSTATUS(status) > 1) return std::nullopt;
      thermfit::write_atomically(clock.string(), thermfit::fixed_text(took.count(), 3) + "\n");
      fs::rename(part, kept);
    }
    std::ifstream time(clock);
    std::string text;
    std::getline(time, text);
    seconds = thermfit::parse_number(text).value_or(NAN);
    try {
      return read_json(kept);
    } catch (const std::exception&) {
      return std::nullopt;
    }
  }

  static std::string real_batches(const Case& one) {
    std::string words;
    for (const fs::path& file : batches_in(one.folder / "real")) words += " " + quoted(file.string());
    return words;
  }

  /// The folder of the batches as the machine of the case simulates them, made when it is not there.
  fs::path simulated(const Case& one) const {
    const fs::path folder = results / (one.name + ".sim");
    if (!fs::exists(folder)) {
      const std::string line = quoted(program) + " simulate " + quoted((one.folder / "machine.json").string()) +
                               real_batches(one) + " --output-folder " + quoted(folder.string()) + " > /dev/null 2>&1";
      if (std::system(line.c_str()) != 0) fs::remove_all(folder);
    }
    return folder;
  }

  std::string written(const Case& one) const { return (results / (one.name + ".machine.json")).string(); }

  /// The calibrated machine against the one with the effect, both made from the recorded batches.
  std::optional<MeasuredShrink> shrink_on_fresh(const Case& one) const {
    const std::string calibrated = (results / (one.name + ".calibrated.json")).string();
    if (!fs::exists(calibrated) || fs::last_write_time(calibrated) < fs::last_write_time(program)) {
      std::string line = quoted(program) + " calibrate " + quoted((one.folder / "machine.json").string());
      for (const fs::path& file : batches_in(one.folder / "real")) line += " " + quoted(file.string());
      if (std::system((line + " -o " + quoted(calibrated) + " > /dev/null 2>&1").c_str()) == -1) return std::nullopt;
    }
    std::vector<std::string> batches;
    for (const fs::path& file : batches_in(one.folder / "fresh")) batches.push_back(file.string());
    try {
      return measured_shrink(errors_of(calibrated, batches), errors_of(written(one), batches));
    } catch (const std::exception&) {
      return std::nullopt;
    }
  }

  Mark judged(const Case& one, bool with_oracle) const {
    std::vector<std::string> options;
    if (!one.truth.without.empty()) options = {"--without", joined(one.truth.without, ",")};
    if (fresh) options.insert(options.end(), {"--write", written(one)});
    double seconds = NAN, ignored;
    Mark mark;
    mark.failed = true;
    if (const auto found = document(one, "", options, seconds)) {
      try {
        mark = blind::mark(by_outputs ? seen_in_outputs(one.truth, read_json(one.folder / "machine.json")) : one.truth,
                           *found);
      } catch (const std::exception& error) {
        mark.said = error.what();
      }
    }
    mark.seconds = seconds;
    if (fresh && mark.named && fs::is_directory(one.folder / "fresh")) mark.fresh = shrink_on_fresh(one);
    if (with_oracle && !one.truth.effects.empty() && one.truth.detectable) {
      std::vector<std::string> names;
      for (const TrueEffect& effect : one.truth.effects) names.push_back(effect.names.front());
      if (const auto found = document(one, ".oracle", {"--effects", joined(names, ",")}, ignored))
        mark.oracle_shrink_percent = number_or_nan(found->value("gap", Json::object()), "shrink_percent");
    }
    return mark;
  }
};

/// Marks in the order of the cases; `jobs` at a time; `after` hears of each as it comes.
inline std::vector<Mark> judge_all(const std::vector<Case>& cases, const Runner& runner, bool with_oracle, int jobs,
                                   const std::function<void(std::size_t done)>& after) {
  std::vector<Mark> marks(cases.size());
  std::atomic<std::size_t> next{0}, done{0};
  std::vector<std::thread> workers;
  for (int job = 0; job < jobs; ++job)
    workers.emplace_back([&] {
      for (std::size_t i; (i = next++) < cases.size(); after(++done)) marks[i] = runner.judged(cases[i], with_oracle);
    });
  for (std::thread& worker : workers) worker.join();
  return marks;
}

}  // namespace blind
