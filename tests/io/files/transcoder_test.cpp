#include "thermfit/io/files/transcoder.hpp"

// The same campaign in other encodings, with blanks between its numbers, and with names that are missing or repeated.
#include <iconv.h>

#include "support/catch.hpp"
#include "support/read_text.hpp"
#include "thermfit/io/csv/reader.hpp"

using namespace thermfit;

namespace {

using Names = std::vector<std::string>;

std::string encoded(std::string text, const char* encoding) {
  const iconv_t state = ::iconv_open(encoding, "UTF-8");
  REQUIRE(state != reinterpret_cast<iconv_t>(-1));
  std::string result(4 * text.size() + 8, '\0');
  char *from = text.data(), *to = result.data();
  std::size_t left = text.size(), room = result.size();
  REQUIRE(::iconv(state, &from, &left, &to, &room) != static_cast<std::size_t>(-1));
  ::iconv_close(state);
  return result.substr(0, result.size() - room);
}

std::string made(std::size_t rows, const std::string& header) {
  std::string text = header;
  for (std::size_t row = 0; row < rows; ++row) {
    const double t = static_cast<double>(row);
    text += exact_text(60 * t) + ',' + exact_text(20 + 0.25 * t) + ',' + exact_text(21 - 0.125 * t) + ',' +
            exact_text(t / 7) + '\n';
  }
  return text;
}

}  // namespace

TEST_CASE("a campaign is the same in every encoding, also where it is longer than a block", "[io]") {
  const std::string european = "Zeit [s],Lager °C,Gehäuse °C,Größe [µm]\n", chinese = "时间[s],温度1,温度2,位移Z\n";
  for (const std::size_t rows : {std::size_t{3}, std::size_t{20000}})
    for (const auto& [encoding, header] :
         std::vector<std::pair<const char*, std::string>>{{"UTF-16", european},
                                                          {"UTF-16", chinese},
                                                          {"LATIN1", european},
                                                          {"CP1252", european},
                                                          {"GB18030", chinese},
                                                          {"UTF-16LE", european},
                                                          {"SHIFT_JIS", "時間[s],温度1,温度2,変位Z\n"}}) {
      CsvOptions options;
      const bool other = header != european;
      options.temperatures = other ? Names{"温度1", "温度2"} : Names{"Lager", "Gehäuse"};
      options.errors = {header == european ? "Größe" : header == chinese ? "位移Z" : "変位Z"};
      options.time_column = header.substr(0, header.find('['));
      while (options.time_column.back() == ' ') options.time_column.pop_back();
      const std::string text = made(rows, header);
      const Batch plain = read_text(text, options).batches.front();
      INFO(encoding << ", " << rows);
      if (std::string(encoding) != "UTF-16") options.encoding = encoding;
      const Batch batch = read_text(encoded(text, encoding), options).batches.front();
      CHECK(batch.digest == plain.digest);
      CHECK(batch.temperatures.names == plain.temperatures.names);
    }
}

TEST_CASE("an encoding that is not known, not said, or not the file's is an error that says what to write", "[io]") {
  CsvOptions options;
  options.encoding = "klingon";
  CHECK_THROWS_WITH(read_text("T1\n20\n", options), Catch::Contains("no encoding is called 'klingon'"));
  CHECK_THROWS_WITH(read_text("Zeit [s],T1 [\xB0"
                              "C]\n0,20\n"),
                    Catch::Contains("CsvOptions::encoding = NAME"));
  CHECK_THROWS_WITH(read_text("time,T1\ns,\xB0"
                              "C\n0,20\n1,21\n"),
                    Catch::Contains("CsvOptions::encoding = NAME"));
  options.encoding = "gb18030";
  CHECK_THROWS_WITH(read_text("time_s,T1\xFF\n0,20\n", options), Catch::Contains("no text in gb18030"));
}

TEST_CASE("blanks separate where nothing else does, any number of them, told; lost samples are left out", "[io]") {
  const Batch plain = read_text("time_s,T1,T2,Z\n0,20,21,-0.5\n60,20.5,21.25,1\n120,21,21.5,2\n").batches.front();
  CHECK(read_text("time_s T1 T2 Z\n0 20 21 -0.5\n60 20.5 21.25 1\n120 21 21.5 2\n").batches.front().digest ==
        plain.digest);
  const CsvReading aligned = read_text(
      "  time_s     T1     T2      Z\n       0  20.00  21.00  -0.50 \n      60  20.50  21.25   1.00\n     120  21.00  "
      "21.50   2.00\n");
  CHECK(aligned.batches.front().digest == plain.digest);
  CHECK(aligned.files.front().dialect.separator == ' ');
  CsvOptions options;
  options.columns = {"time_s", "T1", "T2", "Z"};
  CHECK(read_text("0 20 21 -0.5 \n60 20.5 21.25 1 \noverrun\n120 21 21.5 2 \n", options).batches.front().digest ==
        plain.digest);
  options.separator = ' ';
  CHECK(read_text("0 20 21 -0.5\n60 20.5 21.25 1\n120 21 21.5 2\n", options).batches.front().digest == plain.digest);
  CHECK_THROWS_AS(read_text("0 20 21\n60 20.5 21.25 1\n", options), Error);
}

TEST_CASE("columns without a name or with another's get one, told", "[io]") {
  const CsvReading reading = read_text(",time_s,Temp,Temp,Z,,\n0,0,20,21,1,,\n1,60,21,22,2,,\n", [] {
    CsvOptions options;
    options.temperatures = {"Temp", "Temp.2"};
    return options;
  }());
  CHECK(reading.batches.front().temperatures.names == Names{"Temp", "Temp.2"});
  CHECK(reading.batches.front().inputs.names.empty());  // nobody knows what a column without a name is
  CHECK(reading.files.front().roles.nameless == Names{"column1"});
  CHECK(reading.files.front().roles.made_up == Names{"column1 (no name)", "Temp.2 (Temp again)", "column6 (no name)"});
}

TEST_CASE("the minus of typesetters is a minus", "[io]") {
  CHECK(read_text("time_s,T1,Z\n0,20,\xE2\x88\x92"
                  "0.25\n")
            .batches.front()
            .errors.values(0, 0) == -0.25);
  CHECK(read_text("time_s;T1;Z\n0;20,5;\xE2\x88\x92"
                  "0,25\n")
            .batches.front()
            .errors.values(0, 0) == -0.25);
  CHECK_THROWS_AS(read_text("time_s,T1,Z\n0,20,\xE2\x88\x92-1\n"), Error);
}
