#include <functional>

#include "support/catch.hpp"
#include "support/scratch_folder.hpp"
#include "thermfit/io/csv/reader.hpp"

using namespace thermfit;

namespace {

struct Case {
  std::string what, text, message;
  std::function<void(CsvOptions&)> options = {};
};

std::string message_of(const std::string& text, const std::function<void(CsvOptions&)>& change) {
  const ScratchFolder folder;
  CsvOptions options;
  if (change) change(options);
  try {
    read_campaign({folder.write("a.csv", text)}, options);
  } catch (const Error& error) {
    return folder.without_folder(error.what());
  }
  return "read without complaint";
}

using namespace std::string_literals;
const std::string cell = "correct the cell, or leave it empty if there was no reading";
const std::string number = "allowed: a number such as 20.1; ";
const std::string say_which = "CsvOptions::separator = comma, semicolon or tab";

const std::vector<Case> cases{
    // What is no table of text at all.
    {"an empty file", "", "a.csv: has no line with content; allowed: a header line and rows of numbers"},
    {"comments only", "# one\n\n", "a.csv: has no line with content; allowed: a header line and rows of numbers"},
    {"a header only", "time_min,T1,Z\n", "a.csv: has no rows; allowed: at least one row of numbers"},
    {"a workbook", "PK\x03\x04 and so on",
     "a.csv: is an Excel workbook or a zip archive; allowed: text in UTF-8; save the sheet as CSV"},
    {"an old workbook", "\xD0\xCF\x11\xE0",
     "a.csv: is an old Excel workbook; allowed: text in UTF-8; save the sheet as CSV"},
    {"a NUL byte", "time_min,T1,Z\n0,20\0.1,0\n"s,
     "a.csv:2:5: a NUL byte; allowed: text in UTF-8; a logger that lost power may leave such bytes: cut them out; a "
     "binary file is not read"},
    {"lone carriage returns", "time_min,T1\r0,20\r",
     "a.csv:1:12: lines that end in a lone carriage return; allowed: line feed, or carriage return and line feed; "
     "convert: tr '\\r' '\\n' <FILE"},
    {"a line without end", "time_min,T1\n0," + std::string(200, '1') + "\n",
     "a.csv:2: a line longer than 100 bytes; allowed: lines of a table; is this the right file?",
     [](CsvOptions& options) { options.max_line_bytes = 100; }},
    {"too many columns", "time_min,T1,T2,T3\n0,1,2,3\n",
     "a.csv:1: 4 columns; allowed: at most 3; is this the right file, and the right CsvOptions::separator?",
     [](CsvOptions& options) { options.max_columns = 3; }},
    {"names in Latin-1",
     "time_min,T1 [\xB0"
     "C]\n0,20\n",
     "a.csv:1: names that are not UTF-8; allowed: text in UTF-8; say CsvOptions::encoding = NAME: latin1 or cp1252 in "
     "western Europe, gb18030 in China, shift_jis in Japan"},

    // The header line.
    {"no header", "0,20,1\n1,21,2\n",
     "a.csv:1: numbers where the names of the columns should be; allowed: a header line; add one, or name the columns: "
     "CsvOptions::columns = NAME,NAME,…"},
    {"clocks of channels that do not overlap", "time,T1,time,T2\n0,20,1,20\n",
     "a.csv: has no time at which all channels are there; allowed: clocks that overlap; leave channels out, or say "
     "CsvOptions::time_column"},
    {"a value beside a clock without a time", "time_s,T1,time_s,T2\n0,20,0,20\n60,21,,20\n",
     "a.csv:3: time_s.2 is missing beside a value; allowed: a time for each value"},
    {"a clock of a channel that goes back", "time_s,T1,time_s,T2\n0,20,60,20\n60,21,0,20\n120,21,120,22\n",
     "a.csv:3: time_s.2 stands still or goes back; allowed: time that increases from row to row"},
    {"a channel left of all clocks", "T1,Time1,T2,Time2,Z\n20,0,20,0,1\n21,60,20,60,2\n",
     "a.csv:1:1: T1 has no clock left of it; allowed: a clock left of each column; say CsvOptions::time_column = NAME "
     "for one clock",
     [](CsvOptions& options) { options.time_column = "Time*"; }},
    {"names that begin no line", "time_s,T1\n0,20\n",
     "a.csv: no line begins with 'Scan'; allowed: a line of names that does (CsvOptions::header_line, "
     "CsvOptions::dialect = benchlink)",
     [](CsvOptions& options) { options.dialect = "benchlink"; }},
    {"a dialect that nobody knows", "time_s,T1\n0,20\n",
     "CsvOptions::dialect: there is no 'excel'; allowed: twincat, lvm, catman, benchlink, picolog, halsampler, none",
     [](CsvOptions& options) { options.dialect = "excel"; }},
    {"a bad cell of a long table", "time_s;variable;value\n0;T1;20\n0;Z;1\n60;T1;warm\n60;Z;2\n",
     "a.csv:4:7: T1 is 'warm'; " + number + "correct the cell, or leave it empty if there was no reading"},
    {"a short line of a long table", "time_s;variable;value\n0;T1;20\n0;Z\n",
     "a.csv:3: 2 fields under 3 names; allowed: a field for each name"},
    {"two units of a name in a long table", "time_s;name;value;unit\n0;T1;20;degC\n60;T1;70;degF\n",
     "a.csv:3:10: T1 in degF, before in degC; allowed: one unit for a name"},
    {"columns of a long table that are not there", "time_s;a;b\n0;T1;20\n",
     "a.csv: the columns of CsvOptions::long_table are not there; allowed: the column of the names and the column of "
     "the "
     "values",
     [](CsvOptions& options) {
       options.long_table = {"a", "c"};
     }},
    {"columns to be skipped that are not there", "time_s,T1,Z\n0,20,1\n",
     "a.csv: no column 'Alarm' (CsvOptions::skip_columns); allowed: time_s, T1, Z",
     [](CsvOptions& options) { options.skip_columns = {"Alarm"}; }},
    {"a quote open in the header", "time_min,\"T1\n0,20\n",
     "a.csv:1:10: a quote that is opened here and never closed; close the field on its line; a quote inside a field is "
     "written \"\""},
    {"another separator", "time_min|T1|Z\n0|20|1\n",
     "a.csv: no temperature point; allowed: T1, T2, … or the names given by CsvOptions::temperatures; one column only: "
     "is the "
     "separator another? CsvOptions::separator says which"},
    {"no temperature", "time_min,Temp,Z,note\n0,20,1,a\n",
     "a.csv: no temperature point; allowed: T1, T2, … or the names given by CsvOptions::temperatures; columns there "
     "are: Temp, "
     "note"},

    // The dialect.
    {"two possible separators", "a;b,c\nx;y,z\n",
     "a.csv:1: may be separated by comma or by semicolon; allowed: " + say_which + "; say which"},
    {"a header of another separator", "time_min,T1,Z\n0;20,1;0,5\n1;20,4;1,5\n",
     "a.csv:1: the first line is separated by comma, the rows by semicolon; allowed: one separator in the whole file; "
     "mend the first line, or say " +
         say_which},
    {"one name over several fields", "T1\n0;20,5\n1;21,5\n",
     "a.csv:1: one name, but the rows have several fields; allowed: a name for each column; mend the first line, or "
     "say " +
         say_which},
    {"two decimal marks", "time_min;T1;Z\n0;20.5;1,5\n",
     "a.csv:2:8: '1,5' has a comma, and '20.5' (a.csv:2:3) has a point; allowed: one decimal mark in a file; say "
     "CsvOptions::decimal_mark = comma or CsvOptions::decimal_mark = point"},
    {"decimal comma in quotes between commas", "time_min,T1\n0,\"20,5\"\n",
     "a.csv:2:3: '20,5' in a comma-separated file may be a decimal number or grouped thousands; say "
     "CsvOptions::decimal_mark = comma if "
     "it "
     "is a decimal number"},
    {"commas that may group thousands", "time_min\trpm\tT1\n0\t1,234\t20\n",
     "a.csv:2:3: '1,234' may be a decimal number or grouped thousands, as all its like here; say "
     "CsvOptions::decimal_mark = comma if it "
     "is "
     "a decimal number, or CsvOptions::thousands = comma if '1,234' is a whole number"},

    {"one name over text", "T1\nx;y,z\n",
     "a.csv:2:5: 2 fields under 1 name: 'z' is too many; allowed: a field for each name; if the comma is the decimal "
     "mark "
     "too, save with semicolons; put text with commas in quotes"},

    // Roles and units.
    {"a clock in an unknown unit", "time [fortnight],T1\n0,20\n",
     "a.csv:1:1: time is in 'fortnight'; allowed: us, ms, s, min, h, d; write one of these behind the name, or say "
     "CsvOptions::units = time=s"},
    {"an unknown unit", "time_min,T1 [degX]\n0,20\n",
     "a.csv:1:10: T1 is in 'degX'; allowed: degC, °C, C, degF, °F, F, K; write one of these behind the name, or say "
     "CsvOptions::units = T1=degC"},
    {"a unit of another quantity", "time_min,T1,Z (degC)\n0,20,1\n",
     "a.csv:1:13: Z is in 'degC', a unit of another quantity; allowed: um, µm, nm, mm, cm, m, in, mil, microinch, or "
     "with "
     "a factor as in 0.1 um; write one of these behind the name, or say CsvOptions::units = Z=um"},
    {"a unit for a column that is not there", "time_min,T1,Z\n0,20,1\n",
     "a.csv: no column 'Zz' (CsvOptions::units); did you mean Z?; allowed: time_min, T1, Z",
     [](CsvOptions& options) {
       options.units = {{"Zz", "mm"}};
     }},
    {"a unit for an input", "time_min,T1,rpm\n0,20,1\n",
     "a.csv: 'rpm' (CsvOptions::units) is no temperature, no thermal error and no clock; allowed: units of those; an "
     "input is left as written; a role is given by CsvOptions::temperatures or CsvOptions::errors",
     [](CsvOptions& options) {
       options.units = {{"rpm", "mm"}};
     }},
    {"a unit of another quantity by option", "time_min,T1,Z\n0,20,1\n",
     "a.csv:1:13: Z is in 'degF', a unit of another quantity; allowed: um, µm, nm, mm, cm, m, in, mil, microinch, or "
     "with a factor as in 0.1 um; write one of these behind the name, or say CsvOptions::units = Z=um",
     [](CsvOptions& options) {
       options.units = {{"Z", "degF"}};
     }},
    {"two units for one column", "time_min,T1 [degC],Z\nmin,degF,um\n0,20,1\n",
     "a.csv:2:5: unit degF below a name that says degC; allowed: one unit for a column"},
    {"a clock of two units", "time_s,T1\n0,20\n",
     "a.csv:1:1: time_s says s, CsvOptions::time_unit says min; allowed: one unit for a column",
     [](CsvOptions& options) { options.time_unit = "min"; }},
    {"two clocks", "time_min,Time,T1\n0,0,20\n",
     "a.csv:1:10: Time may be the time, and so may time_min; allowed: one clock, or one left of the columns it is for; "
     "say "
     "CsvOptions::time_column = time_min, or a glob that finds the clocks, each left of its columns"},
    {"a column that is not there", "time_min,Temp1,Z\n0,20,1\n",
     "a.csv: no column 'Tmp1' (CsvOptions::temperatures); did you mean Temp1?; allowed: time_min, Temp1, Z",
     [](CsvOptions& options) { options.temperatures = {"Tmp1"}; }},
    {"a glob that nothing is like", "time_min,T1\n0,20\n",
     "a.csv: no column of numbers is like 'PT*' (CsvOptions::temperatures); allowed: time_min, T1",
     [](CsvOptions& options) { options.temperatures = {"PT*"}; }},
    {"two roles for a column", "time_min,T1,Z\n0,20,1\n",
     "a.csv:1:10: T1 is to be a thermal error and a temperature; allowed: one role for a column",
     [](CsvOptions& options) {
       options.temperatures = {"T1"};
       options.errors = {"T1"};
     }},

    // Rows.
    {"a short row", "time_min,T1,Z\n0,20,1\n1,21\n",
     "a.csv:3: 2 fields under 3 names: Z is not there; allowed: a field for each name; complete the row, or delete it"},
    {"a row that is much too short", "time_min,T1,Z\n0,20,1\n1\n",
     "a.csv:3: 1 field under 3 names: T1 and what follows are not there; allowed: a field for each name; complete the "
     "row, "
     "or delete it"},
    {"a long row", "time_min,T1\n0,20\n1,21,7\n",
     "a.csv:3:6: 3 fields under 2 names: '7' is too many; allowed: a field for each name; if the comma is the decimal "
     "mark "
     "too, save with semicolons; put text with commas in quotes"},
    {"a long row between semicolons", "time_min;T1\n0;20\n1;21;7\n",
     "a.csv:3:6: 3 fields under 2 names: '7' is too many; allowed: a field for each name; delete the surplus, or name "
     "the "
     "column"},
    {"decimal comma between commas", "time_min,T1\n0,0,20,1\n1,0,20,4\n",
     "a.csv:2:5: in every row 4 fields under 2 names: '20' is too many; allowed: a field for each name; if the comma "
     "is the "
     "decimal mark too, save with semicolons; put text with commas in quotes"},
    {"rows that end in a separator", "time_min,T1\n0,20,\n1,21,\n",
     "a.csv:2:6: in every row 3 fields under 2 names: the row ends in a comma; allowed: a field for each name; end the "
     "first line in a comma too, or no row"},
    {"something in a last column without name",
     "time_min,T1,\n0,20,\n#" + std::string(70000, '.') + "\n# more\n1,21,5\n",
     "a.csv:5:6: '5' in a column without a name; give the last column a name"},
    {"a row without the last separator of the others", "time_min;T1;Z;\n0;20;\n1;20;1;\n",
     "a.csv:2: 3 fields under 4 names: the last, without name, is not there; allowed: a field for each name; complete "
     "the "
     "row, or delete it"},
    {"a quote never closed", "time_min,T1\n0,\"20\n",
     "a.csv:2:3: a quote that is opened here and never closed; close the field on its line; a quote inside a field is "
     "written \"\""},
    {"text behind a quote", "time_min,T1\n0,\"20\"1\n",
     "a.csv:2:7: text behind a closing quote; write a quote inside a field as \"\""},
    {"a quote inside a field", "time_min,T1\n0,2\"0\n",
     "a.csv:2:4: a quote inside a field; put the whole field in quotes and double the quote inside"},
    {"time standing still", "time_min,T1\n0,20\n0,21\n",
     "a.csv:3: time_min stands still at 0 s; allowed: time that increases from row to row; say "
     "CsvOptions::time_step_s = SECONDS if rows are evenly apart; else split runs with CsvOptions::batch_column or "
     "into "
     "files, or leave time out: CsvOptions::time_column = none"},
    {"time going back", "time_min,T1\n5,20\n0,21\n",
     "a.csv:3: time_min goes back to 0 s from 300 s; allowed: time that increases from row to row; split runs with "
     "CsvOptions::batch_column or into files, or leave time out: CsvOptions::time_column = none"},
    {"a row without batch", "time_min,T1,run\n0,20,a\n1,21,\n",
     "a.csv:3: run is empty; allowed: the name of a batch in every row",
     [](CsvOptions& options) { options.batch_column = "run"; }},

    // Cells.
    {"text", "time_min,T1\n0,abc\n", "a.csv:2:3: T1 is 'abc'; " + number + cell},
    {"a control character", "time_min,T1\n0,2\x01\n", "a.csv:2:3: T1 is '2\\x01'; " + number + cell},
    {"a long text", "time_min,T1\n0," + std::string(50, 'x') + "\n",
     "a.csv:2:3: T1 is '" + std::string(40, 'x') + "…'; " + number + cell},
    {"a hexadecimal number", "time_min,T1\n0,0x1p3\n",
     "a.csv:2:3: T1 is '0x1p3', hexadecimal; " + number + "write it in decimal"},
    {"an underscore", "time_min,T1\n0,1_0\n", "a.csv:2:3: T1 is '1_0'; " + number + cell},
    {"an exponent without digits", "time_min,T1\n0,1e\n", "a.csv:2:3: T1 is '1e'; " + number + cell},
    {"two signs", "time_min,T1\n0,+-1\n", "a.csv:2:3: T1 is '+-1'; " + number + cell},
    {"a number beyond doubles", "time_min,T1\n0,1e400\n",
     "a.csv:2:3: T1 is '1e400', beyond what a double holds; " + number + "correct the value"},
    {"infinity", "time_min,T1\n0,-Infinity\n",
     "a.csv:2:3: T1 is '-Infinity', an infinite value; " + number + "leave the cell empty if there was no reading"},
    {"thousands that the start of the file does not show", "time_min,T1\n0,20.5\n1,1'234.5\n",
     "a.csv:3:3: T1 is '1'234.5', with thousands separators; " + number +
         "write it without them, or say CsvOptions::thousands = comma, point, space or apostrophe",
     [](CsvOptions& options) { options.thousands = ','; }},
    {"one mark twice", "time_min;T1\n0;1,5\n",
     "a.csv: CsvOptions::thousands and CsvOptions::decimal_mark are the same mark; allowed: two marks",
     [](CsvOptions& options) { options.thousands = options.decimal_mark = ','; }},
    {"a point among decimal commas", "time_min;T1\n0;20.5\n",
     "a.csv:2:3: T1 is '20.5', a decimal point in a file with decimal comma; allowed: a number such as 20,1; use one "
     "decimal mark, or say CsvOptions::decimal_mark = comma or CsvOptions::decimal_mark = point",
     [](CsvOptions& options) { options.decimal_mark = ','; }},
    {"a comma among decimal points", "time_min;T1\n0;20,5\n",
     "a.csv:2:3: T1 is '20,5', a decimal comma in a file with decimal point; allowed: a number such as 20.1; use one "
     "decimal mark, or say CsvOptions::decimal_mark = comma or CsvOptions::decimal_mark = point",
     [](CsvOptions& options) { options.decimal_mark = '.'; }},
    {"a date-time where a number should be", "time_min,T1\n0,2024-05-31T08:00:00\n1,3\n",
     "a.csv:2:3: T1 is '2024-05-31T08:00:00', a date-time; " + number +
         "name the clock: CsvOptions::time_column = NAME"},
    {"the wrong separator told", "time_min;T1,Z\n0;20,1\n",
     "a.csv:2:1: time_min;T1 is '0;20'; " + number +
         "is the file separated by something else? say CsvOptions::separator",
     [](CsvOptions& options) {
       options.separator = ',';
       options.temperatures = {"time_min;T1"};
     }},
    {"a unit behind some numbers only", "time_min,T1\n0,20\n1,20.5 °C\n",
     "a.csv:3:3: T1 is '20.5 °C', a number with its unit; " + number +
         "write the unit in brackets behind the name of the column"},
    {"two units behind numbers", "time_min,T1\n0,20 °C\n1,68.5 °F\n",
     "a.csv:3:3: T1 is '68.5 °F', in °F, the cells before in °C; " + number + "one unit for a column"},
    {"another unit behind the numbers than behind the name", "time_min,T1 [degF]\n0,20 °C\n",
     "a.csv:1:10: T1 is in degF, its cells in °C; allowed: one unit for a column"},
    {"more names than columns", "time_min,T1,Z\n0,20,1\n1,21,2\n",
     "a.csv:1: names 3 columns, CsvOptions::columns 2; allowed: a name for each of: time_min, T1, Z",
     [](CsvOptions& options) {
       options.columns = {"time_min", "T1"};
     }},
    {"a date-time that is none", "stamp,T1\n2024-05-31T08:00:00,20\n2024-05-32T08:00:00,21\n",
     "a.csv:3:1: stamp is '2024-05-32T08:00:00'; allowed: an ISO 8601 date-time such as 2024-05-31T08:00:00, with a "
     "zone "
     "in all rows or in none"},
    {"a zone in one row only", "stamp,T1\n2024-05-31T08:00:00Z,20\n2024-05-31T08:05:00,21\n",
     "a.csv:3:1: stamp is '2024-05-31T08:05:00'; allowed: an ISO 8601 date-time such as 2024-05-31T08:00:00, with a "
     "zone "
     "in all rows or in none"},

    // Missing values.
    {"one missing value", "time_min,T1\n0,20\n1,\n",
     "a.csv:3:3 (T1): a value is missing; allowed: a number in every cell; CsvOptions::missing = drop leaves such rows "
     "out, "
     "CsvOptions::missing = hold repeats the last value"},
    {"missing values", "time_min,T1,T2\n0,20,NA\n1,nan,21\n2,20,NULL\n3,20,n/a\n",
     "a.csv:2:6 (T2): 4 values are missing, this is the first; allowed: a number in every cell; CsvOptions::missing = "
     "drop leaves "
     "such "
     "rows out, CsvOptions::missing = hold repeats the last value"},
    {"nothing to hold", "time_min,T1\n0,NA\n1,20\n",
     "a.csv:2:3: T1 is missing, and there is no value before it to hold; allowed: CsvOptions::missing = drop",
     [](CsvOptions& options) { options.missing = MissingValues::hold; }},
    {"no time to hold", "time_min,T1\n0,20\n,21\n",
     "a.csv:3:1: time_min is missing, and time cannot be held; allowed: CsvOptions::missing = drop",
     [](CsvOptions& options) { options.missing = MissingValues::hold; }},
    {"nothing left after dropping", "time_min,T1,T2\n0,NA,1\n1,20,NA\n",
     "a.csv: has no row without a missing value; allowed: at least one",
     [](CsvOptions& options) { options.missing = MissingValues::drop; }},
};

}  // namespace

TEST_CASE("each mistake in a CSV file is told with its place, what is allowed and what to do", "[io]") {
  for (const Case& one : cases) {
    INFO(one.what);
    CHECK(message_of(one.text, one.options) == one.message);
  }
}

TEST_CASE("all problems of all files are told in one pass, up to the limit", "[io]") {
  const ScratchFolder folder;
  const std::vector<std::string> paths{folder.write("a.csv", "time_min,T1\n0,x\n1,y\n"), folder.write("b.csv", ""),
                                       folder.write("c.csv", "time_min,T1\n0,20\n0,z\n")};
  CsvOptions options;
  const auto lines = [&] {
    try {
      read_campaign(paths, options);
    } catch (const Errors& errors) {
      const std::string text = folder.without_folder(errors.what());
      return std::pair(errors.problems().size(), text);
    }
    return std::pair(std::size_t{0}, std::string());
  };
  const auto [count, text] = lines();
  CHECK(count == 4);
  CHECK(text.find("a.csv:2:3: T1 is 'x'") == 0);
  CHECK(text.find("\nb.csv: has no line") != std::string::npos);
  CHECK(text.find("\nc.csv:3:3: T1 is 'z'") != std::string::npos);
  options.max_errors = 2;
  CHECK(lines().first == 2);
  CHECK(lines().second.find("\nstopped after 2 errors; CsvOptions::max_errors = N shows more") != std::string::npos);
}

TEST_CASE("batches that do not agree in their channels are refused with the names", "[io]") {
  const ScratchFolder folder;
  const std::string first = folder.write("a.csv", "T1,T2,Z\n20,21,1\n");
  const auto message = [&](const std::string& text, const std::string& path = "b.csv") {
    try {
      read_campaign({first, folder.write(path, text)});
    } catch (const Error& error) {
      return folder.without_folder(error.what());
    }
    return std::string("read");
  };
  CHECK(
      message("T1,Z\n20,1\n") ==
      "b.csv: lacks temperature points T2 of a.csv; allowed: the same in every batch: T1, T2; choose common ones with "
      "CsvOptions::temperatures");
  CHECK(
      message("T1,T2,T3,Z\n20,1,2,3\n") ==
      "b.csv: has temperature points T3 beyond those of a.csv; allowed: the same in every batch: T1, T2; choose common "
      "ones with CsvOptions::temperatures");
  CHECK(message("T1,T2,X\n20,1,2\n") ==
        "b.csv: lacks errors Z of a.csv; allowed: the same in every batch: Z; choose common ones with "
        "CsvOptions::errors");
  CHECK(message("T1,T2,Z\n20,21,1\n", "a.csv") == "a.csv: is given twice; allowed: each file once");
}
