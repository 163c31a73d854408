#include "thermfit/findings/findings.hpp"

#include <filesystem>
#include <functional>
#include <random>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "thermfit/io/csv/reader.hpp"

using namespace thermfit;

namespace {

Batch batch_of(const std::string& name) {
  return read_campaign({std::string(THERMFIT_SOURCE_DIR) + "/data/vcenter55/" + name + ".csv"}).batches[0];
}

std::vector<std::string> batch_names() {
  std::vector<std::string> names;
  for (int k = 1; k <= 12; ++k) names.push_back(std::string(k < 10 ? "K0" : "K") + std::to_string(k));
  return names;
}

auto temperature(Batch& batch, Index number) { return batch.temperatures.values.col(number - 1); }

void remove_rows(Batch& batch, Index first, Index count) {
  const Index kept = batch.rows() - first - count;
  const auto cut = [&](auto& values) {
    const auto tail = values.bottomRows(kept).eval();
    values.middleRows(first, kept) = tail;
    values.conservativeResize(first + kept, values.cols());
  };
  cut(batch.time_s);
  cut(batch.temperatures.values);
  cut(batch.errors.values);
  cut(batch.inputs.values);
}

struct Fault {
  FindingRule rule;
  std::string channel;
  Index first_row, last_row;
  std::function<void(Batch&)> seed;
};

/// One of each kind of fault, put into a clean batch.
const std::vector<Fault> faults{
    {FindingRule::spike, "T3", 30, 30, [](Batch& batch) { temperature(batch, 3)(30) += 2; }},
    {FindingRule::spike, "T8", 45, 45, [](Batch& batch) { temperature(batch, 8)(45) -= 1.5; }},
    {FindingRule::spike, "T9", 50, 52, [](Batch& batch) { temperature(batch, 9).segment(50, 3).array() += 3; }},
    {FindingRule::spike, "T3", 30, 31, [](Batch& batch) { temperature(batch, 3).segment(30, 2).array() += 2; }},
    {FindingRule::spike, "T3", 40, 44,
     [](Batch& batch) {  // a burst of different ones
       for (Index i = 0; i < 5; ++i)
         temperature(batch, 3)(40 + i) += double(7 * i * i % 11 + 2) * (i % 2 == 0 ? 1 : -1);
     }},
    {FindingRule::spike, "T4", 0, 2, [](Batch& batch) { temperature(batch, 4).head(3).array() += 12; }},
    {FindingRule::spike, "T4", 75, 78, [](Batch& batch) { temperature(batch, 4).tail(4).array() -= 12; }},
    {FindingRule::jump, "T5", 40, 50, [](Batch& batch) { temperature(batch, 5).segment(40, 11).array() += 4; }},
    {FindingRule::jump, "T5", 39, 43,
     [](Batch& batch) {  // spread over four rows
       for (Index row = 40; row < batch.rows(); ++row)
         temperature(batch, 5)(row) += 7.5 * double(std::min<Index>(4, row - 39));
     }},
    {FindingRule::spike, "Z", 20, 21, [](Batch& batch) { batch.errors.values.col(0).segment(20, 2).array() -= 80; }},
    {FindingRule::spike, "T4", 0, 0, [](Batch& batch) { temperature(batch, 4)(0) -= 12; }},
    {FindingRule::spike, "T4", 1, 1, [](Batch& batch) { temperature(batch, 4)(1) += 4; }},
    {FindingRule::spike, "T4", 77, 77, [](Batch& batch) { temperature(batch, 4)(77) -= 4; }},
    {FindingRule::spike, "T4", 78, 78, [](Batch& batch) { temperature(batch, 4)(78) += 12; }},
    {FindingRule::impossible, "T2", 0, 0, [](Batch& batch) { temperature(batch, 2)(0) = -127; }},
    {FindingRule::impossible, "T2", 40, 41,
     [](Batch& batch) { temperature(batch, 2).segment(40, 2).setConstant(9.9e37); }},
    {FindingRule::impossible, "T2", 78, 78, [](Batch& batch) { temperature(batch, 2)(78) = -999.9; }},
    {FindingRule::impossible, "Z", 12, 12, [](Batch& batch) { batch.errors.values(12, 0) = -1e12; }},
    {FindingRule::spike, "Z", 40, 40,
     [](Batch& batch) {  // an input that counts rows, one that dithers: neither excuses anything
       batch.inputs = {{"row", "rpm"}, Matrix(batch.rows(), 2)};
       batch.inputs.values.col(0).setLinSpaced(0, static_cast<double>(batch.rows() - 1));
       for (Index row = 0; row < batch.rows(); ++row)
         batch.inputs.values(row, 1) = 4000 + static_cast<double>(row * row % 5) - 2;
       batch.errors.values(40, 0) += 60;
     }},
    {FindingRule::spike, "Z", 40, 40, [](Batch& batch) { batch.errors.values(40, 0) += 60; }},
    {FindingRule::jump, "T5", 39, 40, [](Batch& batch) { temperature(batch, 5).tail(39).array() += 2; }},
    {FindingRule::jump, "Z", 39, 40, [](Batch& batch) { batch.errors.values.col(0).tail(39).array() -= 60; }},
    {FindingRule::stuck, "T7", 10, 78,
     [](Batch& batch) { temperature(batch, 7).tail(69).setConstant(temperature(batch, 7)(10)); }},
    {FindingRule::constant, "T2", 0, 78, [](Batch& batch) { temperature(batch, 2).setConstant(20); }},
    {FindingRule::constant, "Z", 0, 78, [](Batch& batch) { batch.errors.values.setZero(); }},
    {FindingRule::saturated, "Z", -1, -1,
     [](Batch& batch) { batch.errors.values = batch.errors.values.cwiseMin(0.6 * batch.errors.values.maxCoeff()); }},
    {FindingRule::stale, "Z", 0, 78,
     [](Batch& batch) {
       for (Index row = 0; row < batch.rows(); ++row)
         batch.errors.values(row, 0) = batch.errors.values(row - row % 4, 0);
     }},
    {FindingRule::collinear, "T6", 0, 78, [](Batch& batch) { temperature(batch, 6) = temperature(batch, 1); }},
    {FindingRule::collinear, "T10", 0, 78,
     [](Batch& batch) { temperature(batch, 10) = (temperature(batch, 1) + temperature(batch, 4)) / 2; }},
    {FindingRule::unit, "T4", 0, 0,
     [](Batch& batch) { temperature(batch, 4) = (1.8 * temperature(batch, 4).array() + 32).matrix(); }},
    {FindingRule::unit, "Z", 0, 0, [](Batch& batch) { batch.errors.values /= 1000; }},
    {FindingRule::range, "Z", 0, 0, [](Batch& batch) { batch.errors.values.array() += 102350; }},
    {FindingRule::missing, "T1", 20, 24,
     [](Batch& batch) { temperature(batch, 1).segment(20, 5).setConstant(std::nan("")); }},
    {FindingRule::time_gap, "time", 29, 30, [](Batch& batch) { remove_rows(batch, 30, 6); }},
    {FindingRule::time_back, "time", 40, 40, [](Batch& batch) { batch.time_s.tail(39).array() -= 4000; }},
    {FindingRule::time_back, "time", 12, 12, [](Batch& batch) { batch.time_s(12) = batch.time_s(11); }},
};

std::string told(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& one : findings)
    text += std::string(rule_name(one.rule)) + ' ' + one.channel + ' ' + std::to_string(one.first_row) + '-' +
            std::to_string(one.last_row) + " (" + std::to_string(one.figure) + " > " + std::to_string(one.limit) +
            "); ";
  return text;
}

/// The batches in the folder `real` of each withheld campaign.
std::vector<std::string> withheld_batches(const std::string& data) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data + "/withheld"))
    if (entry.path().parent_path().filename() == "real" && entry.path().extension() == ".csv")
      paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

TEST_CASE("a clean campaign raises no alarm", "[batch]") {
  for (const std::string& name : batch_names()) {
    INFO(name);
    CHECK(told(find_faults(batch_of(name))) == "");
  }
}

TEST_CASE("216 batches of campaigns with effects, but without faults, raise no alarm", "[batch]") {
  REQUIRE_SHARED_DATA(data);
  std::size_t count = 0;
  for (const std::string& path : withheld_batches(data)) {
    INFO(path);
    ++count;
    CHECK(told(find_faults(read_campaign({path}).batches[0])) == "");
  }
  CHECK(count >= 216);
}

TEST_CASE("each fault put into each batch of a campaign is found once, and nothing else", "[batch]") {
  int found = 0, tried = 0;
  for (const std::string& name : batch_names())
    for (const Fault& fault : faults) {
      Batch batch = batch_of(name);
      fault.seed(batch);
      const std::vector<Finding> findings = find_faults(batch);
      INFO(name << ' ' << rule_name(fault.rule) << ' ' << fault.channel << ": " << told(findings));
      ++tried;
      CHECK(findings.size() == 1);
      if (findings.size() != 1) continue;
      ++found;
      CHECK(rule_name(findings[0].rule) == rule_name(fault.rule));
      CHECK(findings[0].channel == fault.channel);
      if (fault.first_row >= 0) CHECK(findings[0].first_row <= fault.first_row);
      if (fault.last_row >= 0) CHECK(findings[0].last_row >= fault.last_row);
    }
  INFO(found << " of " << tried);
  CHECK(found == tried);
}

TEST_CASE("every second or third reading wrong is found, each of them", "[batch]") {
  for (const std::string& name : batch_names())
    for (const Index every : {2, 3}) {
      Batch batch = batch_of(name);
      std::vector<Index> wrong;
      for (Index row = 20; row < 60; row += every) {
        temperature(batch, 3)(row) += 5;
        wrong.push_back(row);
      }
      std::vector<Index> found;
      for (const Finding& one : find_faults(batch)) {
        CHECK(rule_name(one.rule) == "spike");
        CHECK(one.channel == "T3");
        CHECK(one.first_row == one.last_row);
        found.push_back(one.first_row);
      }
      CHECK(found == wrong);
    }
}

TEST_CASE("what is no fault is not taken for one", "[batch]") {
  const auto one_channel = [](const std::function<double(Index)>& value, Index rows = 200) {
    Batch batch;
    batch.temperatures = {{"T1"}, Matrix(rows, 1)};
    for (Index row = 0; row < rows; ++row) batch.temperatures.values(row, 0) = value(row);
    return batch;
  };
  const auto rounded = [](double value, double step) { return step * std::round(value / step); };
  SECTION("a corner of the true course") {
    CHECK(told(find_faults(one_channel([](Index row) {
            return 20 + (row < 100 ? 2.0 : 2.0 * (200 - double(row)) / 100) * double(row) / 100;
          }))) == "");
    CHECK(told(find_faults(one_channel([](Index row) { return row < 100 ? double(row) : 200 - double(row); }))) == "");
  }
  SECTION("a coarse thermometer at rest") {
    CHECK(told(find_faults(one_channel([&](Index row) { return rounded(20 + 0.005 * double(row), 0.3); }))) == "");
  }
  SECTION("a coarse thermometer that flickers between two steps") {
    CHECK(told(find_faults(one_channel([](Index row) { return row * row % 7 < 2 ? 20.3 : 20.0; }))) == "");
  }
  SECTION("a fast start") {
    CHECK(told(find_faults(
              one_channel([&](Index row) { return rounded(20 + 30 * (1 - std::exp(-double(row))), 0.1); }))) == "");
  }
  SECTION("noise alone, of any size, in 20000 readings") {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const double size : {0.02, 0.1, 10.0})
      CHECK(told(find_faults(one_channel([&](Index) { return rounded(20 + size * normal(random), 0.01); }, 20000))) ==
            "");
  }
  SECTION("a step that a known input explains") {
    Batch batch = one_channel([](Index row) { return row < 100 ? 20 : 25 + 0.01 * double(row % 3); });
    CHECK(told(find_faults(batch)).find("jump T1") == 0);
    batch.inputs = {{"coolant"}, Matrix::Zero(200, 1)};
    batch.inputs.values.bottomRows(100).setOnes();
    CHECK(told(find_faults(batch)) == "");
  }
  SECTION("an error that is measured now and then, and held") {
    Batch batch = batch_of("K01");
    Index held = 0;
    for (Index row = 0; row < batch.rows(); ++row) {
      if (row - held > 2 + row * row % 4) held = row;
      batch.errors.values(row, 0) = std::round(40 * batch.errors.values(held, 0)) / 40 + 0.01 * double(held % 7);
    }
    CHECK(told(find_faults(batch)) == "");
  }
  SECTION("a step that other channels make in the same row: the machine did something") {
    Batch batch = batch_of("K01");
    temperature(batch, 3).tail(39).array() -= 2;
    temperature(batch, 4).tail(39).array() -= 1;
    CHECK(told(find_faults(batch)) == "");
  }
  SECTION("a hot place, tenths of a degree: told, but no unit is advised") {
    Batch batch = batch_of("K01");
    temperature(batch, 3).array() += 140;
    const std::vector<Finding> findings = find_faults(batch);
    REQUIRE(findings.size() == 1);
    CHECK(rule_name(findings[0].rule) == "range");
    CHECK(findings[0].note.find("name the unit") == std::string::npos);
  }
  SECTION("a clock that is late now and then, and makes up for it") {
    Batch batch = batch_of("K01");
    for (Index row = 5; row + 1 < batch.rows(); row += 9) batch.time_s(row) += 250;
    CHECK(told(find_faults(batch)) == "");
  }
  SECTION("an input that never changes, and a clock with uneven steps") {
    Batch batch = batch_of("K01");
    for (Index row = 0; row < batch.rows(); ++row) batch.time_s(row) += double(row * row % 11) * 15;
    CHECK(told(find_faults(batch)) == "");
  }
}

TEST_CASE("batches too short to judge, empty, or without readings are no trouble", "[batch]") {
  CHECK(find_faults(Batch{}).empty());
  Batch batch = batch_of("K01");
  for (const Index rows : {1, 2, 5, 11}) {
    Batch start = batch;
    remove_rows(start, rows, start.rows() - rows);
    CHECK(told(find_faults(start)) == "");
  }
  batch.temperatures.values.setConstant(std::nan(""));
  CHECK(find_faults(batch).size() == 10);
}
