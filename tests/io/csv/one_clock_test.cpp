// Channels with clocks of their own: rows stand on one clock, nothing is invented, and what was done is told.
#include "thermfit/io/csv/one_clock.hpp"

#include "support/catch.hpp"
#include "support/read_text.hpp"

using namespace thermfit;

namespace {

/// A course without bends, so that the line between samples is the truth.
double line(double time_s, double offset, double per_s) { return offset + per_s * time_s; }

/// Three channels at their own times, as columns `clock, T1, clock, T2, clock, Z`.
std::string three_clocks(const std::vector<std::string>& clocks, double step2, double offset2, double step3) {
  std::string text = clocks[0] + ",T1," + clocks[1] + ",T2," + clocks[2] + ",Z\n";
  const auto pair = [&](double time, double end, double offset, double per_s) {
    return time <= end ? exact_text(time) + ',' + exact_text(line(time, offset, per_s)) : std::string(",");
  };
  for (int row = 0; row < 61; ++row)
    text += pair(10 * row, 600, 20, 0.01) + ',' + pair(offset2 + step2 * row, 605, 21, 0.02) + ',' +
            pair(step3 * row, 600, 0, 0.5) + '\n';
  return text;
}

}  // namespace

TEST_CASE("channels with clocks of their own are put on the slowest, which is told", "[io]") {
  for (const auto& clocks : std::vector<std::vector<std::string>>{{"time_s", "time_s", "time_s"},
                                                                  {"Time [s]", "Time [s]", "Time [s]"},
                                                                  {"Time 1 [s]", "Time 2 [s]", "Time 3 [s]"},
                                                                  {"time_T1 [s]", "time_T2 [s]", "time_Z [s]"}}) {
    CsvOptions options;
    if (clocks[0].find("T1") != std::string::npos) options.time_column = "time_*";
    const CsvReading reading = read_text(three_clocks(clocks, 25, 5, 60), options);
    const Batch& batch = reading.batches.front();
    INFO(clocks[0]);
    CHECK(batch.inputs.names.empty());
    REQUIRE(batch.rows() == 10);  // 60 … 600 s: T2 begins at 5 s
    for (Index row = 0; row < batch.rows(); ++row) {
      const double time = batch.time_s(row);
      CHECK(time == 60 * static_cast<double>(row + 1));
      CHECK(batch.temperatures.values(row, 0) == Approx(line(time, 20, 0.01)));
      CHECK(batch.temperatures.values(row, 1) == Approx(line(time, 21, 0.02)));
      CHECK(batch.errors.values(row, 0) == Approx(line(time, 0, 0.5)));
    }
    const std::string told = reading.files.front().clocks;
    CHECK(told.find("3 clocks") == 0);
    CHECK(told.find("linear") != std::string::npos);
    CHECK(told.find("1 row left out") != std::string::npos);
  }
}

TEST_CASE("clocks that agree are one, and rows stay as they are", "[io]") {
  const Batch plain = read_text("time_s,T1,T2,Z\n0,20,21,0\n60,20.5,21.5,1\n120,,22,2\n",
                                [] {
                                  CsvOptions options;
                                  options.missing = MissingValues::keep;
                                  return options;
                                }())
                          .batches.front();
  CsvOptions options;
  options.missing = MissingValues::drop;
  const CsvReading reading =
      read_text("time_s,T1,time_s,T2,time_s,Z\n0,20,0,21,0,0\n60,20.5,60,21.5,60,1\n120,,120,22,120,2\n", options);
  const Batch& batch = reading.batches.front();
  CHECK(batch.rows() == 2);
  CHECK(batch.temperatures.values == plain.temperatures.values.topRows(2));
  CHECK(batch.dropped_rows == 1);
  CHECK(reading.files.front().clocks.find("they agree") != std::string::npos);
}

TEST_CASE("of clocks as slow as each other the last to begin is taken, so that the start is kept", "[io]") {
  const Batch batch =
      read_text("time_s,T1,time_s,Z\n0,20,30,1\n300,21,330,2\n600,22,630,3\n900,23,930,4\n").batches.front();
  CHECK(batch.time_s == (Vector(3) << 30, 330, 630).finished());
  CHECK(batch.temperatures.values.col(0).isApprox((Vector(3) << 20.1, 21.1, 22.1).finished(), 1e-12));
  CHECK(batch.errors.values == (Matrix(3, 1) << 1, 2, 3).finished());
}

TEST_CASE("held channels and switches keep their last sample; no line is drawn over a gap", "[io]") {
  const std::string text =
      "time_s,T1,time_s,pump\n0,20,0,OFF\n60,21,90,ON\n120,22,,\n180,23,,\n240,24,,\n600,30,,\n660,31,,\n";
  const Batch batch = read_text(text).batches.front();
  // the pump is as slow as it gets; its samples are the clock
  CHECK(batch.time_s == (Vector(2) << 0, 90).finished());
  CsvOptions held;
  held.between = BetweenSamples::held;
  const Batch steps =
      read_text("time_s,T1,time_s,Z\n0,20,0,0\n60,21,30,1\n120,22,60,2\n180,23,90,3\n", held).batches.front();
  CHECK(steps.errors.values == (Matrix(4, 1) << 0, 2, 3, 3).finished());
  const std::string gap =
      "time_s,T1,time_s,Z\n0,20,0,0\n60,21,30,1\n120,22,60,2\n180,23,90,3\n240,24,420,9\n"
      "300,25,450,9\n360,26,480,9\n420,27,510,9\n480,28,540,9\n";
  CHECK_THROWS_WITH(read_text(gap), Catch::Contains("values are missing"));
  CsvOptions drop;
  drop.missing = MissingValues::drop;
  CHECK(read_text(gap, drop).batches.front().time_s == (Vector(4) << 0, 60, 420, 480).finished());
}

TEST_CASE("clocks of channels may be dates and times, since 1970, and of several batches", "[io]") {
  const Batch stamps = read_text(
                           "Time,T1,Time,Z\n2026-05-04 08:00:00,20,2026-05-04 08:00:30,1\n"
                           "2026-05-04 08:01:00,21,2026-05-04 08:01:30,2\n2026-05-04 08:02:00,22,2026-05-04 "
                           "08:02:30,3\n")
                           .batches.front();
  CHECK(stamps.time_s == (Vector(2) << 0, 60).finished());
  CHECK(stamps.temperatures.values.isApprox((Matrix(2, 1) << 20.5, 21.5).finished(), 1e-6));
  CHECK(stamps.begins_s == 1777881630);
  const Batch ticks = read_text(
                          "Time,T1,Time,Z\n134223552000000000,20,134223552000000000,1\n134223552600000000,21,"
                          "134223552600000000,2\n134223553200000000,22,134223553200000000,3\n")
                          .batches.front();
  CHECK(ticks.time_s.isApprox((Vector(3) << 0, 60, 120).finished(), 1e-9));
  CsvOptions options;
  options.batch_column = "run";
  const Campaign runs =
      read_text("run,time_s,T1,time_s,Z\nA,0,20,0,0\nA,60,21,60,1\nB,0,30,0,5\nB,60,31,60,6\n", options).batches;
  REQUIRE(runs.size() == 2);
  CHECK(runs[1].errors.values == (Matrix(2, 1) << 5, 6).finished());
}

TEST_CASE("rows may be evenly apart whatever a clock says", "[io]") {
  CsvOptions options;
  options.time_step_s = 0.5;
  for (const char* text : {"T1,Z\n20,0\n21,1\n22,2\n", "Time,T1,Z\n08:00,20,0\n08:00,21,1\n08:01,22,2\n"}) {
    const Batch batch = read_text(text, options).batches.front();
    CHECK(batch.time_s == (Vector(3) << 0, 0.5, 1).finished());
    CHECK(batch.inputs.names.empty());
  }
}
