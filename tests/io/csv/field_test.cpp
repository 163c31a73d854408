#include "thermfit/io/csv/field.hpp"

#include <random>

#include "support/catch.hpp"

using namespace thermfit::detail;

TEST_CASE("the fast path for plain numbers gives the bits of from_chars", "[io]") {
  std::mt19937_64 random(1);
  int fast = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    std::string text = random() % 3 ? "" : "-";
    const auto whole = random() % 18, decimals = random() % 18;
    for (std::uint64_t i = 0; i < whole; ++i) text += static_cast<char>('0' + random() % 10);
    if (random() % 4) text += '.';
    for (std::uint64_t i = 0; i < decimals; ++i) text += static_cast<char>('0' + random() % 10);
    double value = 0;
    const char* at = text.data();
    const bool plain = parse_fixed(at, text.data() + text.size(), '.', value);
    const auto reference = thermfit::parse_number(text);
    if (!plain || at != text.data() + text.size()) continue;
    ++fast;
    REQUIRE(reference.has_value());
    REQUIRE(std::signbit(value) == std::signbit(*reference));
    REQUIRE(value == *reference);
  }
  CHECK(fast > 50000);
}

TEST_CASE("the fast path leaves exponents, long numbers, signs and rubbish to the careful one", "[io]") {
  for (const std::string text : {"", "-", ".", "-.", "+1", "1234567890123456789", "9007199254740993", "abc", "nan"}) {
    INFO(text);
    double value = 0;
    const char* at = text.data();
    CHECK_FALSE((parse_fixed(at, text.data() + text.size(), '.', value) && at == text.data() + text.size()));
  }
}

TEST_CASE("fields are split at separators outside quotes, without the blanks around", "[io]") {
  std::vector<CsvField> fields;
  REQUIRE_FALSE(split_line(R"( a ,"b, ""c""" ,, d e,)", ',', fields));
  REQUIRE(fields.size() == 5);
  CHECK(fields[0].text == "a");
  CHECK(fields[0].column == 2);
  CHECK(fields[1].name() == "b, \"c\"");
  CHECK(fields[2].text.empty());
  CHECK(fields[3].text == "d e");
  CHECK(fields[3].column == 19);
  CHECK(fields[4].text.empty());
  REQUIRE_FALSE(split_line("1\t\t 2 ", '\t', fields));
  CHECK(fields.size() == 3);
}

TEST_CASE("missing values are known in any case, and nothing else is taken for one", "[io]") {
  for (const char* text : {"", "NA", "na", "N/A", "NaN", "nan", "NULL", "null", "-", "OL", "#NV", "Overflow", "none"})
    CHECK(is_missing(text));
  for (const char* text : {"-1", "nan(1)", "0", "nil", "NAN ", "on", "off", "*1", "old"}) CHECK_FALSE(is_missing(text));
}
