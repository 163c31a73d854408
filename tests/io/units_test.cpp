#include "thermfit/io/units.hpp"

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("units convert exactly where the decimal numbers do", "[io]") {
  const auto in_canonical = [](const char* unit, double value) { return find_unit(unit).value().to_canonical(value); };
  CHECK(in_canonical("degF", 212) == 100);
  CHECK(in_canonical("°F", -40) == -40);
  CHECK(in_canonical("K", 273.15) == 0);
  CHECK(in_canonical("mm", 0.025) == 25);
  CHECK(in_canonical("nm", 250) == 0.25);
  CHECK(in_canonical("µm", 7) == 7);  // micro sign
  CHECK(in_canonical("μm", 7) == 7);  // Greek mu
  CHECK(in_canonical("0.1 um", 250) == 25);
  CHECK(in_canonical("mil", 1) == Approx(25.4));
  CHECK(in_canonical("microinch", 1000) == Approx(25.4));
  CHECK(in_canonical("h", 0.1) == 360);
  CHECK(in_canonical("ms", 1500) == 1.5);
  CHECK(in_canonical("0.1 K", 2931.5) == Approx(20).epsilon(1e-12));
}

TEST_CASE("every unit of the table is found, knows its quantity, and no other text is a unit", "[io]") {
  for (const auto& [name, unit] : detail::unit_table) {
    REQUIRE(find_unit(name));
    CHECK(find_unit(name)->quantity == unit.quantity);
  }
  CHECK(find_unit("degC")->is_canonical());
  CHECK_FALSE(find_unit("K")->is_canonical());
  for (const char* text : {"", "degX", "MM", "um ", "0 um", "-1 um", "x um", "2 degX", "1 2 um"})
    CHECK_FALSE(find_unit(text));
}
