#include "thermfit/io/csv/reader.hpp"

#include <clocale>
#include <cmath>

#include "support/catch.hpp"
#include "support/scratch_folder.hpp"
#include "support/shared_data.hpp"
#include "thermfit/io/csv/table.hpp"
#include "thermfit/io/csv/writer.hpp"

using namespace thermfit;

namespace {

using Names = std::vector<std::string>;

CsvReading read(const std::string& text, const CsvOptions& options = {}) {
  const ScratchFolder folder;
  CsvReading reading = read_campaign({folder.write("K01.csv", text)}, options);
  for (CsvFile& file : reading.files) file.path = folder.without_folder(file.path);
  return reading;
}

Batch read_one(const std::string& text, const CsvOptions& options = {}) {
  CsvReading reading = read(text, options);
  REQUIRE(reading.batches.size() == 1);
  return reading.batches.front();
}

/// The same small batch that each of these spellings means.
const std::vector<std::string> spellings{
    "time_min,T1,T2,Z\n0,20.5,21,0\n5,-20.75,22.5,1250\n",
    "\xEF\xBB\xBFtime_min,T1,T2,Z\r\n0,20.5,21,0\r\n5,-20.75,22.5,1250\r\n",
    "time_min;T1;T2;Z\n0;20,5;21;0\n5;-20,75;22,5;1250\n",
    "time_min\tT1\tT2\tZ\n0\t20,5\t21\t0\n5\t-20,75\t22,5\t1250",
    "# logger 7\n\n\"time_min\" , \"T1\",T2,Z\n  # pause\n0,\"20.5\", 21 ,+0\n   \n5,-20.75,2.25e1,1.25E3",
    "time_s,T1,T2,Z\n0,20.5,21,0\n300,-20.75,22.5,1250\n",
    "Time [h];T1;T2;Z;\n0;20,5;21;0;\n0,083333333333333333;-20,75;22,5;1250;\n",
    "t (ms),T1 [degC],T2 [°C],Z [mm]\n0,20.5,21,0\n300000,-20.75,22.5,1.25\n",
    "Time,T1,T2,Z\n[min],[degF],[K],[0.1 um]\n0,68.9,294.15,0\n5,-5.35,295.65,12500\n",
    "stamp,T1,T2,Z\n2024-12-31T23:57:00Z,20.5,21,0\n2025-01-01T01:02:00+01:00,-20.75,22.5,1250\n",
    "stamp;T1;T2;Z\n2024-02-28 23:57:00,5;20,5;21;0\n2024-02-29 00:02:00,5;-20,75;22,5;1250\n",
};

}  // namespace

TEST_CASE("separator, decimal mark, byte order mark, line ends, quotes, comments, units and date-times change nothing",
          "[io]") {
  const Batch expected = read_one(spellings.front());
  CHECK(expected.name == "K01");
  CHECK(expected.temperatures.names == Names{"T1", "T2"});
  CHECK(expected.errors.names == Names{"Z"});
  CHECK(expected.inputs.names.empty());
  CHECK(expected.time_s == (Vector(2) << 0, 300).finished());
  CHECK(expected.temperatures.values == (Matrix(2, 2) << 20.5, 21, -20.75, 22.5).finished());
  CHECK(expected.errors.values == (Matrix(2, 1) << 0, 1250).finished());
  for (const std::string& spelling : spellings) {
    INFO(spelling);
    const Batch batch = read_one(spelling);
    CHECK(batch.time_s.isApprox(expected.time_s, 1e-13));
    CHECK(batch.temperatures.names == expected.temperatures.names);
    CHECK(batch.temperatures.values.isApprox(expected.temperatures.values, 1e-13));
    CHECK(batch.errors.values.isApprox(expected.errors.values, 1e-13));
  }
}

TEST_CASE("a dialect that is not the plain one is told, a plain one is not", "[io]") {
  CHECK(read(spellings[0]).notes({}).empty());
  CHECK(read(spellings[1]).notes({}).empty());
  CHECK(read(spellings[2]).notes({}) == Names{"K01.csv: semicolon-separated, decimal comma"});
  CHECK(read(spellings[8]).notes({}) == Names{"K01.csv: comma-separated, decimal point, unit row",
                                              "K01.csv: converted: T1 from degF, T2 from K, Z from 0.1 um"});
  CHECK(read("Time,T1\n0,20\n").notes({}) ==
        Names{"K01.csv: Time names no unit: minutes (CsvOptions::time_unit tells another)"});
}

TEST_CASE("a remark about several files is made once", "[io]") {
  const ScratchFolder folder;
  const std::string text = "time_s;T1\n0;20,5\n";
  const CsvReading reading =
      read_campaign({folder.write("a.csv", text), folder.write("b.csv", text), folder.write("c.csv", text)});
  const Names notes = reading.notes({});
  REQUIRE(notes.size() == 1);
  CHECK(folder.without_folder(notes[0]) == "a.csv and 2 more: semicolon-separated, decimal comma");
}

TEST_CASE("semicolons make the comma a decimal mark even where it could group thousands", "[io]") {
  CHECK(read_one("time_s;T1\n0;20,125\n").temperatures.values(0, 0) == 20.125);
  CHECK(read_one("time_s;T1\n0;20.125\n").temperatures.values(0, 0) == 20.125);
}

TEST_CASE("an option settles what the file leaves open", "[io]") {
  CsvOptions comma;
  comma.decimal_mark = ',';
  CHECK(read_one("time_s,T1\n0,\"20,5\"\n", comma).temperatures.values(0, 0) == 20.5);
  CHECK(read_one("time_s\trpm\tT1\n0\t1,234\t20\n", comma).inputs.values(0, 0) == 1.234);
  CsvOptions bar;
  bar.separator = '|';
  CHECK(read_one("time_s|T1|Z\n0|20.5|1\n", bar).temperatures.values(0, 0) == 20.5);
}

TEST_CASE("names may hold separators, quotes, brackets and be written in other scripts", "[io]") {
  CsvOptions options;
  options.temperatures = {"Oil, in", "5\" pipe", "Ölsumpf (vorn)"};
  options.errors = {"Disp. Z"};
  const Batch batch = read_one("\"Oil, in [°C]\",\"5\"\" pipe\",Ölsumpf (vorn),Disp. Z\n20,21,22,1\n", options);
  CHECK(batch.temperatures.names == Names{"Oil, in", "5\" pipe", "Ölsumpf (vorn)"});
  CHECK(batch.errors.names == Names{"Disp. Z"});
  CHECK_FALSE(batch.has_time());
}

TEST_CASE("numbers decide between two separators that both make a table", "[io]") {
  const Batch batch = read_one("time_s;T1;flow, l/min\n0;20;1,5\n1;21;2,5\n");
  CHECK(batch.temperatures.values == (Matrix(2, 1) << 20, 21).finished());
  CHECK(batch.inputs.names == Names{"flow, l/min"});
  CHECK(read_one("T1 [℃],\"Spindel 🌡\"\n20,1\n").inputs.names == Names{"Spindel 🌡"});
}

TEST_CASE("quotes around any field, text and batch too, change nothing", "[io]") {
  CsvOptions options;
  options.batch_column = "run";
  const CsvReading reading =
      read("run,time_s,T1,note\n\"a, \"\"b\"\"\",\"0\",\"20.5\",\"x, y\"\n\"a, \"\"b\"\"\",1,21,\n", options);
  REQUIRE(reading.batches.size() == 1);
  CHECK(reading.batches[0].name == "a, \"b\"");
  CHECK(reading.batches[0].temperatures.values == (Matrix(2, 1) << 20.5, 21).finished());
}

TEST_CASE("a missing date-time is a missing value", "[io]") {
  CsvOptions options;
  options.missing = MissingValues::drop;
  const CsvReading reading = read("stamp,T1\n2024-05-31T08:00,20\n,21\n2024-05-31T08:02,22\n", options);
  CHECK(reading.batches[0].time_s == (Vector(2) << 0, 120).finished());
  CHECK(reading.files[0].missing == 1);
}

TEST_CASE("roles follow the options: globs, order, inputs, no clock", "[io]") {
  const std::string text = "time_s,PT1,PT2,Z,Zb,rpm,note\n0,20,21,1,2,1000,a\n1,20,21,1,2,1000,b\n";
  CsvOptions options;
  options.temperatures = {"PT2", "PT*"};
  options.errors = {"Z?", "Z"};
  Batch batch = read_one(text, options);
  CHECK(batch.temperatures.names == Names{"PT2", "PT1"});
  CHECK(batch.errors.names == Names{"Zb", "Z"});
  CHECK(batch.inputs.names == Names{"rpm"});
  options.inputs = Names{};
  options.time_column = "none";
  batch = read_one(text, options);
  CHECK(batch.inputs.names.empty());
  CHECK_FALSE(batch.has_time());
  CHECK(batch.rows() == 2);
  CsvOptions all;
  all.temperatures = {"*"};
  CHECK(read_one(text, all).temperatures.names == Names{"PT1", "PT2", "Zb", "rpm"});  // Z is an error, note is text
}

TEST_CASE("columns of text and empty columns are left out with a note, a typo in a column of numbers is not", "[io]") {
  const CsvReading reading = read("time_s,T1,state,spare\n0,20,warm,\n1,21,cold,\n");
  CHECK(reading.notes({}) == Names{"K01.csv: left out, no numbers: state, spare"});
  CHECK_THROWS_AS(read("time_s,T1,rpm\n0,20,1000\n1,21,fast\n"), Error);
}

TEST_CASE("a file without a header line is read with names from the options", "[io]") {
  CsvOptions options;
  options.columns = {"time_min", "T1 [degF]", "Z"};
  const Batch batch = read_one("0,212,1\n1,32,2\n", options);
  CHECK(batch.temperatures.values == (Matrix(2, 1) << 100, 0).finished());
  CHECK(batch.time_s(1) == 60);
}

TEST_CASE("missing values follow the policy and are counted", "[io]") {
  const std::string text = "time_s,T1,T2\n0,20,30\n1,NA,31\n2,22,\n3,23,33\n";
  CsvOptions options;
  options.missing = MissingValues::drop;
  CsvReading reading = read(text, options);
  CHECK(reading.batches[0].time_s == (Vector(2) << 0, 3).finished());
  CHECK(reading.files[0].missing == 2);
  CHECK(reading.files[0].dropped_rows == 2);
  CHECK(reading.batches[0].dropped_rows == 2);
  CHECK(reading.notes(options)[0].find("2 rows left out for 2 missing values, first ") != std::string::npos);
  CHECK(reading.notes(options)[0].find("K01.csv:3:3 (T1)") != std::string::npos);

  options.missing = MissingValues::hold;
  reading = read(text, options);
  CHECK(reading.batches[0].temperatures.values == (Matrix(4, 2) << 20, 30, 20, 31, 22, 31, 23, 33).finished());
  CHECK(reading.notes(options)[0].find("2 missing values held, first ") != std::string::npos);
  CHECK(reading.batches[0].held_values == 2);

  options.missing = MissingValues::keep;
  reading = read(text, options);
  CHECK(std::isnan(reading.batches[0].temperatures.values(1, 0)));
  CHECK(reading.batches[0].temperatures.values(3, 1) == 33);
}

TEST_CASE("a value is held within its batch only", "[io]") {
  CsvOptions options;
  options.missing = MissingValues::hold;
  options.batch_column = "run";
  CHECK_THROWS_AS(read("run,T1\na,20\nb,\n", options), Error);
}

TEST_CASE("a batch column splits a file, in order of appearance, also where runs alternate", "[io]") {
  CsvOptions options;
  options.batch_column = "run";
  const CsvReading reading = read("run,time_s,T1\nb,0,20\na,5,30\nb,1,21\na,6,31\n", options);
  REQUIRE(reading.batches.size() == 2);
  CHECK(reading.batches[0].name == "b");
  CHECK(reading.batches[0].temperatures.values == (Matrix(2, 1) << 20, 21).finished());
  CHECK(reading.batches[1].name == "a");
  CHECK(reading.batches[1].time_s == (Vector(2) << 5, 6).finished());
}

TEST_CASE("channels are matched by name, in the order of the first batch", "[io]") {
  const ScratchFolder folder;
  const CsvReading reading =
      read_campaign({folder.write("a.csv", "T1,T2,Z,X\n20,21,1,2\n"), folder.write("b.csv", "X,T2,Z,T1\n2,21,1,20\n")});
  CHECK(reading.batches[1].temperatures.names == Names{"T1", "T2"});
  CHECK(reading.batches[1].temperatures.values == reading.batches[0].temperatures.values);
  CHECK(reading.batches[1].errors.values == reading.batches[0].errors.values);
}

TEST_CASE("batches from files of one name are told apart by their folders", "[io]") {
  const ScratchFolder folder;
  const CsvReading reading =
      read_campaign({folder.write("jan/K1.csv", "T1\n20\n"), folder.write("feb/K1.csv", "T1\n21\n")});
  CHECK(folder.without_folder(reading.batches[0].name) == "jan/K1");
  CHECK(folder.without_folder(reading.batches[1].name) == "feb/K1");
}

TEST_CASE("long files are read across blocks, whatever the length of their lines", "[io]") {
  // 300000 rows of changing width, some 4 MB: every row crosses a block edge somewhere.
  std::string text = "time_s,T1,Z\n";
  for (int row = 0; row < 300000; ++row)
    text += std::to_string(row) + ',' + std::to_string(row % 97) + (row % 3 ? ".25" : "") + ',' +
            std::to_string(row % 1013) + '\n';
  const Batch batch = read_one(text);
  REQUIRE(batch.rows() == 300000);
  bool equal = true;
  for (Index row = 0; row < batch.rows(); ++row)
    equal = equal && batch.time_s(row) == static_cast<double>(row) &&
            batch.temperatures.values(row, 0) == static_cast<double>(row % 97) + (row % 3 ? 0.25 : 0) &&
            batch.errors.values(row, 0) == static_cast<double>(row % 1013);
  CHECK(equal);
}

TEST_CASE("a header line longer than the start that is looked at is read whole", "[io]") {
  std::string names = "time_s", values = "0";
  for (int i = 0; i < 12000; ++i) {
    names += ",T" + std::to_string(i);
    values += ",20.5";
  }
  CHECK(read_one(names + '\n' + values + '\n').temperatures.count() == 12000);
}

TEST_CASE("time may go back where the caller wants to see it", "[io]") {
  CsvOptions options;
  options.increasing_time = false;
  CHECK(read_one("time_s,T1\n5,20\n0,21\n", options).time_s == (Vector(2) << 5, 0).finished());
}

TEST_CASE("rows stream in constant memory with the meaning of columns told first", "[io]") {
  const ScratchFolder folder;
  const std::string path = folder.write("a.csv", "time_min;T2;T1;Z;rpm\n0;20,5;21;1;1000\n1;20,75;22;2;2000\n");
  std::vector<double> seen;
  std::string told;
  const CsvFile file = read_rows(
      path, {},
      [&](const CsvFile& one) { told = one.roles.temperatures[0] + one.roles.errors[0] + one.roles.inputs[0]; },
      [&](const CsvRow& row) {
        for (const double value : {static_cast<double>(row.line), row.time_s, row.temperatures(0), row.temperatures(1),
                                   row.errors(0), row.inputs(0)})
          seen.push_back(value);
      });
  CHECK(told == "T2Zrpm");
  CHECK(seen == std::vector<double>{2, 0, 20.5, 21, 1, 1000, 3, 60, 20.75, 22, 2, 2000});
  CHECK(file.rows == 2);
}

TEST_CASE("a plain table keeps every column of numbers as it stands", "[io]") {
  const ScratchFolder folder;
  const CsvTable table = read_table(folder.write("a.csv", "time_min,T1 [degF],Z,name\n1,212,3,x\n2,32,4,y\n"));
  CHECK(table.names == Names{"time_min", "T1", "Z"});
  CHECK(table.values == (Matrix(2, 3) << 1, 212, 3, 2, 32, 4).finished());
}

TEST_CASE("a written batch reads back to the same digest", "[io]") {
  const ScratchFolder folder;
  const std::string path = std::string(THERMFIT_SOURCE_DIR) + "/data/vcenter55/K07.csv";
  const Batch batch = read_campaign({path}).batches[0];
  CHECK(batch.rows() == 79);
  CHECK(batch.temperatures.count() == 10);
  CHECK(batch.inputs.names == Names{"spindle_rpm", "feed_mm_min"});
  const Batch again = read_campaign({folder.write("K07.csv", write_csv(batch))}).batches[0];
  CHECK(again.digest == batch.digest);
  CHECK(again.digest.size() == 64);
  Batch changed = batch;
  changed.errors.values(78, 0) += 1e-12;
  CHECK(batch_digest(changed) != batch.digest);
}

TEST_CASE("a written batch has given decimals, quoted names and empty cells for missing values", "[io]") {
  Batch batch;
  batch.temperatures = {{"Oil, in", "5\" pipe"}, (Matrix(1, 2) << 20.26, std::nan("")).finished()};
  batch.errors = {{"Z"}, (Matrix(1, 1) << -0.04).finished()};
  CHECK(write_csv(batch, 1) == "\"Oil, in\",\"5\"\" pipe\",Z\n20.3,,0.0\n");
}

TEST_CASE("measured campaigns of others are read with options only", "[io]") {
  REQUIRE_SHARED_DATA(data);
  CsvOptions lathe;
  lathe.temperatures = {"Ambient", "Ref Temp on Bed", "Spindle*", "Coolantwall", "Transfomerbed"};
  lathe.errors = {"Dia Disp"};
  const Batch day = read_campaign({data + "/real/ace_lathe/day16.csv"}, lathe).batches[0];
  CHECK(day.rows() == 622);
  CHECK(day.temperatures.names ==
        Names{"Ambient", "Ref Temp on Bed", "Spindle Rear", "Spindle Front", "Coolantwall", "Transfomerbed"});
  CHECK(day.errors.values(0, 0) == 43.783572);
  CsvOptions dash;
  dash.temperatures = {"dT*"};
  dash.errors = {"err"};
  CHECK(read_campaign({data + "/real/gooddash/run5.csv"}, dash).batches[0].temperatures.count() == 22);
  CHECK(read_campaign({data + "/real/tclab/real/sin_5_run_1.csv"}).batches[0].errors.count() == 0);
  CHECK(read_table(data + "/pls_reference/gasoline.csv").values.cols() == 402);
}

TEST_CASE("a locale with decimal comma changes nothing", "[io]") {
  const char* name = std::setlocale(LC_ALL, "de_DE.UTF-8");
  if (!name) name = std::setlocale(LC_ALL, "de_DE.utf8");
  if (!name) {
    WARN("skipped: no German locale on this machine");
    return;
  }
  const Batch batch = read_one("time_min,T1,Z\n0,20.5,1.25\n");
  const std::string text = write_csv(batch);
  std::setlocale(LC_ALL, "C");
  CHECK(batch.temperatures.values(0, 0) == 20.5);
  CHECK(text == "time_s,T1,Z\n0,20.5,1.25\n");
}
