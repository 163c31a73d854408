#include "thermfit/io/csv/line_reader.hpp"

#include <cmath>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

std::string complaint(const std::string& names, const std::string& wanted) {
  try {
    CsvLineReader(names, 3, "pipe").find(wanted, Quantity::temperature);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("cells are converted from the unit that the name tells") {
  CsvLineReader table("T1 [degF],Z (mm)", 1, "pipe");
  REQUIRE(table.take("68,0.5"));
  CHECK(table.value(0, Quantity::temperature) == 20);
  CHECK(table.value(1, Quantity::length) == 500);
}

TEST_CASE("a cell that is no number is NaN") {
  CsvLineReader table("T1,T2,T3", 1, "pipe");
  REQUIRE(table.take(",NA,warm"));
  for (std::size_t c = 0; c < 3; ++c) CHECK(std::isnan(table.value(c, Quantity::temperature)));
}

TEST_CASE("a comma is a decimal mark only where it does not separate") {
  CsvLineReader semicolons("T1;T2", 1, "pipe"), commas("T1,T2", 1, "pipe");
  REQUIRE(semicolons.take("20,5;20.5"));
  CHECK(semicolons.value(0, Quantity::temperature) == 20.5);
  CHECK(semicolons.value(1, Quantity::temperature) == 20.5);
  REQUIRE(commas.take("20,5"));
  CHECK(commas.value(0, Quantity::temperature) == 20);
}

TEST_CASE("a column that is not there is nothing, one that is doubtful is told with its place") {
  CHECK_FALSE(CsvLineReader("T1,T2", 1, "pipe").find("T3", Quantity::temperature));
  CHECK(complaint("T1,T2,T1", "T1") == "pipe:3: column 'T1' twice");
  CHECK(complaint("T2,T1 [mm]", "T1") == "pipe:3:4: unit 'mm' of 'T1'; allowed: degC, °C, C, degF, °F, F, K");
  CHECK(complaint("T2,T1 [smoots]", "T1").find("unit 'smoots' of 'T1'") != std::string::npos);
  CHECK(complaint("T1,\"T2", "T1").find("pipe:3:4: a quote that is opened here and never closed") == 0);
  CHECK(complaint("T1,T\xFC", "T1").find("pipe:3: names that are not UTF-8") == 0);
}
