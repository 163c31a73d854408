#include "thermfit/batch/joined.hpp"

#include "support/catch.hpp"
#include "support/scratch_folder.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/io/csv/reader.hpp"

using namespace thermfit;

namespace {

Batch part(const std::string& name, const std::vector<double>& time_s, double first_degC) {
  Batch batch;
  batch.name = name;
  const auto rows = static_cast<Index>(time_s.size());
  batch.time_s = Eigen::Map<const Vector>(time_s.data(), rows);
  batch.temperatures = {{"T1"}, Vector::LinSpaced(rows, first_degC, first_degC + static_cast<double>(rows - 1))};
  batch.errors = {{"Z"}, batch.temperatures.values};
  return batch;
}

}  // namespace

TEST_CASE("a run in parts is the run", "[batch]") {
  const Batch whole = joined({part("a", {0, 60, 120}, 20), part("b", {180, 240}, 23)}, "run");
  const Batch once = part("run", {0, 60, 120, 180, 240}, 20);
  CHECK(whole.name == "run");
  CHECK(whole.time_s == once.time_s);
  CHECK(whole.temperatures.values == once.temperatures.values);
  CHECK(whole.errors.values == once.errors.values);
  CHECK(whole.row_numbers.empty());
  CHECK(model_temperatures(whole, TemperatureReference::rise)(4, 0) == 4);
}

TEST_CASE("parts come in the order of their clock, and without one in the order given", "[batch]") {
  const Batch late = part("b", {180, 240}, 23), early = part("a", {0, 60, 120}, 20);
  CHECK(joined({late, early}, "run").temperatures.values(0, 0) == 20);
  Batch first = late, second = early;
  first.time_s.resize(0);
  second.time_s.resize(0);
  CHECK(joined({first, second}, "run").temperatures.values(0, 0) == 23);
}

TEST_CASE("dates are one clock, whatever each file counts from", "[batch]") {
  Batch first = part("a", {0, 60}, 20), second = part("b", {0, 60}, 22);
  first.begins_s = 1700000000;
  second.begins_s = 1700000300.5;
  CHECK(joined({second, first}, "run").time_s == (Vector(4) << 0, 60, 300.5, 360.5).finished());
}

TEST_CASE("a clock that begins anew is told, not guessed", "[batch]") {
  CHECK_THROWS_WITH(joined({part("a", {0, 60, 120}, 20), part("b", {0, 60}, 23)}, "run"),
                    Catch::Contains("b: begins at 0 s") && Catch::Contains("CsvOptions::time_column"));
  CHECK_THROWS_AS(joined({part("a", {0, 60, 120}, 20), part("b", {120, 180}, 23)}, "run"), Error);
  Batch clockless = part("b", {180, 240}, 23);
  clockless.time_s.resize(0);
  CHECK_THROWS_AS(joined({part("a", {0, 60}, 20), clockless}, "run"), Error);
  Batch other = part("b", {180, 240}, 23);
  other.temperatures.names = {"T2"};
  CHECK_THROWS_AS(joined({part("a", {0, 60}, 20), other}, "run"), Error);
  CHECK_THROWS_AS(joined({}, "run"), Error);
}

TEST_CASE("files that a glob names are read as one batch, named after it", "[batch]") {
  const ScratchFolder folder;
  const std::vector<std::string> paths{folder.write("warm-1.csv", "time_min,T1,Z\n0,,1\n1,21,2\n"),
                                       folder.write("alone.csv", "time_min,T1,Z\n0,20,1\n1,21,2\n"),
                                       folder.write("warm-2.csv", "time_min,T1,Z\n2,22,3\n3,,4\n4,24,5\n")};
  CsvOptions options;
  options.missing = MissingValues::drop;
  options.join = {"warm-*"};
  const CsvReading reading = read_campaign(paths, options);
  REQUIRE(reading.batches.size() == 2);
  const Batch& warm = reading.batches[0];
  CHECK(warm.name == "warm");
  CHECK(warm.row_numbers == std::vector<Index>{2, 3, 5});  // of the two files after each other
  CHECK(warm.dropped_rows == 2);
  CHECK(lacks_first_reading(warm) == std::vector<std::string>{"T1"});
  CHECK(warm.digest.size() == 64);
  CHECK(reading.batches[1].name == "alone");
  CHECK(reading.notes(options)[0].find("warm: 2 files like warm-* as one batch") == 0);

  options.join = {"cold*"};
  CHECK_THROWS_WITH(read_campaign(paths, options), Catch::Contains("no file is like 'cold*'"));
  options.join = {"warm*", "*-1.csv"};
  CHECK_THROWS_AS(read_campaign(paths, options), Error);
  options.join = {"*"};
  CHECK_THROWS_AS(read_campaign(paths, options), Error);  // clocks overlap
}
