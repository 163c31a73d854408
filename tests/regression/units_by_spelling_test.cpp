// A unit written in another way than in brackets was no unit: Z_mm or 'Z / mm' named by an option was read as um, a
// thousand times too small, and a thermometer called 'T3 (Deg. C)' or t3 became an input without a word.
#include "support/catch.hpp"
#include "support/read_text.hpp"
#include "thermfit/io/csv/reader.hpp"
#include "thermfit/io/csv/writer.hpp"

using namespace thermfit;

namespace {

using Names = std::vector<std::string>;

std::string notes(const std::string& text, const CsvOptions& options = {}) {
  std::string all;
  for (const std::string& note : read_text(text, options).notes(options))
    all += note.substr(note.find("a.csv: ") + 7) + '\n';
  return all;
}

}  // namespace

TEST_CASE("an error in mm is in mm however its unit is written, and whether it is named with or without it") {
  for (const std::string title : {"Z [mm]", "Z_mm", "Z/mm", "Z / mm", "\"Z, mm\"", "Z in mm", "Z MM", "Z [1e3 um]"}) {
    const std::string text = "time_s,T1," + title + "\n0,20,0.001\n1,21,0.002\n";
    const std::string bare = title.front() == '"' ? title.substr(1, title.size() - 2) : title;
    for (const Names& errors : {Names{}, Names{"Z"}, Names{bare}}) {
      CsvOptions options;
      options.errors = errors;
      INFO(title << ", " << (errors.empty() ? "by default" : errors.front()));
      const Batch batch = read_text(text, options).batches.front();
      REQUIRE(batch.errors.count() == 1);
      CHECK(batch.errors.values(1, 0) == Approx(2).epsilon(1e-14));
      const bool in_brackets = title.find('[') != std::string::npos;
      CHECK(batch.errors.names.front() == (errors.empty() || in_brackets ? "Z" : errors.front()));
    }
  }
}

TEST_CASE("what is no temperature and no error keeps its title, unit and all") {
  const Batch batch = read_text("time_s,T1_degC,Z_um,pos_mm,room_degC\n0,20,1,5,20\n").batches.front();
  CHECK(batch.temperatures.names == Names{"T1"});
  CHECK(batch.errors.names == Names{"Z"});
  CHECK(batch.inputs.names == Names{"pos_mm", "room_degC"});
}

TEST_CASE("units by option hold for names and globs, and win over the file with a word") {
  CsvOptions options;
  options.units = {{"Z", "mm"}, {"T*", "degF"}, {"Time", "h"}};
  const std::string text = "Time,T1,T2 [degC],Z\n0,68,50,0.001\n1,86,32,0.002\n";
  const Batch batch = read_text(text, options).batches.front();
  CHECK(batch.temperatures.values == (Matrix(2, 2) << 20, 10, 30, 0).finished());
  CHECK(batch.errors.values == (Matrix(2, 1) << 1, 2).finished());
  CHECK(batch.time_s(1) == 3600);
  CHECK(notes(text, options) ==
        "converted: T1 from degF, T2 from degF, Z from mm\n"
        "as CsvOptions::units says: T2 in degF, the file says degC\n");
  options.units = {{"T2", "°C"}};
  CHECK(notes("Time_s,T1,T2 [degC]\n0,20,20\n", options).find("says") == std::string::npos);
}

TEST_CASE("a minus before a unit of length turns a column of corrections into errors") {
  CsvOptions options;
  options.units = {{"Z", "-mm"}};
  const std::string text = "Time,T1,Z\n0,20,0.001\n1,20,-0.002\n";
  CHECK(read_text(text, options).batches.front().errors.values == (Matrix(2, 1) << -1, 2).finished());
  options.units = {{"T1", "-degC"}};
  CHECK_THROWS_AS(read_text(text, options), Error);
}

TEST_CASE("what a machine says of units holds where the file says nothing") {
  CsvOptions options;
  options.units = {{"Z", "-mm", true}, {"T1", "K", true}, {"T9", "K", true}};
  const Batch batch = read_text("Time,T1 [degC],Z\n0,20,0.001\n1,20,-0.002\n", options).batches.front();
  CHECK(batch.temperatures.values(0, 0) == 20);
  CHECK(batch.errors.values == (Matrix(2, 1) << -1, 2).finished());
  CHECK(read_text("Time,T1,Z [um]\n0,293.15,1\n1,293.15,2\n", options).batches.front().errors.values(0, 0) == -1);
}

TEST_CASE("a column that is nearly a temperature or an error is told when it becomes an input") {
  CHECK(notes("time_s,t1,T2,z,T 3,Ambient [degC],rpm\n0,20,20,1,20,20,1000\n") ==
        "taken as inputs: t1 (nearly T1: CsvOptions::temperatures = NAMES), z (nearly Z: CsvOptions::errors = NAMES), "
        "T 3 (nearly T3: CsvOptions::temperatures = NAMES)\n");
  CsvOptions options;
  options.temperatures = {"T2", "t1"};
  options.errors = {"z"};
  CHECK(notes("time_s,t1,T2,z,rpm\n0,20,20,1,1000\n", options).empty());
}

TEST_CASE("carriage returns that pasting left inside lines are blanks, and are told") {
  const std::string pasted = "time_s,T1,T2\r,Z\r\n0,20.0,20.0\r,0.0\r\n60,20.5,20.2\r,1.1\r\n";
  const Batch batch = read_text(pasted).batches.front();
  CHECK(batch.temperatures.names == Names{"T1", "T2"});
  CHECK(batch.temperatures.values(1, 1) == 20.2);
  CHECK(notes(pasted) == "comma-separated, decimal point, CRLF, carriage returns inside lines taken as blanks\n");
  CHECK(read_text("time_s,T1\r\r\n0,20\r\r\n").batches.front().temperatures.values(0, 0) == 20);
}

TEST_CASE("a name that ends in a unit is written so that its numbers read back as they are") {
  CsvOptions options;
  options.errors = {"Z_mm"};
  options.temperatures = {"T1_degF"};
  const Batch batch = read_text("time_s,T1_degF,Z_mm\n0,68,0.001\n1,86,0.002\n", options).batches.front();
  const std::string written = write_csv(batch);
  CHECK(written.substr(0, written.find('\n')) == "time_s,T1_degF [degC],Z_mm [um]");
  const Batch again = read_text(written, options).batches.front();
  CHECK(again.errors.values == batch.errors.values);
  CHECK(again.temperatures.values == batch.temperatures.values);
  CHECK(again.errors.names == batch.errors.names);
}
