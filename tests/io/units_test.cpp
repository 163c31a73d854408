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

TEST_CASE("every name of the table is found and knows its quantity, and no other text is a unit", "[io]") {
  for (const auto& [names, unit] : detail::unit_table)
    for (std::size_t at = 1; at < names.size();) {
      const std::size_t end = names.find(' ', at);
      const std::string name(names.substr(at, end - at));
      INFO(name);
      REQUIRE(find_unit(name));
      CHECK(find_unit(name)->is_same_as(unit));
      at = end + 1;
    }
  CHECK(find_unit("degC")->is_canonical());
  CHECK_FALSE(find_unit("K")->is_canonical());
  for (const char* text :
       {"", " ", "degX", "um um", "0 um", "-1 um", "x um", "2 degX", "1 2 um", "1/0 um", "°", "in in"})
    CHECK_FALSE(find_unit(text));
}

TEST_CASE(
    "a unit is known in any case and with any sign that looks like a degree, but not where case tells units apart",
    "[io]") {
  const auto same = [](const char* text, const char* as) { return find_unit(text).value().is_same_as(*find_unit(as)); };
  for (const char* text : {"DEGC", "Deg. C", "deg C", "ºC", "˚C", "℃", "oC", "°c", "Grad C", "grad Celsius",
                           "degrees C", "Degree Celsius", "CELSIUS",
                           "\xC2\xB0\xC2\xA0"
                           "C",
                           "deg_C"})
    CHECK(same(text, "degC"));
  for (const char* text : {"DegF", "Deg. F", "ºF", "℉", "FAHRENHEIT"}) CHECK(same(text, "degF"));
  for (const char* text : {"UM", "Microns", "MICRON", "Micrometer", "µ", "µM"}) CHECK(same(text, "um"));
  for (const char* text : {"MM", "Millimeter"}) CHECK(same(text, "mm"));
  for (const char* text : {"S", "Sec", "Sekunden", "SECONDS"}) CHECK(same(text, "s"));
  for (const char* text : {"Nm", "NM", "Mm", "M"}) CHECK_FALSE(find_unit(text));
}

TEST_CASE("a factor stands before a unit with or without a blank, as a fraction or a power", "[io]") {
  for (const char* text : {"0.1 um", "0.1um", "0,1 µm", "1/10 um", "1e-1um", "10^-1 um", "0.1*um", "100nm", "1e-4 mm"})
    CHECK(find_unit(text).value().to_canonical(250) == Approx(25).epsilon(1e-14));
  CHECK(find_unit("1/1000 mm").value().is_canonical());
  CHECK(find_unit("1.25um").value().to_canonical(8) == 10);
}
