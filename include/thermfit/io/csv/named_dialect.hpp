#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/error.hpp"
#include "thermfit/io/csv/evidence.hpp"
#include "thermfit/io/csv/field.hpp"
#include "thermfit/io/csv/options.hpp"
#include "thermfit/io/units.hpp"

namespace thermfit {

/// What a logger or program writes, as values of CsvOptions; whoever sets one of them wins.
struct NamedDialect {
  std::string_view name;                       ///< CsvOptions::dialect
  std::string_view what;                       ///< of a file, as "a TwinCAT Scope export"
  std::string_view sets;                       ///< in words, for the user
  std::string_view encoding;                   ///< where the file is no UTF-8
  char separator;                              ///< 0: from the file; as the rest, which is empty where it is not set
  std::string_view names_begin;                ///< CsvOptions::names_begin
  std::string_view units_begin;                ///< CsvOptions::units_begin
  std::string_view time_column;                ///< CsvOptions::time_column
  std::string_view time_unit;                  ///< CsvOptions::time_unit
  std::string_view skip_columns;               ///< CsvOptions::skip_columns, comma-separated
  bool (*is_one)(const detail::CsvEvidence&);  ///< from the start of a file, unmistakably; null: nothing tells
};

namespace detail {

inline bool begins(const CsvEvidence& evidence, std::string_view text) {
  return !evidence.lines.empty() && starts_with(trim(evidence.lines.front().text), text);
}

inline bool has_line(const CsvEvidence& evidence, std::string_view start) {
  return std::any_of(evidence.lines.begin(), evidence.lines.end(),
                     [&](const auto& line) { return starts_with(line.text, start); });
}

/// `Name`, a channel, `Name`, a channel, …: two or more.
inline bool is_scope_header(std::string_view line) {
  std::vector<CsvField> fields;
  for (const char separator : {'\t', ';', ','}) {
    if (split_line(line, separator, fields) || fields.size() < 4 || fields.size() % 2 != 0) continue;
    std::size_t names = 0;
    for (std::size_t f = 0; f < fields.size(); f += 2) names += fields[f].text == "Name" && !fields[f + 1].text.empty();
    if (2 * names == fields.size()) return true;
  }
  return false;
}

/// A first column without a name, and `Ave.`, `Last`, `Min.` or `Max.` with a unit behind every other name.
inline bool is_picolog_header(const CsvEvidence& evidence) {
  std::vector<CsvField> fields;
  if (evidence.lines.empty() || split_line(evidence.lines.front().text, ',', fields) || fields.size() < 2) return false;
  return fields.front().text.empty() && std::all_of(fields.begin() + 1, fields.end(), [](const CsvField& field) {
           return std::any_of(field.text.begin(), field.text.end(), [](char c) { return c == '('; }) &&
                  (field.text.find(" Ave. (") != std::string_view::npos ||
                   field.text.find(" Last (") != std::string_view::npos ||
                   field.text.find(" Min. (") != std::string_view::npos ||
                   field.text.find(" Max. (") != std::string_view::npos);
         });
}

}  // namespace detail

/// The dialects that have a name.
inline constexpr std::array<NamedDialect, 6> named_dialects{{
    {"twincat", "a TwinCAT Scope export",
     "Beckhoff TwinCAT 3 Scope, export as CSV: lines about the project and about each channel, names in the last line "
     "that begins with Name, then a column of times in ms before every channel. The channels are put on one clock.",
     "cp1252", 0, "Name", "", "Name", "ms", "",
     [](const detail::CsvEvidence& evidence) {
       return (detail::begins(evidence, "Name") && detail::has_line(evidence, "Starttime of export")) ||
              (!evidence.lines.empty() && detail::is_scope_header(evidence.lines.front().text));
     }},
    {"lvm", "a LabVIEW measurement",
     "LabVIEW measurement file (Write To Measurement File, .lvm): header blocks, units in the line Y_Unit_Label, names "
     "in the line that begins with X_Value, which is the clock in s: one for all or one left of each channel.",
     "cp1252", 0, "X_Value", "Y_Unit_Label", "X_Value", "s", "",
     [](const detail::CsvEvidence& evidence) { return detail::begins(evidence, "LabVIEW Measurement"); }},
    {"catman", "a catman export",
     "HBM catman, export as ASCII with channel information: what stands above the names is left out, units below them "
     "are read, a clock 'Zeit 1 - …' or 'Time 1 - …' a sampling rate, ISO 8859-1 or Windows-1252 where it is no UTF-8.",
     "cp1252", 0, "", "", "", "", "",
     [](const detail::CsvEvidence& evidence) { return detail::begins(evidence, "HBM_CATMAN_DATAFILE"); }},
    {"benchlink", "a BenchLink Data Logger export",
     "Keysight (Agilent) BenchLink Data Logger, export as CSV: the setup above the names is left out, names in the "
     "last line that begins with Scan, the clock is Time; the columns Scan and Alarm are left out.",
     "cp1252", 0, "Scan", "", "Time", "", "Scan,Alarm *",
     [](const detail::CsvEvidence& evidence) {
       return detail::begins(evidence, "Name:") && detail::has_line(evidence, "Scan Control:");
     }},
    {"picolog", "a PicoLog export",
     "Pico Technology PicoLog, export as CSV: the first column has no name and is the clock, in s where it is a "
     "number.",
     "cp1252", 0, "", "", "column1", "s", "", detail::is_picolog_header},
    {"halsampler", "the output of halsampler",
     "LinuxCNC halsampler: numbers between blanks, lost samples marked overrun. It has neither names nor a clock: say "
     "CsvOptions::columns, and CsvOptions::time_step_s with the period of the thread that samples.",
     "", ' ', "", "", "", "", "", nullptr},
}};

namespace detail {

/// The dialect that the options name or the start of the file tells; null for none.
inline const NamedDialect* find_dialect(const CsvOptions& options, const CsvEvidence& evidence) {
  if (options.dialect == "none") return nullptr;
  std::string names;
  for (const NamedDialect& one : named_dialects) {
    if (options.dialect.empty() ? one.is_one && one.is_one(evidence) : options.dialect == one.name) return &one;
    names += std::string(one.name) + ", ";
  }
  if (options.dialect.empty()) return nullptr;
  throw Error("CsvOptions::dialect", "there is no '" + options.dialect + "'", names + "none");
}

/// Sets what the options leave open.
inline void apply(const NamedDialect& dialect, CsvOptions& options) {
  const auto set = [](std::string& option, std::string_view value) {
    if (option.empty()) option = value;
  };
  options.dialect = dialect.name;
  if (options.separator == 0) options.separator = dialect.separator;
  if (options.header_line == 0) set(options.names_begin, dialect.names_begin);
  set(options.units_begin, dialect.units_begin);
  if (options.time_column.empty() && options.columns.empty()) {
    options.time_column = dialect.time_column;
    set(options.time_unit, dialect.time_unit);
  }
  for (std::string_view rest = dialect.skip_columns; !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    options.skip_columns.emplace_back(rest.substr(0, comma));
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
}

}  // namespace detail
}  // namespace thermfit
