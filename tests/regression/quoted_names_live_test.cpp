// `run` had a reader and a writer of CSV names of its own. The reader knew no comment behind a byte order mark; the
// writer put quotes inside a field and did not double those of a name, so no CSV reader could take its answers.
#include "commands/live_compensation.hpp"
#include "support/catch.hpp"
#include "support/scratch_folder.hpp"
#include "thermfit/io/csv/reader.hpp"

using namespace thermfit;

namespace {

const std::vector<std::string> awkward{"bed, left", "the \"cold\" end", "a;b;c", "T4"};

std::vector<std::string> names_of(const CsvLineReader& reader) {
  std::vector<std::string> names;
  for (const CsvColumn& column : reader.columns()) names.push_back(column.title);
  return names;
}

TrainedModel model_of(const std::vector<std::string>& temperatures, const std::vector<std::string>& errors) {
  const auto sensors = static_cast<Index>(temperatures.size()), outputs = static_cast<Index>(errors.size());
  TrainedModel trained;
  trained.temperatures = temperatures;
  trained.errors = errors;
  trained.model.intercept = Vector::Zero(outputs);
  trained.model.coefficients = Matrix::Ones(sensors, outputs);
  trained.error_mean = Vector::Zero(outputs);
  trained.error_scale = Vector::Constant(outputs, 100);
  return trained;
}

}  // namespace

TEST_CASE("names in quotes, doubled quotes and separators inside quotes are one column each") {
  const std::string line = R"(time_s,"bed, left [degF]","the ""cold"" end","a;b;c",T4)";
  for (const char* before : {"", "\xEF\xBB\xBF"})
    for (const char* end : {"", "\r"}) {
      const CsvLineReader reader(before + line + end, 1, "standard input");
      std::vector<std::string> names;
      for (const CsvColumn& column : reader.columns()) names.push_back(column.name);
      CHECK(names.front() == "time_s");
      names.erase(names.begin());
      CHECK(names == awkward);
      CHECK(reader.columns()[1].unit == "degF");
      CHECK(reader.find("the \"cold\" end", Quantity::temperature) == 2);
    }
}

TEST_CASE("a file and a stream with the same first line have the same columns") {
  const ScratchFolder folder;
  const std::string line = "\xEF\xBB\xBFtime_s,\"bed, left [degF]\",\"the \"\"cold\"\" end\",\"a;b;c\",T4\r";
  const std::string path = folder.write("one.csv", line + "\n0,68,20,20,20\r\n1,86,21,21,21\r\n");
  CsvOptions options;
  options.temperatures = awkward;
  const CsvReading reading = read_campaign({path}, options);
  CHECK(reading.batches[0].temperatures.names == awkward);

  CsvLineReader stream(line, 1, "standard input");
  REQUIRE(stream.take("1,86,21,21,21\r"));
  for (std::size_t i = 0; i < awkward.size(); ++i) {
    const auto column = stream.find(awkward[i], Quantity::temperature);
    REQUIRE(column);
    CHECK(stream.value(*column, Quantity::temperature) ==
          reading.batches[0].temperatures.values(1, static_cast<Index>(i)));
  }
}

TEST_CASE("a comment behind a byte order mark is a comment") {
  CHECK_FALSE(CsvLineReader::has_content("\xEF\xBB\xBF# logged by hand"));
  CHECK_FALSE(CsvLineReader::has_content(" \t\r"));
  CHECK(CsvLineReader::has_content("\xEF\xBB\xBFT1"));
}

TEST_CASE("a row that is not the header's is refused and leaves the one before") {
  CsvLineReader stream("T1;T2", 1, "standard input");
  REQUIRE(stream.take("1,5;\"2\""));
  CHECK_FALSE(stream.take("1;2;3"));
  CHECK_FALSE(stream.take("\"1;2"));
  CHECK(stream.value(0, Quantity::temperature) == 1.5);
  CHECK(stream.value(1, Quantity::temperature) == 2);
}

TEST_CASE("the answers of `run` name awkward errors and sensors so that they can be read back") {
  cli::LiveCompensation live(model_of(awkward, {"Z, \"hot\"", "X"}), {}, true);
  live.read_header(R"("bed, left","the ""cold"" end","a;b;c",T4,"Z, ""hot""")", 1);
  CHECK(names_of(CsvLineReader(live.answer_header(), 1, "answers")) ==
        std::vector<std::string>{"line", "offset_Z, \"hot\"_um", "offset_X_um", "state", "status", "sensor", "fault",
                                 "zero", "shadow_Z, \"hot\"_um", "shadow_X_um", "remaining_Z, \"hot\"_um"});
  REQUIRE(live.read_readings("20,20,no number,20,1"));
  CsvLineReader answers(live.answer_header(), 1, "answers");
  CHECK(answers.take(live.answer(2)));
}
