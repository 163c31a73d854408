#include "options/campaign_options.hpp"

#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "cli/table.hpp"
#include "options/field_flags.hpp"
#include "thermfit/findings/copy_findings.hpp"
#include "thermfit/io/csv/named_dialect.hpp"
#include "thermfit/io/files/file_identity.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/io/units.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

namespace fs = std::filesystem;

/// K2 before K10: runs of digits compare as numbers, everything else as bytes.
bool natural_less(const std::string& a, const std::string& b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const auto number = [&](const std::string& text, std::size_t& at) {
        std::size_t begin = at;
        while (at < text.size() && is_digit(text[at])) ++at;
        while (begin + 1 < at && text[begin] == '0') ++begin;
        return text.substr(begin, at - begin);
      };
      const std::string x = number(a, i), y = number(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else if (a[i] != b[j]) {
      return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
    } else {
      ++i, ++j;
    }
  }
  return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

/// Whether a name ends in one of `endings`, in any case.
bool ends_in(const std::string& name, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) {
    return name.size() > ending.size() &&
           std::equal(ending.rbegin(), ending.rend(), name.rbegin(), [](char wanted, char c) {
             return wanted == (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
           });
  });
}

/// The tables in a folder: its *.csv, or, where it has none, what loggers write under other names.
std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> files, others;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.front() == '.' || entry->is_directory(error)) continue;
    if (ends_in(name, {".csv", ".csv.gz"}))
      files.push_back(entry->path().string());
    else if (ends_in(name, {".txt", ".asc", ".lvm", ".dat", ".tsv"}))
      others.push_back(entry->path().string());
  }
  if (error) throw Error(folder, error.message(), "a folder that can be read");
  if (files.empty()) files = std::move(others);
  if (files.empty())
    throw Error(folder, "holds no *.csv or *.csv.gz, nor *.txt, *.asc, *.lvm, *.dat, *.tsv", "a folder with batches");
  std::sort(files.begin(), files.end(), natural_less);
  return files;
}

std::vector<std::string> files_like(const std::string& pattern) {
  glob_t found{};
  const int status = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found);
  std::vector<std::string> files;
  for (std::size_t i = 0; status == 0 && i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  if (files.empty()) throw Error(pattern, "no file is like this", "files, folders, quoted globs, or - for stdin");
  std::sort(files.begin(), files.end(), natural_less);
  return files;
}

std::string dialect(const Arguments& arguments) {
  std::vector<std::string> names{"auto"};
  for (const NamedDialect& one : named_dialects) names.emplace_back(one.name);
  names.emplace_back("none");
  const std::string name = arguments.choice("--dialect", names, "auto");
  return name == "auto" ? "" : name;
}

char separator(const Arguments& arguments) {
  const std::string given = arguments.value_or("--delimiter", "auto");
  if (given.size() == 1 && given.find_first_of(",;\t| ") == 0) return given.front();
  const std::string word =
      arguments.choice("--delimiter", {"auto", "comma", "semicolon", "tab", "bar", "space"}, "auto");
  return word == "comma"       ? ','
         : word == "semicolon" ? ';'
         : word == "tab"       ? '\t'
         : word == "bar"       ? '|'
         : word == "space"     ? ' '
                               : '\0';
}

char decimal_mark(const Arguments& arguments) {
  const std::string given = arguments.value_or("--decimal", "auto");
  if (given == "." || given == ",") return given.front();
  const std::string word = arguments.choice("--decimal", {"auto", "point", "comma"}, "auto");
  return word == "point" ? '.' : word == "comma" ? ',' : '\0';
}

char thousands(const Arguments& arguments) {
  const std::string word = arguments.choice("--thousands", {"auto", "comma", "point", "space", "apostrophe"}, "auto");
  return word == "comma" ? ',' : word == "point" ? '.' : word == "space" ? ' ' : word == "apostrophe" ? '\'' : '\0';
}

/// The name under which `option` is given for a side: of the simulator's output its own, where there is one.
std::string of_side(const Arguments& arguments, const std::string& option, CampaignSide side) {
  const std::string own = "--sim-" + option.substr(2);
  return side == CampaignSide::simulated && arguments.has(own) ? own : option;
}

/// A number of seconds, or of the unit behind it.
double time_step_s(const std::string& text) {
  const auto number = parse_number(text);
  const auto unit = number ? find_unit("s") : find_unit(text);
  const double step = !unit || unit->quantity != Quantity::time ? 0 : unit->to_canonical(number.value_or(1));
  if (!(step > 0)) throw UsageError("--time-step is '" + text + "'; allowed: a time above 0, as 10 (s), 100ms, 5min");
  return step;
}

/// A command line for each dialect that has a name.
const std::pair<std::string_view, std::string_view> dialect_examples[] = {
    {"twincat", "thermfit check scope.csv --dialect twincat"},
    {"lvm", "thermfit check runs/ --dialect lvm"},
    {"catman", "thermfit check warm-up.asc --dialect catman --temperatures 'Lager*' --errors 'Verlagerung Z'"},
    {"benchlink", "thermfit check Data.csv --dialect benchlink --temperatures '101*,102*' --errors '103*'"},
    {"picolog", "thermfit check tc08.csv --dialect picolog --temperatures 'Front*,Rear*' --errors 'Probe*'"},
    {"halsampler", "thermfit check warm-up.txt --dialect halsampler --columns T1,T2,Z --time-step 1"},
};

/// `Z=mm`: the last equals sign divides, so that a name may have one.
std::vector<CsvUnit> units(const Arguments& arguments, const std::string& option) {
  std::vector<CsvUnit> all;
  for (const std::string& entry : arguments.list(option)) {
    const std::size_t equals = entry.rfind('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError(option + " has '" + entry + "'; allowed: NAME=UNIT, as in Z=mm or 'T*=degF'");
    all.push_back({entry.substr(0, equals), entry.substr(equals + 1)});
    if (!find_unit(all.back().unit))
      throw UsageError(option + " has '" + entry +
                       "'; allowed units: " + std::string(unit_names(Quantity::temperature)) + "; " +
                       std::string(unit_names(Quantity::length)) + "; " + std::string(unit_names(Quantity::time)));
  }
  return all;
}

}  // namespace

std::vector<Option> campaign_options() {
  return {
      {"--temperatures", "NAMES",
       "temperature points, comma-separated; a name may be a glob such as 'PT*' (default: T1, T2, …)", 0, true},
      {"--errors", "NAMES", "thermal errors (default: those of X, Y, Z that there are)", 0, true},
      {"--inputs", "NAMES", "known inputs (default: every other column of numbers; none: none of them)", 0, true},
      {"--time-column", "NAME",
       "the clock, or 'none'; a name that several columns have, or a glob: each is the clock of the columns right of "
       "it "
       "(default: time_s, time_min, time_h, Time, t, or the column of dates and times)",
       0, false},
      {"--between", "HOW",
       "linear or held: what channels with clocks of their own are between their samples (default: linear)", 0, false},
      {"--time-unit", "UNIT", "unit of a clock that names none: us, ms, s, min, h, d (default: min)", 0, false},
      {"--time-format", "FORMAT",
       "day-first, month-first (4/5/2026), unix-s, unix-ms (since 1970), or days (as spreadsheets count); default: "
       "from the file, told, and an error where it leaves that open",
       0, false},
      {"--time-step", "TIME",
       "rows are so far apart, as 10, 100ms or 5min, whatever a clock says (default: a clock tells)", 0, false},
      {"--units", "NAME=UNIT,…",
       "units of temperatures, errors and the clock, such as 'Z=mm,T*=degF'; they win over the file's (default: as "
       "written behind the names or below them; else degC, um)",
       0, true},
      {"--batch-column", "NAME", "split each file into batches by this column (default: a file is a batch)", 0, false},
      {"--long", "NAME,VALUE",
       "columns of names and values of a table with a line for each value (default: where titles such as variable and "
       "value say so, told; none: never)",
       0, true},
      {"--join", "GLOBS",
       "files like a glob are one batch that its logger split, such as 'run1_*,run2_*' (default: a file is a batch)", 0,
       true},
      {"--missing", "POLICY",
       "missing values: error, drop (leave the row out), hold (repeat the last) (default: error)", 0, false},
      {"--missing-marks", "MARKS",
       "cells without a reading, as 'ERR7,-999.9', besides empty, NA, NaN, OL, ---, #NV, Overflow, Burnout and the "
       "like",
       0, true},
      {"--dialect", "NAME",
       "twincat, lvm, catman, benchlink, picolog, halsampler: options that fit such files, see 'thermfit help "
       "dialects' "
       "(default: where the file is one for sure, told; none: never)",
       0, false},
      {"--header-line", "N|TEXT",
       "line of the file that holds the names, or the text it begins with (default: the first, or the one above the "
       "rows, "
       "told)",
       0, false},
      {"--units-line", "TEXT", "what a line of units above the names begins with (default: the line below the names)",
       0, false},
      {"--skip-columns", "NAMES", "columns that are not read; a name may be a glob", 0, true},
      {"--encoding", "NAME", "latin1, cp1252, gb18030, … as iconv calls it (default: UTF-8, or UTF-16 with its mark)",
       0, false},
      {"--delimiter", "MARK", "comma, semicolon, tab, bar, or space for any number of blanks (default: from the file)",
       0, false},
      {"--decimal", "MARK", "point or comma (default: from the file)", 0, false},
      {"--thousands", "MARK",
       "comma, point, space or apostrophe, where they group thousands (default: from the file where it can be nothing "
       "else)",
       0, false},
      {"--columns", "NAMES", "names of the columns, in place of those of a header line if there is one", 0, true},
      {"--max-errors", "N", "problems told of before giving up (default: 20)", 0, false},
  };
}

std::vector<Option> simulated_options() {
  return {
      {"--sim-temperatures", "NAMES", "of the simulator's output (this and the next ones: default: as measured)", 0,
       true},
      {"--sim-errors", "NAMES", "thermal errors in the simulator's output", 0, true},
      {"--sim-inputs", "NAMES", "known inputs in the simulator's output", 0, true},
      {"--sim-time-column", "NAME", "its clock, or 'none'", 0, false},
      {"--sim-time-unit", "UNIT", "unit of its clock, where it names none", 0, false},
      {"--sim-time-format", "FORMAT", "of its clock, as of --time-format", 0, false},
      {"--sim-units", "NAME=UNIT,…", "units of its columns; without it those of --units, if there are any", 0, true},
      {"--sim-time-shift", "S", "seconds to add to its clock (default: 0)", 0, false},
  };
}

std::string dialects_help() {
  std::string text =
      "Files of some loggers and programs need several options at once; a dialect is a name for them. What else the "
      "command line says wins. A file that is one for sure is read so without being asked, and that is told.";
  text = wrap(text, 80, 0);
  for (const NamedDialect& one : named_dialects) {
    text += '\n' + std::string(one.name) + '\n' + wrap("  " + with_flags(one.sets), 80, 2);
    std::string sets;
    const auto set = [&](const std::string& flag, std::string_view value) {
      if (!value.empty()) sets += " " + flag + " '" + std::string(value) + "'";
    };
    set("--delimiter", one.separator == ' ' ? "space" : "");
    set("--header-line", one.names_begin);
    set("--units-line", one.units_begin);
    set("--time-column", one.time_column);
    set("--time-unit", one.time_unit);
    set("--skip-columns", one.skip_columns);
    set("--encoding", one.encoding);
    text += wrap("  as:" + sets + (one.encoding.empty() ? "" : " where it is no UTF-8"), 80, 6);
    for (const auto& [name, line] : dialect_examples)
      if (name == one.name) text += "  " + std::string(line) + '\n';
  }
  return text;
}

Option absolute_option() {
  return {"--absolute", "", "use temperatures in degC (default: their rise since the first row of the batch)", 0,
          false};
}

TemperatureReference temperature_reference(const Arguments& arguments) {
  return arguments.has("--absolute") ? TemperatureReference::absolute : TemperatureReference::rise;
}

CsvOptions csv_options(const Arguments& arguments, CampaignSide side) {
  const auto named = [&](const char* option) { return of_side(arguments, option, side); };
  CsvOptions options;
  options.separator = separator(arguments);
  options.decimal_mark = decimal_mark(arguments);
  options.thousands = thousands(arguments);
  options.encoding = arguments.value_or("--encoding", "");
  options.columns = arguments.list("--columns");
  options.missing_marks = arguments.list("--missing-marks");
  options.dialect = dialect(arguments);
  const std::string names = arguments.value_or("--header-line", "");
  if (names.find_first_not_of("0123456789") == std::string::npos)
    options.header_line = static_cast<std::size_t>(arguments.integer("--header-line", 1, 100000).value_or(0));
  else
    options.names_begin = names;
  options.units_begin = arguments.value_or("--units-line", "");
  options.skip_columns = arguments.list("--skip-columns");
  options.time_column = arguments.value_or(named("--time-column"), "");
  options.time_unit = arguments.value_or(named("--time-unit"), "");
  const auto unit = find_unit(options.time_unit);
  if (!options.time_unit.empty() && (!unit || unit->quantity != Quantity::time))
    throw UsageError(named("--time-unit") + " is '" + options.time_unit +
                     "'; allowed: " + std::string(unit_names(Quantity::time)));
  const std::string format = arguments.choice(
      named("--time-format"), {"auto", "day-first", "month-first", "unix-s", "unix-ms", "days"}, "auto");
  options.time_format = format == "day-first"     ? TimeFormat::day_first
                        : format == "month-first" ? TimeFormat::month_first
                        : format == "unix-s"      ? TimeFormat::unix_s
                        : format == "unix-ms"     ? TimeFormat::unix_ms
                        : format == "days"        ? TimeFormat::serial_days
                                                  : TimeFormat::from_file;
  if (arguments.has("--time-step")) options.time_step_s = time_step_s(arguments.value_or("--time-step", ""));
  options.between = arguments.choice("--between", {"linear", "held"}, "linear") == "held" ? BetweenSamples::held
                                                                                          : BetweenSamples::linear;
  options.temperatures = arguments.list(named("--temperatures"));
  options.errors = arguments.list(named("--errors"));
  options.units = units(arguments, named("--units"));
  if (arguments.has(named("--inputs"))) {
    options.inputs = arguments.list(named("--inputs"));
    if (*options.inputs == std::vector<std::string>{"none"}) options.inputs->clear();
  }
  options.batch_column = arguments.value_or("--batch-column", "");
  options.long_table = arguments.list("--long");
  options.join = arguments.list("--join");
  if (!options.join.empty() && !options.batch_column.empty())
    throw UsageError("--join makes one batch of files and --batch-column several of one; say one of them");
  const std::string missing = arguments.choice("--missing", {"error", "drop", "hold"}, "error");
  options.missing = missing == "drop"   ? MissingValues::drop
                    : missing == "hold" ? MissingValues::hold
                                        : MissingValues::error;
  options.max_errors = static_cast<std::size_t>(arguments.integer("--max-errors", 1, 1000000).value_or(20));
  return options;
}

std::vector<std::string> find_files(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  const auto append = [&](const std::vector<std::string>& more) {
    files.insert(files.end(), more.begin(), more.end());
  };
  for (const std::string& path : paths) {
    std::error_code ignored;
    if (path == "-" || (fs::exists(path, ignored) && !fs::is_directory(path, ignored)))
      files.push_back(path);
    else if (fs::is_directory(path, ignored))
      append(files_in(path));
    else if (path.find_first_of("*?[") != std::string::npos)
      append(files_like(path));
    else
      throw Error(path, "no such file or folder", "files, folders, quoted globs, or - for stdin");
  }
  return files;
}

namespace {

/// Throws Error on what is not a batch by its first character.
void require_batches(const std::vector<std::string>& files) {
  for (const std::string& file : files)
    if (begins_as_json(file))
      throw Error(file, "is a JSON document, as models and machines are", "batches: tables of text, .csv or .csv.gz",
                  "where a command takes a model or a machine, it comes first");
}

}  // namespace

bool begins_as_json(const std::string& path) {
  if (!file_identity(path)) return false;  // what is looked at in a pipe is gone
  std::ifstream file(path);
  char first = 0;
  return file >> first && first == '{';
}

void note_copies(const Campaign& campaign, const Console& console) {
  for (std::size_t b = 0; b < campaign.size(); ++b)
    if (const Batch* original = copied_from(campaign, b))
      console.note(campaign[b].source + ": holds the numbers of " + original->name +
                   " once more: what is left out for a figure is then not left out; leave one of them out");
}

CsvReading read_files(const CsvOptions& options, const Console& console, const std::vector<std::string>& paths) {
  if (paths.empty()) throw UsageError("no batch is named; give files, folders, quoted globs, or - for stdin");
  const std::vector<std::string> files = find_files(paths);
  require_batches(files);
  CsvReading reading = thermfit::read_campaign(files, options);
  for (const std::string& note : reading.notes(options)) console.note(note);
  return reading;
}

namespace {

/// An error about the simulator's output, in the words of its own options.
Error of_simulated(const Error& error) {
  const auto own = [](std::string text) {
    for (const char* name : {"temperatures", "errors", "inputs", "time_column", "time_unit", "time_format", "units"}) {
      const std::string field = std::string("CsvOptions::") + name, value = " = ";
      std::string flag = std::string("--sim-") + name;
      std::replace(flag.begin(), flag.end(), '_', '-');
      for (std::size_t at; (at = text.find(field)) != std::string::npos;) {
        text.replace(at, field.size(), flag);
        if (text.compare(at + flag.size(), value.size(), value) == 0) text.replace(at + flag.size(), value.size(), " ");
      }
    }
    return text;
  };
  return Error({}, own(error.what()));  // one line a problem, as they stand
}

}  // namespace

Campaign read_simulated(const Arguments& arguments, const Console& console, const std::vector<std::string>& paths) {
  try {
    Campaign campaign = read_files(csv_options(arguments, CampaignSide::simulated), console, paths).batches;
    const double shift_s = arguments.number("--sim-time-shift", -1e12, 1e12).value_or(0);
    for (Batch& batch : campaign)
      if (batch.has_time()) batch.time_s.array() += shift_s;
    note_copies(campaign, console);
    return campaign;
  } catch (const Error& error) {
    throw of_simulated(error);
  }
}

Campaign read_measured(const Arguments& arguments, const Console& console, const std::vector<std::string>& paths,
                       const ThermalNetwork& machine) {
  CsvOptions options = csv_options(arguments);
  for (const ThermalNetwork::Channel& channel : machine.channels) {
    const bool error = std::any_of(machine.displacements.begin(), machine.displacements.end(),
                                   [&](const auto& output) { return output.output == channel.column; });
    const std::string unit = channel.unit.empty() ? (error ? "um" : "degC") : channel.unit;
    options.units.push_back({channel.column, (channel.correction ? "-" : "") + unit, true});
  }
  Campaign campaign = read_files(options, console, paths).batches;
  note_copies(campaign, console);
  return campaign;
}

Campaign read_campaign(const Arguments& arguments, const Console& console, const std::vector<std::string>& paths,
                       bool needs_inputs) {
  CsvOptions options = csv_options(arguments);
  options.inputs_may_lack = !needs_inputs;
  Campaign campaign = read_files(options, console, paths).batches;
  note_copies(campaign, console);
  return campaign;
}

void require_errors(const Campaign& campaign) {
  for (const Batch& batch : campaign)
    if (batch.errors.count() == 0)
      throw Error(batch.source, "no thermal error", "X, Y, Z or the names given by --errors",
                  "other columns: " + name_list(batch.inputs.names));
}

void require_time(const Campaign& campaign) {
  for (const Batch& batch : campaign)
    if (!batch.has_time())
      throw Error(batch.source, "no clock", "time_s, time_min, time_h, Time, or a column of dates and times",
                  "name it: --time-column NAME --time-unit UNIT");
}

}  // namespace thermfit::cli
