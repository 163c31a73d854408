#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/long_table.hpp"
#include "thermfit/io/csv/named_dialect.hpp"
#include "thermfit/io/csv/preamble.hpp"
#include "thermfit/io/csv/row.hpp"

namespace thermfit::detail {

/// Finds where the table of a file begins: what dialect has a name, which lines stand before the names, and whether it
/// has a line for each value. What is found so stands in the options then, as if it had been said, and is told in the
/// file.
class TableStart {
 public:
  TableStart(CsvLines& lines, CsvOptions& options, CsvFile& file, CellPlaces& places)
      : lines_(lines), options_(options), file_(file), places_(places), evidence_(lines.head()) {}

  /// How many content lines stand before the names; the evidence begins with these then.
  std::size_t find() {
    recognise();
    const std::size_t before = skip_to_names();
    return widen(before) ? 0 : before;
  }

  const CsvEvidence& evidence() const { return evidence_; }

 private:
  void recognise() {
    const NamedDialect* const named = find_dialect(options_, evidence_);
    if (!named) return;
    if (options_.dialect.empty())
      file_.recognised = "read as " + std::string(named->what) + " (CsvOptions::dialect = none reads it as any table)";
    apply(*named, options_);
    if (named->encoding.empty() || !lines_.encoding().empty() || is_utf8(lines_.head())) return;
    lines_.decode(std::string(named->encoding));
    evidence_ = CsvEvidence(lines_.head());
  }

  /// Takes lines that stand before the names out of the evidence: what the options say, `sep=`, a preamble. How many.
  std::size_t skip_to_names() {
    auto& lines = evidence_.lines;
    const std::size_t all = lines.size();
    if (!lines.empty() && lines.front().number == 1)
      if (const char told = told_separator(lines.front().text)) {
        if (options_.separator == 0) options_.separator = told;
        lines.erase(lines.begin());
      }
    if (options_.header_line > 0) {
      const auto names = std::find_if(lines.begin(), lines.end(),
                                      [&](const auto& line) { return line.number == options_.header_line; });
      if (names == lines.end())
        throw problem(file_.path,
                      {"CsvOptions::header_line = ", std::to_string(options_.header_line),
                       " is empty, a comment, or not among the first lines"},
                      {"the number of the line that holds the names, from 1"});
      lines.erase(lines.begin(), names);
    } else if (!options_.names_begin.empty()) {
      const std::size_t names = line_that_begins(evidence_, options_.names_begin);
      if (names == lines.size())
        throw problem(file_.path, {"no line begins with ", shown(options_.names_begin)},
                      {"a line of names that does (CsvOptions::header_line",
                       options_.dialect.empty() ? ")" : ", CsvOptions::dialect = " + options_.dialect + ")"});
      for (std::size_t i = 0; i < names && !options_.units_begin.empty(); ++i)
        if (starts_with(lines[i].text, options_.units_begin)) evidence_.units = lines[i];
      lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(names));
    } else {
      const std::size_t before = lines_before_names(evidence_, options_.separator, options_.columns.size());
      lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(before));
    }
    return all - lines.size();
  }

  /// Makes a wide table of a long one, in which `before` lines of the file are not among the evidence. False where it
  /// is none.
  bool widen(std::size_t before) {
    std::vector<CsvField> fields;
    std::vector<CsvColumn> columns;
    std::optional<LongColumns> meaning;
    char separator = options_.separator;
    std::size_t header_line = 0;
    for (std::size_t i = 0; i < evidence_.lines.size() && !meaning; ++i) {
      const auto& line = evidence_.lines[i];
      if (!is_utf8(line.text)) break;
      for (const char one : {',', ';', '\t'})
        if (options_.separator == 0 && !split_line(line.text, one, fields) && fields.size() > 2) separator = one;
      if (separator == 0 || split_line(line.text, separator, fields)) continue;
      if (is_number_line(fields)) break;
      columns.clear();
      for (const CsvField& field : fields) columns.push_back(column_of(field));
      header_line = line.number;
      meaning = find_long_columns(columns, options_);
      if (meaning && options_.long_table.empty() && !holds_words(i + 1, separator, meaning->name)) meaning.reset();
      if (meaning) before += i;
    }
    if (!meaning && !options_.long_table.empty() && options_.long_table.front() != "none")
      throw problem(file_.path, {"the columns of CsvOptions::long_table are not there"},
                    {"the column of the names and the column of the values"});
    if (!meaning) return false;
    Widened wide(columns, *meaning, separator, file_.path);
    std::string_view line;
    for (std::size_t content = 0; lines_.next(line);) {
      if (!is_content(line)) continue;
      if (content++ > before) wide.take(line, lines_.line_number());
    }
    if (wide.channels() > options_.max_columns)
      throw problem(file_.path, {std::to_string(wide.channels()), " names in ", columns[meaning->name].title},
                    {"at most ", std::to_string(options_.max_columns)});
    lines_.replace(wide.text(places_));
    evidence_ = CsvEvidence(lines_.head());
    options_.separator = separator;
    options_.header_line = 0;
    options_.names_begin.clear();
    if (meaning->time) options_.time_column = columns[*meaning->time].title;
    file_.widened = "a line for each value, names in line " + std::to_string(header_line) +
                    ": the columns are those of " + columns[meaning->name].title + ", their values " +
                    columns[meaning->value].title + " (CsvOptions::long_table = none reads it as it stands)";
    return true;
  }

  /// Whether a column holds words in every line of the evidence from the `begin`th on.
  bool holds_words(std::size_t begin, char separator, std::size_t column) const {
    std::vector<CsvField> fields;
    for (std::size_t i = begin; i < evidence_.lines.size(); ++i)
      if (!split_line(evidence_.lines[i].text, separator, fields) && column < fields.size() && fields.size() > 1 &&
          (is_missing(fields[column].text) || is_number_or_stamp(fields[column].text)))
        return false;
    return true;
  }

  CsvLines& lines_;
  CsvOptions& options_;
  CsvFile& file_;
  CellPlaces& places_;
  CsvEvidence evidence_;
};

}  // namespace thermfit::detail
