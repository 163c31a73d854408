#include "thermfit/io/csv/date_time.hpp"

#include "support/catch.hpp"

using thermfit::parse_date_time;

TEST_CASE("date-times count seconds from 1970 through leap years and zones", "[io]") {
  CHECK(parse_date_time("1970-01-01T00:00:00")->seconds == 0);
  CHECK(parse_date_time("2000-03-01T00:00:00Z")->seconds == 951868800);
  CHECK(parse_date_time("2024-02-29 12:34")->seconds == 1709210040);
  CHECK(parse_date_time("1969-12-31T23:59:59")->seconds == -1);
  CHECK(parse_date_time("2024-05-31T08:00:00+02:00")->seconds == parse_date_time("2024-05-31T06:00:00Z")->seconds);
  CHECK(parse_date_time("2024-05-31T08:00:00-0330")->seconds == parse_date_time("2024-05-31T11:30:00Z")->seconds);
  CHECK(parse_date_time("2024-05-31T08:00:00+02")->has_zone);
  CHECK_FALSE(parse_date_time("2024-05-31T08:00:00")->has_zone);
  CHECK(parse_date_time("2024-05-31T08:00:00.125")->fraction == 0.125);
  CHECK(parse_date_time("2024-05-31T08:00:00,5Z")->fraction == 0.5);
  CHECK(parse_date_time("2024-05-31T08:00:00.9999999999999999999999")->fraction < 1);
}

TEST_CASE("dates that do not exist and other writings are refused", "[io]") {
  for (const char* text : {"", "2024", "2024-05-31", "2024-13-01T00:00", "2023-02-29T00:00", "1900-02-29T00:00",
                           "2024-04-31T00:00", "2024-05-31T24:00", "2024-05-31T08:60", "2024-05-31T08:00:60",
                           "2024-05-31T08:00:00.", "2024-05-31T08:00:00x", "2024-05-31T08:00:00+24:00",
                           "31.05.2024 08:00", "2024-05-31x08:00", "2024-05-31T08:00:00+2", "20240531T080000"}) {
    INFO(text);
    CHECK_FALSE(parse_date_time(text));
  }
}
