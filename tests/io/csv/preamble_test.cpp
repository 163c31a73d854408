// Lines that are no rows, wherever they stand: the same batch is read, and what was left out is told.
#include "thermfit/io/csv/preamble.hpp"

#include "support/catch.hpp"
#include "support/read_text.hpp"
#include "support/scratch_folder.hpp"
#include "thermfit/io/csv/reader.hpp"

using namespace thermfit;

namespace {

std::string refusal(const std::string& text, const CsvOptions& options = {}) {
  const ScratchFolder folder;
  try {
    read_campaign({folder.write("a.csv", text)}, options);
  } catch (const Error& error) {
    return folder.without_folder(error.what());
  }
  return "read without complaint";
}

const std::string names = "time_s,T1,T2,Z\n", rows = "0,20.5,21.5,0.5\n60,21.5,22,1\n120,22.5,22.5,1.5\n180,23,23,2\n";

std::string with_separator(std::string text, char separator) {
  for (char& c : text) c = c == ',' ? separator : c;
  return text;
}

}  // namespace

TEST_CASE("names are found below what was written before them, with any separator, and their line is told", "[io]") {
  const Batch plain = read_text(names + rows).batches.front();
  for (const std::string before :
       {"Warm-up test, machine 7\n", "Warm-up\nOperator: x\n\n",
        "Name:,Setup 1\nChannel,Name,Range\n101,Front,C\n102,Rear,C\n\n", "Date: 04.05.2026 08:00:00\nChannels: 4\n",
        "\"Title, with quotes\"\n", "Type K thermocouples (2), probe; PLC\n1\n2\n"})
    for (const char separator : {',', ';', '\t'}) {
      const CsvReading reading = read_text(before + with_separator(names + rows, separator));
      INFO(before << separator);
      CHECK(reading.batches.front().temperatures.values == plain.temperatures.values);
      CHECK(reading.batches.front().errors.values == plain.errors.values);
      CHECK(reading.batches.front().time_s == plain.time_s);
      const auto lines = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
      CHECK(reading.files.front().dialect.header_line == lines + 1);
      CsvOptions options;
      options.header_line = lines + 1;
      CHECK(read_text(before + with_separator(names + rows, separator), options).batches.front().digest ==
            plain.digest);
    }
  for (const char* first : {"sep=;\n", "SEP=;\r\n", "\"sep=;\"\n"})
    CHECK(read_text(first + with_separator(names + rows, ';')).batches.front().digest == plain.digest);
}

TEST_CASE("a header line that is not there is an error", "[io]") {
  CsvOptions options;
  options.header_line = 9;
  CHECK(refusal(names + rows, options) ==
        "a.csv: CsvOptions::header_line = 9 is empty, a comment, or not among the first lines; allowed: the number of "
        "the line that holds the names, from 1");
}

TEST_CASE("units stand below the names, above them, or with a third line of words", "[io]") {
  const Batch plain = read_text("time_min,T1,T2,Z [mm]\n" + rows).batches.front();
  for (const char* header :
       {"time,T1,T2,Z\nmin,°C,°C,mm\n", "min,degC,degC,mm\ntime,T1,T2,Z\n",
        "time,T1,T2,Z\nmin,°C,°C,mm\nch0,ch1,ch2,ch3\n", "time,T1,T2,Z\n[MIN],[DegC],[DegC],[MM]\n"}) {
    INFO(header);
    const Batch batch = read_text(header + rows).batches.front();
    CHECK(batch.time_s == plain.time_s);
    CHECK(batch.temperatures.values == plain.temperatures.values);
    CHECK(batch.errors.values == plain.errors.values);
  }
}

TEST_CASE("sums at the end, a word that ends a file and the names again are no rows, and are counted", "[io]") {
  const Batch plain = read_text(names + rows).batches.front();
  const std::size_t middle = rows.find('\n') + 1;
  for (const auto& [text, count] : std::vector<std::pair<std::string, std::size_t>>{
           {names + rows + "EOF\n", 1},
           {names + rows + "\nMax,28,24,30\nMin,20,21,0\nMean:,25,23,18\n", 3},
           {names + rows.substr(0, middle) + names + rows.substr(middle), 1},
           {names + rows.substr(0, middle) + "overrun\n" + rows.substr(middle), 1}}) {
    const CsvReading reading = read_text(text);
    INFO(text);
    CHECK(reading.batches.front().digest == plain.digest);
    CHECK(reading.files.front().left_out_lines == count);
    CHECK(reading.notes({}).size() == 1);
  }
  CHECK(refusal(names + rows + "240,oops,23,2\n").find("a.csv:6:5: T1 is 'oops'") == 0);
  CHECK(refusal(names + rows + "later,20,23,2\n").find("a.csv:6:1: time_s is 'later'") == 0);
}

TEST_CASE("what instruments write without a reading is a missing value, as are marks that the user names", "[io]") {
  for (const char* mark : {"OL", "---", "-", "#NV", "#N/A", "Overflow", "+OVER", "Burnout", "*", "?", "Open TC",
                           "1.#QNAN", "ERR7", "-999.9"}) {
    const std::string text =
        "time_s,T1,T2,Z\n0,20,20,0\n60,21,20.5,1\n120,22," + std::string(mark) + ",2\n180,23,21,3\n";
    INFO(mark);
    CsvOptions options;
    options.missing_marks = {"ERR7", "-999.9"};
    CHECK(refusal(text, options).find("a.csv:4:8 (T2): a value is missing") == 0);
    options.missing = MissingValues::drop;
    CHECK(read_text(text, options).batches.front().rows() == 3);
  }
}
