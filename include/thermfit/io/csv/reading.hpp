#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/io/csv/row.hpp"
#include "thermfit/io/nearest.hpp"

namespace thermfit {

/// Batches and what was met on the way to them.
struct CsvReading {
  Campaign batches;                 ///< of all files in the order given, those of one file in order of appearance
  std::vector<CsvFile> files;       ///< what was met in each, in the order given
  std::vector<std::string> joined;  ///< a remark for each batch of several files (CsvOptions::join)

  /// Remarks a user should hear: a dialect that is not the plain one, conversions, missing values, columns left out.
  /// The same remark about several files is made once.
  std::vector<std::string> notes(const CsvOptions& options) const;
};

inline std::vector<std::string> CsvReading::notes(const CsvOptions& options) const {
  std::vector<std::pair<std::string, std::vector<std::string>>> found;
  const auto add = [&](const CsvFile& file, const std::string& text) {
    for (auto& [known, paths] : found)
      if (known == text) return paths.push_back(file.path);
    found.push_back({text, {file.path}});
  };
  for (const CsvFile& file : files) {
    if (!file.widened.empty()) add(file, file.widened);
    if (!file.recognised.empty()) add(file, file.recognised);
    if (!file.dialect.is_plain()) add(file, file.dialect.description());
    if (file.roles.assumed_minutes)
      add(file, file.roles.time + " names no unit: minutes (CsvOptions::time_unit tells another)");
    if (!file.roles.clock.empty()) add(file, file.roles.clock + " (CsvOptions::time_format = FORMAT tells another)");
    if (!file.clocks.empty()) add(file, file.clocks);
    if (!file.roles.replaced.empty())
      add(file, "the names given stand in place of those of line " + file.roles.replaced);
    if (!file.roles.spelled.empty()) add(file, "as the cells say: " + name_list(file.roles.spelled));
    if (!file.roles.may_be_grouped.empty())
      add(file, "left out, numbers only if their thousands are grouped (CsvOptions::thousands = " +
                    std::string(file.dialect.decimal_mark == '.' ? "comma" : "point") +
                    "): " + name_list(file.roles.may_be_grouped));
    if (!file.roles.made_up.empty()) add(file, "columns named here: " + name_list(file.roles.made_up));
    if (file.left_out_lines > 0)
      add(file, std::to_string(file.left_out_lines) + (file.left_out_lines == 1 ? " line" : " lines") +
                    " left out as no rows, first " + file.first_left_out);
    if (file.newest_first) add(file, "newest row first: turned round");
    if (!file.roles.converted.empty()) add(file, "converted: " + name_list(file.roles.converted));
    if (!file.roles.contradicted.empty()) add(file, "as CsvOptions::units says: " + name_list(file.roles.contradicted));
    if (!file.roles.nearly.empty()) add(file, "taken as inputs: " + name_list(file.roles.nearly));
    std::vector<std::string> words = file.roles.ignored;
    words.erase(std::remove_if(words.begin(), words.end(),
                               [&](const std::string& name) {
                                 const auto& grouped = file.roles.may_be_grouped;
                                 return std::find(grouped.begin(), grouped.end(), name) != grouped.end();
                               }),
                words.end());
    if (!file.roles.nameless.empty() && !options.inputs)
      add(file, "left out, without a name: " + name_list(file.roles.nameless) + " (CsvOptions::inputs takes them)");
    if (!file.roles.skipped.empty()) add(file, "left out as told: " + name_list(file.roles.skipped));
    if (!words.empty() && !options.inputs) add(file, "left out, no numbers: " + name_list(words));
    if (file.missing == 0 || options.missing == MissingValues::keep) continue;
    const std::string cells = std::to_string(file.missing) + (file.missing == 1 ? " missing value" : " missing values");
    add(file, options.missing == MissingValues::drop
                  ? std::to_string(file.dropped_rows) + (file.dropped_rows == 1 ? " row" : " rows") + " left out for " +
                        cells + ", first " + file.first_missing
                  : cells + " held, first " + file.first_missing);
  }
  std::vector<std::string> notes = joined;
  for (const auto& [text, paths] : found)
    notes.push_back(paths.front() +
                    (paths.size() > 1 ? " and " + std::to_string(paths.size() - 1) + " more" : std::string()) + ": " +
                    text);
  return notes;
}

}  // namespace thermfit
