// Stamps coarser than the rows: the rows of one stamp are evenly apart where all stamps have as many, else it is asked.
#include "thermfit/io/csv/stamp_runs.hpp"

#include "support/catch.hpp"
#include "support/read_text.hpp"

using namespace thermfit;

namespace {

/// Rows every `step_s` from `first_s` after eight o'clock, stamped to the minute or the second.
std::string rows(int first_s, int step_s, int count, bool to_minutes, const std::string& date = {}) {
  std::string text = "Time,T1,Z\n";
  for (int row = 0; row < count; ++row) {
    const int time = 8 * 3600 + first_s + step_s * row;
    char stamp[64];
    if (to_minutes)
      std::snprintf(stamp, sizeof stamp, "%s%02d:%02d", date.c_str(), time / 3600, time / 60 % 60);
    else
      std::snprintf(stamp, sizeof stamp, "%s%02d:%02d:00", date.c_str(), time / 3600, time / 60 % 60);
    text += std::string(stamp) + ',' + std::to_string(20 + row) + ",0\n";
  }
  return text;
}

}  // namespace

TEST_CASE("rows that share a minute are evenly apart, also where the first minute is not whole", "[io]") {
  for (const char* date : {"", "2026-05-04 ", "04.05.2026 ", "5/14/2026 "})
    for (const int first_s : {0, 20, 50})
      for (const int step_s : {5, 10, 20, 30})
        for (const bool to_minutes : {true, false}) {
          const CsvReading reading = read_text(rows(first_s - first_s % step_s, step_s, 70, to_minutes, date));
          const Batch& batch = reading.batches.front();
          INFO(date << first_s << ' ' << step_s);
          REQUIRE(batch.rows() == 70);
          for (Index row = 0; row < 70; ++row) CHECK(batch.time_s(row) == Approx(step_s * row).margin(1e-9));
          CHECK(reading.files.front().roles.clock.find("rows a stamp") != std::string::npos);
        }
}

TEST_CASE("stamps that repeat unevenly are an error that says what to write", "[io]") {
  CHECK_THROWS_WITH(read_text(rows(0, 7, 70, true)), Catch::Contains("CsvOptions::time_step_s = SECONDS"));
  CsvOptions options;
  options.time_step_s = 7;
  CHECK(read_text(rows(0, 7, 70, true), options).batches.front().time_s(69) == 483);
}
