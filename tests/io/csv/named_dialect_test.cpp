// Files as loggers and programs write them, with numbers made here: each dialect reads the same batch, by its name and,
// where the file is one for sure, without it; and what is set wins over the dialect.
#include "thermfit/io/csv/named_dialect.hpp"

#include "support/catch.hpp"
#include "support/read_text.hpp"

using namespace thermfit;

namespace {

/// Rows `0,20.5,21.25,-0.5` each minute, with one text before and between and behind the values of a row.
struct Row {
  double minute, front, rear, probe;
};
const std::vector<Row> course{{0, 20.5, 21.25, -0.5}, {1, 21.5, 21.5, 1.25}, {2, 22.25, 21.75, 2.5}, {3, 23, 22, 3.75}};

std::string rows(const std::string& form, char mark, double time_factor, const std::string& end = "\r\n") {
  std::string text;
  for (const Row& row : course) {
    std::string line = form;
    const auto put = [&](const std::string& what, const std::string& number) {
      for (std::size_t at = 0; (at = line.find(what)) != std::string::npos;) line.replace(at, what.size(), number);
    };
    const auto number = [&](double value) {
      std::string written = fixed_text(value, 3);
      written.replace(written.find('.'), 1, 1, mark);
      return written;
    };
    put("{time}", number(time_factor * row.minute));
    put("{minute}", "0" + fixed_text(row.minute, 0));
    put("{n}", fixed_text(row.minute + 1, 0));
    put("{T1}", number(row.front));
    put("{T2}", number(row.rear));
    put("{Z}", number(row.probe));
    text += line + end;
  }
  return text;
}

struct Example {
  std::string name, text;
  std::vector<std::string> temperatures, errors;
  bool is_told;  ///< the file itself tells what it is
};

std::vector<Example> examples() {
  const std::string scope =
      "Name\tYT Scope Project\nFile\tC:\\scopes\\warmup.tcscopex\nStarttime of export\t134223552000000000\tMonday, May "
      "4, "
      "2026\t08:00:00\nEndtime of export\t134223553800000000\tMonday, May 4, 2026\t08:03:00\n\n";
  const std::string channels =
      "Name\tT1\tName\tT2\tName\tZ\nSymbolComment\t\tSymbolComment\t\tSymbolComment\t\nData-Type\tREAL64\tData-Type\t"
      "REAL64\tData-Type\tREAL64\nSampleTime[ms]\t60000\tSampleTime[ms]\t60000\tSampleTime[ms]\t60000\n"
      "SymbolName\tMAIN.T1\tSymbolName\tMAIN.T2\tSymbolName\tMAIN.Z\nNetID\t5.1.2.3.1.1\tNetID\t5.1.2.3.1.1\tNetID\t"
      "5.1.2.3.1.1\nPort\t851\tPort\t851\tPort\t851\nOffset\t0\tOffset\t0\tOffset\t0\nScaleFactor\t1\tScaleFactor\t1\t"
      "ScaleFactor\t1\n\n";
  const std::string lvm =
      "LabVIEW Measurement\t\r\nWriter_Version\t2\r\nReader_Version\t2\r\nSeparator\tTab\r\nDecimal_Separator\t.\r\n"
      "Multi_Headings\tNo\r\nX_Columns\tMulti\r\nTime_Pref\tAbsolute\r\nOperator\tlab\r\nDate\t2026/05/04\r\nTime\t"
      "08:00:00.0000000\r\n***End_of_Header***\t\r\n\t\r\n";
  return {
      {"twincat",
       scope + channels + rows("{time}\t{T1}\t{time}\t{T2}\t{time}\t{Z}", '.', 60000) + "EOF\n",
       {},
       {},
       true},
      {"twincat",
       "Name\tT1\tName\tT2\tName\tZ\n" + rows("{time}\t{T1}\t{time}\t{T2}\t{time}\t{Z}", ',', 60000),
       {},
       {},
       true},
      {"lvm",
       lvm +
           "Channels\t3\t\t\t\t\t\r\nSamples\t4\t\t4\t\t4\t\r\nDate\t2026/05/04\t\t2026/05/04\t\t2026/05/04\t\r\nTime\t"
           "08:00:00\t\t08:00:00\t\t08:00:00\t\r\nY_Unit_Label\tdegC\t\tdegC\t\tum\t\r\nX_Dimension\tTime\t\tTime\t\t"
           "Time\t\r\nX0\t0.0E+0\t\t0.0E+0\t\t0.0E+0\t\r\nDelta_X\t60.0\t\t60.0\t\t60.0\t\r\n***End_of_Header***\t\t\t"
           "\t\t\t\r\nX_Value\tT1\tX_Value\tT2\tX_Value\tZ\tComment\r\n" +
           rows("{time}\t{T1}\t{time}\t{T2}\t{time}\t{Z}", '.', 60),
       {},
       {},
       true},
      {"lvm",
       "LabVIEW Measurement;\r\nSeparator;Other\r\nX_Columns;One\r\n***End_of_Header***;\r\n;\r\nChannels;3;;;\r\n"
       "Y_Unit_Label;degC;degC;um;\r\n***End_of_Header***;;;;\r\nX_Value;T1;T2;Z;Comment\r\n" +
           rows("{time};{T1};{T2};{Z};", ',', 60),
       {},
       {},
       true},
      {"catman",
       "HBM_CATMAN_DATAFILE_40\r\n\r\nExport: warm-up\r\nT0 = 04.05.2026 08:00:00\r\nKan\xE4le: 4\r\n\r\nZeit  1 - "
       "Standardmessrate\tLager vorn\tLager hinten\tVerlagerung Z\r\ns\t\xB0"
       "C\t\xB0"
       "C\t\xB5m\r\nSR: 1/60 Hz\tKanal 1\tKanal 2\tKanal 3\r\n" +
           rows("{time}\t{T1}\t{T2}\t{Z}", ',', 60),
       {"Lager vorn", "Lager hinten"},
       {"Verlagerung Z"},
       true},
      {"catman",
       "HBM_CATMAN_DATAFILE_40\r\n\r\nZeit  1 - langsam\tLager vorn\tLager hinten\tZeit  2 - schnell\tVerlagerung "
       "Z\r\ns\t"
       "\xB0"
       "C\t\xB0"
       "C\ts\t\xB5m\r\n" +
           rows("{time}\t{T1}\t{T2}\t{time}\t{Z}", ',', 60),
       {"Lager vorn", "Lager hinten"},
       {"Verlagerung Z"},
       true},
      {"benchlink",
       "Name:,Warm-up\r\nOwner:,lab\r\nComments:,\r\nAcquisition Date:,5/4/2026 7:59:59 "
       "AM\r\n\r\nInstrument:,DAQ970A\r\n"
       "Channel,Name,Function,Range,Resolution\r\n101,Front,Temp (Type K),C,0.1\r\n102,Rear,Temp (Type K),C,0.1\r\n"
       "103,Probe,DC volts,um,5.5\r\n\r\nScan Control:\r\nStart Action:,Immediately\r\nScan Interval:,60\r\nTotal "
       "Scans:,4\r\n\r\nScan,Time,101 <Front> (C),Alarm 101,102 <Rear> (C),Alarm 102,103 <Probe> (um),Alarm 103\r\n" +
           rows("{n},05/04/2026 08:{minute}:00:000,{T1},0,{T2},0,{Z},0", '.', 1),
       {"101*", "102*"},
       {"103*"},
       true},
      {"picolog",
       "\"\",\"Front Ave. (\xC2\xB0"
       "C)\",\"Rear Ave. (\xC2\xB0"
       "C)\",\"Probe Ave. (\xC2\xB5m)\"\n" +
           rows("\"2026-05-04T08:{minute}:00+02:00\",\"{T1}\",\"{T2}\",\"{Z}\"", '.', 1, "\n"),
       {"Front*", "Rear*"},
       {"Probe*"},
       true},
      {"picolog",
       ",Front Last (C),Rear Last (C),Probe Last (um)\n" + rows("{time},{T1},{T2},{Z}", '.', 60, "\n"),
       {"Front*", "Rear*"},
       {"Probe*"},
       true},
      {"halsampler", rows("{T1} {T2} {Z} ", '.', 1, "\n"), {}, {}, false},
      {"halsampler", "overrun\n" + rows("{n} {T1} {T2} {Z} ", '.', 1, "\n"), {}, {}, false},
  };
}

CsvOptions options_for(const Example& example) {
  CsvOptions options;
  options.temperatures = example.temperatures;
  options.errors = example.errors;
  if (example.name == "halsampler") {
    options.time_step_s = 60;
    options.columns = {"T1", "T2", "Z"};
    if (example.text.find("overrun") == 0) options.columns.insert(options.columns.begin(), "n");
  }
  return options;
}

void check_course(const Batch& batch) {
  REQUIRE(batch.rows() == static_cast<Index>(course.size()));
  for (Index row = 0; row < batch.rows(); ++row) {
    const Row& truth = course[static_cast<std::size_t>(row)];
    CHECK(batch.time_s(row) == Approx(60 * truth.minute).margin(1e-6));
    CHECK(batch.temperatures.values(row, 0) == truth.front);
    CHECK(batch.temperatures.values(row, 1) == truth.rear);
    CHECK(batch.errors.values(row, 0) == truth.probe);
  }
}

}  // namespace

TEST_CASE("a file of each named dialect is read, with its name or by what it is, and that is told", "[io]") {
  for (const Example& example : examples()) {
    INFO(example.name << '\n' << example.text);
    CsvOptions options = options_for(example);
    options.dialect = example.name;
    check_course(read_text(example.text, options).batches.front());
    CHECK(read_text(example.text, options).files.front().recognised.empty());
    if (!example.is_told) continue;
    const CsvReading reading = read_text(example.text, options_for(example));
    check_course(reading.batches.front());
    CHECK(reading.files.front().recognised.find("CsvOptions::dialect = none") != std::string::npos);
  }
  for (const NamedDialect& one : named_dialects) {
    const std::vector<Example> all = examples();
    CHECK(std::any_of(all.begin(), all.end(), [&](const Example& example) { return example.name == one.name; }));
  }
}

TEST_CASE("a dialect only sets what the options leave open, and none is recognised where that is said", "[io]") {
  const Example scope = examples()[1];
  CsvOptions options;
  options.time_unit = "s";
  CHECK(read_text(scope.text, options).batches.front().time_s(1) == 60000);
  options = {};
  options.dialect = "none";
  CHECK(read_text(scope.text, options).batches.front().inputs.names.size() == 3);
}

TEST_CASE("channels of a scope with other sampling times, one of which ends early, are put on one clock", "[io]") {
  std::string text = "Name\tT1\tName\tZ\n";
  for (int i = 0; i <= 12; ++i) {
    if (i <= 3) text += std::to_string(40000 * i) + '\t' + std::to_string(20 + 4 * i);
    text += (i <= 3 ? "\t" : "\t\t") + std::to_string(10000 * i) + '\t' + std::to_string(i) + '\n';
  }
  const Batch batch = read_text(text).batches.front();
  CHECK(batch.time_s == (Vector(4) << 0, 40, 80, 120).finished());
  CHECK(batch.errors.values == (Matrix(4, 1) << 0, 4, 8, 12).finished());
}

TEST_CASE("tables that only resemble a dialect are read as any other", "[io]") {
  for (const char* text : {"Name,T1,Z\n1,20,0\n2,21,1\n3,22,2\n", "Scan,T1,Z\n1,20,0\n2,21,1\n",
                           ",T1,Z\n0,20,1\n60,21,2\n", "X_Value\tT1\tZ\n0\t20\t0\n1\t21\t1\n"}) {
    const CsvReading reading = read_text(text);
    CHECK(reading.files.front().recognised.empty());
    CHECK(reading.batches.front().temperatures.count() + reading.batches.front().inputs.count() >= 1);
  }
}
