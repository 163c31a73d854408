// Numbers as people and instruments spell them: the same batch, and what was taken for what is told.
#include "thermfit/io/csv/spelled.hpp"

#include "support/catch.hpp"
#include "support/read_text.hpp"

using namespace thermfit;
using namespace thermfit::detail;

namespace {

std::string with(std::string text, const std::string& what, const std::string& instead) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += instead.size())
    text.replace(at, what.size(), instead);
  return text;
}

const std::string plain = "time_s;T1;Z;rpm\n0;20.5;-1234.5;12000\n60;21;1250;1500000\n120;-3;7;900\n";

void check_same(const Batch& batch) {
  const Batch expected = read_text(plain).batches.front();
  CHECK(batch.time_s == expected.time_s);
  CHECK(batch.temperatures.values == expected.temperatures.values);
  CHECK(batch.errors.values == expected.errors.values);
  REQUIRE(batch.inputs.names == expected.inputs.names);
  CHECK(batch.inputs.values == expected.inputs.values);
}

}  // namespace

TEST_CASE("thousands are undone whatever groups them, where it can be nothing else", "[io]") {
  for (const char* mark : {" ", "\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89", "'", "\xE2\x80\x99", ","}) {
    INFO("'" << mark << "'");
    std::string text = with(with(with(plain, "1234.5", "1,234.5"), "12000", "12,000"), "1500000", "1,500,000");
    check_same(read_text(with(text, ",", mark)).batches.front());
  }
  const std::string german =
      with(with(with(with(plain, ".", ","), "1234,5", "1.234,5"), "12000", "12.000"), "1500000", "1.500.000");
  const CsvReading reading = read_text(german);
  check_same(reading.batches.front());
  CHECK(reading.notes({}).front().find("thousands grouped by points") != std::string::npos);
}

TEST_CASE("a mark that may be a decimal one too groups thousands only where that is said", "[io]") {
  const std::string text = "time_s;T1;rpm\n0;20,5;12.000\n60;21,5;13.500\n";
  CHECK_THROWS_AS(read_text(text), Error);
  CsvOptions options;
  options.thousands = '.';
  CHECK(read_text(text, options).batches.front().inputs.values == (Matrix(2, 1) << 12000, 13500).finished());
  options.thousands = 0;
  options.decimal_mark = ',';
  const CsvReading left_out = read_text(text, options);
  CHECK(left_out.batches.front().inputs.names.empty());
  CHECK(left_out.files.front().roles.may_be_grouped == std::vector<std::string>{"rpm"});
}

TEST_CASE("groups have three digits and begin with another than 0", "[io]") {
  for (const char* text :
       {"12,34", "1,2345", "0,123", "1,23,456", "1234,567", ",123", "1,", "1,234,", "1,,234", "-,123"}) {
    INFO(text);
    CHECK_FALSE(ungrouped(text, ',', '.'));
  }
  CHECK(ungrouped("-1,234,567.25e3", ',', '.') == std::string("-1234567.25e3"));
  CHECK(ungrouped("\xE2\x88\x92"
                  "1.234",
                  '.', ',') == std::string("-1234"));
}

TEST_CASE("a unit behind every number of a column is its unit", "[io]") {
  const std::string text =
      "time;T1;Z;rpm\n0 min;68.9 °F;-1.2345 mm;12000 1/min\n1 min;69.8 °F;1.25 mm;1500000 1/min\n"
      "2 min;26.6\xC2\xA0°F;0.007mm;900 1/min\n";
  const CsvReading reading = read_text(text);
  const Batch& batch = reading.batches.front();
  CHECK(batch.time_s == (Vector(3) << 0, 60, 120).finished());
  CHECK(batch.temperatures.values.isApprox((Matrix(3, 1) << 20.5, 21, -3).finished(), 1e-13));
  CHECK(batch.errors.values.isApprox((Matrix(3, 1) << -1234.5, 1250, 7).finished(), 1e-13));
  CHECK(batch.inputs.values == (Matrix(3, 1) << 12000, 1500000, 900).finished());
  CHECK(reading.files.front().roles.spelled ==
        std::vector<std::string>{"time in min", "T1 in °F", "Z in mm", "rpm in 1/min"});
}

TEST_CASE("words behind numbers that are not all alike make text of a column", "[io]") {
  const Batch batch = read_text("time_s,T1,tool\n0,20,1 mill\n60,21,2 drill\n").batches.front();
  CHECK(batch.inputs.names.empty());
  CHECK_FALSE(split_unit_in_cell("T1"));
  CHECK_FALSE(split_unit_in_cell("12a"));
  CHECK_FALSE(split_unit_in_cell("run 12 of 20"));
  CHECK(split_unit_in_cell("45%")->second == "%");
}

TEST_CASE("on and off, true and false are inputs of 1 and 0", "[io]") {
  for (const auto& [on, off] : std::vector<std::pair<std::string, std::string>>{
           {"ON", "OFF"}, {"True", "False"}, {"yes", "no"}, {"EIN", "AUS"}, {"wahr", "falsch"}, {"1", "0"}}) {
    INFO(on);
    const Batch batch =
        read_text("time_s,T1,pump\n0,20," + off + "\n60,21," + on + "\n120,21.5," + on + "\n").batches.front();
    CHECK(batch.inputs.names == std::vector<std::string>{"pump"});
    CHECK(batch.inputs.values == (Matrix(3, 1) << 0, 1, 1).finished());
  }
  CHECK(read_text("time_s,T1,pump\n0,20,on\n60,21,false\n").batches.front().inputs.names.empty());
  CHECK_THROWS_AS(read_text("time_s,T1,pump\n" + std::string(9000, '#') + "\n0,20,on\n60,21,off\n" +
                            with(std::string(20000, '#'), "#", "70,20,on\n") + "x"),
                  Error);
}

TEST_CASE("hidden blanks, tabs before numbers and doubled carriage returns change nothing", "[io]") {
  for (const std::string& text :
       {with(plain, ";", "\xC2\xA0;\xC2\xA0"), with(plain, ";", ";\t"), with(plain, "\n", "\r\r\n"),
        with(plain, "\n", "\r\n\r\n"), with(plain, "-", "\xE2\x88\x92"), with(with(plain, ";", ","), ",", ",\t")}) {
    INFO(text);
    check_same(read_text(text).batches.front());
  }
}

TEST_CASE("names that are given stand in place of those that are there, whose units stay", "[io]") {
  CsvOptions options;
  options.columns = {"time", "T1", "Z", "speed"};
  for (const std::string before : {"", "Warm-up, machine 7\n\n", "sep=;\n"}) {
    const CsvReading reading = read_text(before + with(plain, "time_s;T1;Z;rpm", "Zeit [s];Temp;Temp;"), options);
    const Batch& batch = reading.batches.front();
    INFO(before);
    CHECK(batch.time_s == (Vector(3) << 0, 60, 120).finished());
    CHECK(batch.errors.values == (Matrix(3, 1) << -1234.5, 1250, 7).finished());
    CHECK(batch.inputs.names == std::vector<std::string>{"speed"});
    CHECK(reading.files.front().roles.replaced.find("Zeit [s], Temp, Temp") != std::string::npos);
  }
  const CsvReading bare = read_text(plain.substr(plain.find('\n') + 1), options);
  CHECK(bare.batches.front().rows() == 3);
  CHECK(bare.files.front().roles.replaced.empty());
}
