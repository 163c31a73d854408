// Campaigns written with every clock that loggers have read back with the times they were made from.
#include "thermfit/io/csv/stamp.hpp"

#include <functional>
#include <random>

#include "support/catch.hpp"
#include "support/scratch_folder.hpp"
#include "thermfit/io/csv/reader.hpp"

using namespace thermfit;

namespace {

CsvReading read(const std::string& text, const CsvOptions& options = {}) {
  const ScratchFolder folder;
  return read_campaign({folder.write("a.csv", text)}, options);
}

std::string two(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }

/// What a clock shows `s` seconds after 2026-05-27T23:00:00; the campaign passes midnight and the end of the month.
struct Wall {
  int day, month, hour, minute, second;
};
Wall wall(long s) {
  const long t = 23 * 3600 + s, days = t / 86400, in_day = t % 86400;
  const int date = static_cast<int>(27 + days);
  return {date > 31 ? date - 31 : date, date > 31 ? 6 : 5, static_cast<int>(in_day / 3600),
          static_cast<int>(in_day / 60 % 60), static_cast<int>(in_day % 60)};
}
std::string clock24(const Wall& w) { return two(w.hour) + ':' + two(w.minute) + ':' + two(w.second); }

struct Clock {
  const char* header;
  std::function<std::string(long)> cell;
};

const std::vector<Clock> clocks{
    {"time_s", [](long s) { return std::to_string(s); }},
    {"TIME [ms]", [](long s) { return std::to_string(1000 * s); }},
    {"Zeit in s", [](long s) { return std::to_string(s); }},
    {"Elapsed Time (s)", [](long s) { return std::to_string(s); }},
    {"stamp",
     [](long s) {
       const Wall w = wall(s);
       return "2026-" + two(w.month) + '-' + two(w.day) + 'T' + clock24(w);
     }},
    {"stamp",
     [](long s) {
       const Wall w = wall(s);
       return "2026-" + std::to_string(w.month) + '-' + std::to_string(w.day) + ' ' + clock24(w);
     }},
    {"stamp",
     [](long s) {
       const Wall w = wall(s);
       return "2026/" + two(w.month) + '/' + two(w.day) + ' ' + clock24(w) + ".000";
     }},
    {"stamp",
     [](long s) {
       const Wall w = wall(s);
       return "2026/" + two(w.month) + '/' + two(w.day) + '-' + clock24(w);
     }},
    {"Datum",
     [](long s) {
       const Wall w = wall(s);
       return two(w.day) + '.' + two(w.month) + ".2026 " + clock24(w);
     }},
    {"Datum",
     [](long s) {
       const Wall w = wall(s);
       return std::to_string(w.day) + '.' + std::to_string(w.month) + ".26 " + clock24(w);
     }},
    {"stamp",
     [](long s) {
       const Wall w = wall(s);
       return two(w.day) + '/' + two(w.month) + "/2026 " + clock24(w);
     }},
    {"stamp",
     [](long s) {
       const Wall w = wall(s);
       return two(w.month) + '/' + two(w.day) + "/2026 " + clock24(w);
     }},
    {"stamp",
     [](long s) {
       const Wall w = wall(s);
       return two(w.day) + (w.month == 5 ? "-May-2026 " : "-Jun-2026 ") + clock24(w);
     }},
    {"stamp",
     [](long s) {
       const Wall w = wall(s);
       const int hour = w.hour % 12 == 0 ? 12 : w.hour % 12;
       return std::to_string(w.month) + '/' + std::to_string(w.day) + "/2026 " + std::to_string(hour) + ':' +
              two(w.minute) + ':' + two(w.second) + (w.hour < 12 ? " AM" : " PM");
     }},
    {"Date;Time",
     [](long s) {
       const Wall w = wall(s);
       return two(w.day) + '.' + two(w.month) + ".2026;" + clock24(w);
     }},
    {"Date;Time",
     [](long s) {
       const Wall w = wall(s);
       return "2026-" + two(w.month) + '-' + two(w.day) + ';' + clock24(w);
     }},
    {"Uhrzeit", [](long s) { return clock24(wall(s)); }},
    {"Time",
     [](long s) {
       return two(static_cast<int>(s / 3600)) + ':' + two(static_cast<int>(s / 60 % 60)) + ':' +
              two(static_cast<int>(s % 60));
     }},
    {"timestamp", [](long s) { return std::to_string(1777881600 + s); }},
    {"time", [](long s) { return std::to_string(1777881600000 + 1000 * s); }},
    {"Time", [](long s) { return exact_text(46146.01 + static_cast<double>(s) / 86400); }},
};

}  // namespace

TEST_CASE("every clock gives the times it was made from, across midnight, months and days", "[io]") {
  std::mt19937 random(7);
  for (const Clock& clock : clocks) {
    std::string text = std::string(clock.header) + ";T1;Z\n";
    Vector expected(6000 / 60);
    long s = 0;
    for (Index row = 0; row < expected.size(); ++row, s += 60 + static_cast<long>(random() % 9000)) {
      expected(row) = static_cast<double>(s);
      text += clock.cell(s) + ";20.5;1.5\n";
    }
    INFO(clock.header << ", " << clock.cell(0));
    const bool spreadsheet = clock.cell(0).rfind("46146.01", 0) == 0;
    CsvOptions options;
    if (spreadsheet) options.time_format = TimeFormat::serial_days;
    const CsvReading reading = read(text, options);
    const Vector& found = reading.batches.front().time_s;
    REQUIRE(found.size() == expected.size());
    CHECK((found - expected).cwiseAbs().maxCoeff() <= (spreadsheet ? 1e-5 : 0));
    CHECK(reading.batches.front().inputs.count() == 0);
  }
}

TEST_CASE("a clock that is not plain is told, with how it is read", "[io]") {
  const auto told = [](const std::string& header, const std::string& cells) {
    const CsvReading reading = read(header + ";T1\n" + cells);
    return reading.files.front().roles.clock;
  };
  CHECK(told("time_s", "0;20\n").empty());
  CHECK(told("at", "2026-05-04T08:00:00;20\n").empty());
  CHECK(told("at", "4.5.2026 8:00;20\n") == "at is read as dates and times, day before month");
  CHECK(told("at", "2026/5/4 8:00;20\n") == "at is read as dates and times, year before month");
  CHECK(told("at", "4/5/2026 8:00;20\n") == "at is read as dates and times, all of one date");
  CHECK(told("at", "4/5/2026 8:00;20\n4/13/2026 8:00;20\n") == "at is read as dates and times, month before day");
  CHECK(told("at", "8:00:00;20\n") == "at is read as a time of day or elapsed time");
  CHECK(told("time", "1777881600;20\n") == "time is read as seconds since 1970");
  CHECK(told("Time", "46146.25;20\n46146.2507;20\n") == "Time is read as days, as spreadsheets count them");
  CHECK(told("Time", "46146;20\n46147;20\n").empty());
}

TEST_CASE("day and month are not guessed: where the order matters and nothing tells, it must be said", "[io]") {
  const std::string text = "at,T1\n4/5/2026 8:00,20\n5/5/2026 8:00,21\n";
  try {
    read(text);
    FAIL("read");
  } catch (const Error& error) {
    CHECK(
        std::string(error.what()).find(":3:1: at is '5/5/2026 8:00', day or month first: nothing in the file tells") !=
        std::string::npos);
  }
  CsvOptions options;
  options.time_format = TimeFormat::day_first;
  CHECK(read(text, options).batches.front().time_s(1) == 86400);
  options.time_format = TimeFormat::month_first;
  CHECK(read(text, options).batches.front().time_s(1) == 30 * 86400.);
}

TEST_CASE("rows that come newest first are turned round, and told; time that goes to and fro is refused", "[io]") {
  for (const char* text :
       {"time_s,T1,Z\n120,22,3\n60,21,2\n0,20,1\n", "at,T1,Z\n8:02:00,22,3\n8:01:00,21,2\n8:00:00,20,1\n"}) {
    const CsvReading reading = read(text);
    const Batch& batch = reading.batches.front();
    CHECK(batch.time_s == (Vector(3) << 0, 60, 120).finished());
    CHECK(batch.temperatures.values == (Matrix(3, 1) << 20, 21, 22).finished());
    CHECK(batch.errors.values == (Matrix(3, 1) << 1, 2, 3).finished());
    CHECK(reading.files.front().newest_first);
  }
  CHECK_THROWS_AS(read("time_s,T1\n120,22\n60,21\n90,20\n"), Error);
  CHECK_THROWS_AS(read("time_s,T1\n120,22\n60,21\n"), Error);
  CsvOptions any;
  any.increasing_time = false;
  CHECK(read("time_s,T1\n120,22\n60,21\n90,20\n", any).batches.front().time_s(0) == 120);
  CHECK(read("time_s,T1\n120,22\n60,21\n30,20\n", any).batches.front().time_s(0) == 30);
  CHECK_THROWS_AS(read("time_s,T1\n0,22\n60,21\n30,20\n"), Error);
}

TEST_CASE("what is no stamp is none", "[io]") {
  for (const char* text : {"", "8", "8:5", "12.5", "1.2.3", "2026-05-04x", "2026-05-04 25:00:00", "8:00 XM", "13:00 PM",
                           "4.5.2026 8:00:00 later", "abc", "1/2", "-1:00:00", "2026-05/04"})
    CHECK_FALSE(detail::parse_stamp(text));
  for (const char* text : {"31.02.2026", "29.02.2025", "0.5.2026"})
    CHECK_FALSE(detail::instant(*detail::parse_stamp(text), DateOrder::day_first));
}

TEST_CASE("of rows that come newest first the oldest is row 1, also where it is left out, and rises count from it",
          "[io]") {
  CsvOptions options;
  options.missing = MissingValues::drop;
  const Batch batch = read(
                          "at,T1,Z\n2026-05-04 8:03:00,23,4\n2026-05-04 8:02:00,22,3\n2026-05-04 "
                          "8:01:00,21,2\n2026-05-04 8:00:00,20,\n",
                          options)
                          .batches.front();
  CHECK(batch.rows() == 3);
  CHECK(batch.number_of(0) == 2);
  CHECK(batch.first_degC == (Vector(1) << 20).finished());
}
