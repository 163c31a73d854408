/// Faults planted into measured data: the truth is known although the data are real.

#include <filesystem>
#include <fstream>
#include <functional>

#include "blind/score/mark.hpp"
#include "cli/command.hpp"
#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "thermfit/io/atomic_file.hpp"
#include "thermfit/io/csv_reader.hpp"
#include "thermfit/number.hpp"

using namespace blind;
namespace fs = std::filesystem;

namespace {

using Fault = std::function<void(thermfit::Batch&)>;

/// Every fifth second of a run, in the columns of the heater board.
std::string board_csv(const thermfit::Batch& batch) {
  std::string text = "time_s,Q1,Q2,T1,T2\n";
  for (Eigen::Index row = 0; row < batch.rows(); row += 5) {
    text += thermfit::exact_text(batch.time_s[row]);
    for (const char* input : {"Q1", "Q2"})
      text += "," + thermfit::exact_text(batch.inputs.values(row, batch.inputs.find(input)));
    for (const char* sensor : {"T1", "T2"})
      text += "," + thermfit::exact_text(batch.temperatures.values(row, batch.temperatures.find(sensor)));
    text += "\n";
  }
  return text;
}

/// The heater board with what is known of it (its sensor lags, its heaters exchange heat), calibrated on sound runs,
/// then diagnosed on the same runs with a fault in them.
class Board {
 public:
  explicit Board(const std::string& data) : folder_(fs::temp_directory_path() / "thermfit_planted") {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "sound");
    fs::create_directories(folder_ / "faulty");
    std::vector<std::string> files;
    for (const char* run : {"sin_5_run_1", "sin_5_run_2", "sin_5_run_3", "step_run_1", "step_run_2", "apm_mimo_599"})
      files.push_back(data + "/real/tclab/real/" + run + ".csv");
    runs_ = thermfit::read_campaign(files).batches;
    machine_ = read_json(data + "/real/tclab/machine.json");
    machine_["effects"] = {{{"effect", "sensor-lag"}, {"location", "T1"}},
                           {{"effect", "sensor-lag"}, {"location", "T2"}},
                           {{"effect", "missing-link"}, {"location", "heater1-heater2"}}};
    thermfit::write_atomically(path("known.json"), machine_.dump(1));
    REQUIRE(thermfit::cli::run(words("calibrate", "known.json", "sound", {}, {"-o", path("calibrated.json")})) <= 1);
    machine_ = read_json(path("calibrated.json"));
  }
  ~Board() { fs::remove_all(folder_); }

  Json& machine() { return machine_; }

  /// What is said when every run has the fault.
  Json diagnosis(const Fault& fault) {
    thermfit::write_atomically(path("machine.json"), machine_.dump(1));
    REQUIRE(thermfit::cli::run(
                words("diagnose", "machine.json", "faulty", fault, {"--json", "-o", path("diagnosis.json")})) <= 1);
    const Json said = read_json(path("diagnosis.json"));
    UNSCOPED_INFO(said.at("verdict").dump() << " " << said.value("effects", Json::array()).dump());
    return said;
  }

 private:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::vector<std::string> words(const std::string& command, const std::string& machine, const std::string& part,
                                 const Fault& fault, const std::vector<std::string>& options) {
    std::vector<std::string> all{command, path(machine)};
    for (thermfit::Batch run : runs_) {
      if (fault) fault(run);
      const std::string file = path(part + "/" + run.name + ".csv");
      thermfit::write_atomically(file, board_csv(run));
      all.push_back(file);
    }
    all.insert(all.end(), options.begin(), options.end());
    return all;
  }

  fs::path folder_;
  thermfit::Campaign runs_;
  Json machine_;
};

Mark against(const std::vector<std::string>& effects, const std::string& place, const Json& said) {
  Truth truth;
  truth.verdict = "effect";
  truth.effects = {{effects, {place}, true}};
  return mark(truth, said);
}

auto sensor(const char* name,
            const std::function<double(double value, Eigen::Index row, const thermfit::Vector&)>& to) {
  return [=](thermfit::Batch& batch) {
    auto column = batch.temperatures.values.col(batch.temperatures.find(name));
    const thermfit::Vector sound = column;
    for (Eigen::Index row = 0; row < sound.size(); ++row) column[row] = to(sound[row], row, sound);
  };
}

}  // namespace

TEST_CASE("a thermometer whose log is two minutes late is named as lagging") {
  REQUIRE_SHARED_DATA(data);
  Board board(data);
  const Json said = board.diagnosis(sensor("T2", [](double, Eigen::Index row, const thermfit::Vector& sound) {
    return sound[std::max<Eigen::Index>(0, row - 120)];
  }));
  const Mark seen = against({"sensor-lag"}, "T2", said);
  CHECK(seen.in_set);
  CHECK(seen.place);
  CHECK_FALSE(seen.confident_wrong);
}

TEST_CASE("four degrees added to one thermometer are named as its offset") {
  REQUIRE_SHARED_DATA(data);
  Board board(data);
  const Json said =
      board.diagnosis(sensor("T2", [](double value, Eigen::Index, const thermfit::Vector&) { return value + 4; }));
  const Mark seen = against({"sensor-offset"}, "T2", said);
  CHECK(seen.in_set);
  CHECK(seen.place);
  CHECK_FALSE(seen.confident_wrong);
}

TEST_CASE("a thermometer that reads a quarter too much is named for its gain") {
  REQUIRE_SHARED_DATA(data);
  Board board(data);
  const Json said = board.diagnosis(
      sensor("T1", [](double value, Eigen::Index, const thermfit::Vector&) { return 20 + 1.25 * (value - 20); }));
  const Mark seen = against({"sensor-gain"}, "T1", said);
  CHECK(seen.in_set);
  CHECK(seen.place);
  CHECK_FALSE(seen.confident_wrong);
}

TEST_CASE("a heater that the machine file forgets is named with its input and its node") {
  REQUIRE_SHARED_DATA(data);
  Board board(data);
  board.machine()["heat_sources"].erase(1);
  const Json said = board.diagnosis({});
  const Mark seen = against({"heat-source"}, "heater2", said);
  CHECK(seen.top);
  CHECK(seen.place);
  CHECK(said.at("effects").at(0).value("driver", "") == "Q2");
}

TEST_CASE("a heater whose input was not logged leaves no confident wrong name") {
  REQUIRE_SHARED_DATA(data);
  Board board(data);
  const Json said =
      board.diagnosis([](thermfit::Batch& batch) { batch.inputs.values.col(batch.inputs.find("Q2")).setZero(); });
  const Mark seen = against({"heat-source"}, "heater2", said);
  CHECK_FALSE(seen.confident_wrong);
}
