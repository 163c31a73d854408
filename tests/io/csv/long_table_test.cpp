// A line for each value: the same batch as a column for each name.
#include "thermfit/io/csv/long_table.hpp"

#include "support/catch.hpp"
#include "support/read_text.hpp"

using namespace thermfit;

namespace {

const std::string wide = "time_s,T1,T2,Z\n0,20.5,21,0\n60,21.5,21.25,1.5\n120,22,21.5,2\n";

}  // namespace

TEST_CASE("a long table is read as a wide one, in any order of its lines, and that is told", "[io]") {
  const Batch expected = read_text(wide).batches.front();
  for (const std::string text :
       {"time_s,variable,value\n0,T1,20.5\n0,T2,21\n0,Z,0\n60,T1,21.5\n60,T2,21.25\n60,Z,1.5\n120,T1,22\n120,T2,21.5\n"
        "120,Z,2\n",
        "Tagname;Zeit in s;Wert\nT1;0;20,5\nT1;60;21,5\nT1;120;22\nT2;0;21\nT2;60;21,25\nT2;120;21,5\nZ;0;0\nZ;60;1,5\n"
        "Z;120;2\nEOF\n",
        "export of 4 May\n\ntime "
        "[min]\tchannel\tvalue\tunit\tquality\n0\tT1\t20.5\tdegC\tgood\n1\tT1\t21.5\tdegC\tgood\n2\tT1\t"
        "22\tdegC\tgood\n0\tT2\t21\tdegC\tgood\n0\tZ\t0\tmm\tgood\n1\tT2\t21.25\tdegC\tgood\n1\tZ\t0."
        "0015\tmm\tgood\n2\t"
        "T2\t21.5\tdegC\tgood\n2\tZ\t0.002\tmm\tgood\n"}) {
    INFO(text);
    const CsvReading reading = read_text(text);
    const Batch& batch = reading.batches.front();
    CHECK(batch.temperatures.names == expected.temperatures.names);
    CHECK(batch.time_s.isApprox(expected.time_s, 1e-13));
    CHECK(batch.temperatures.values == expected.temperatures.values);
    CHECK(batch.errors.values.isApprox(expected.errors.values, 1e-13));
    CHECK(reading.files.front().widened.find("a line for each value") == 0);
  }
}

TEST_CASE("options name the columns of a long table, split it into batches, or refuse it", "[io]") {
  CsvOptions options;
  options.long_table = {"what", "how much"};
  options.batch_column = "run";
  const Campaign runs = read_text(
                            "run,when [s],what,how much\nA,0,T1,20\nA,0,Z,0\nA,60,T1,21\nA,60,Z,1\nB,0,T1,30\nB,0,Z,5\n"
                            "B,60,T1,31\nB,60,Z,6\n",
                            [&] {
                              options.time_column = "when";
                              return options;
                            }())
                            .batches;
  REQUIRE(runs.size() == 2);
  CHECK(runs[0].temperatures.values == (Matrix(2, 1) << 20, 21).finished());
  CHECK(runs[1].errors.values == (Matrix(2, 1) << 5, 6).finished());
  CsvOptions never;
  never.long_table = {"none"};
  CHECK_THROWS_WITH(read_text("time_s,variable,value\n0,T1,20.5\n60,T1,21\n", never),
                    Catch::Contains("no temperature point"));
}

TEST_CASE("names that are logged at times of their own are put on one clock", "[io]") {
  std::string text = "time_s,name,value\n";
  for (int i = 0; i <= 20; ++i) {
    text += std::to_string(30 * i) + ",Z," + exact_text(0.5 * 30 * i) + '\n';
    if (i % 2 == 0) text += std::to_string(30 * i + 15) + ",T1," + exact_text(20 + 0.01 * (30 * i + 15)) + '\n';
  }
  const Batch batch = read_text(text).batches.front();
  REQUIRE(batch.rows() == 10);
  for (Index row = 0; row < batch.rows(); ++row) {
    CHECK(batch.time_s(row) == 60 * static_cast<double>(row) + 15);
    CHECK(batch.errors.values(row, 0) == Approx(0.5 * batch.time_s(row)));
  }
}

TEST_CASE("a column that is called as names of channels are, but holds numbers, makes no long table", "[io]") {
  const Batch batch = read_text("time_s,T1,Z,signal,value\n0,20,0,1,5\n60,21,1,2,6\n").batches.front();
  CHECK(batch.inputs.names == std::vector<std::string>{"signal", "value"});
}
