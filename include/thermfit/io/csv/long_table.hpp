#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/header.hpp"
#include "thermfit/io/csv/writer.hpp"

namespace thermfit::detail {

/// Which columns of a long table, a line for each value, mean what.
struct LongColumns {
  std::size_t name = 0, value = 0;
  std::optional<std::size_t> time, batch, unit;
};

/// Where the cells of a text that was made came from.
class CellPlaces {
 public:
  void add(std::size_t line, std::size_t column, std::size_t from_line, std::size_t from_column) {
    if (lines_.size() <= line) lines_.resize(line + 1);
    lines_[line].push_back({column, from_line, from_column});
  }
  /// `file:line:column` of the cell that begins at or before `column`; of the line's first where it is 0.
  std::string place_of(const std::string& path, std::size_t line, std::size_t column) const {
    if (lines_.empty()) return place(path, line, column);
    if (line >= lines_.size() || lines_[line].empty()) return path;
    const Cell* found = &lines_[line].front();
    for (const Cell& cell : lines_[line])
      if (cell.column <= column) found = &cell;
    return place(path, found->from_line, column == 0 ? 0 : found->from_column);
  }

 private:
  struct Cell {
    std::size_t column, from_line, from_column;
  };
  std::vector<std::vector<Cell>> lines_;
};

/// The columns of a long table: those that the options name, or, where there is one of each, a column called name,
/// variable, channel, tag, signal, sensor or parameter and one called value or reading.
inline std::optional<LongColumns> find_long_columns(const std::vector<CsvColumn>& columns, const CsvOptions& options) {
  if (options.long_table == std::vector<std::string>{"none"}) return std::nullopt;
  const auto called = [&](const std::string& wanted) {
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const CsvColumn& one) { return one.is_called(wanted); });
    return found == columns.end() ? std::optional<std::size_t>() : static_cast<std::size_t>(found - columns.begin());
  };
  const auto among = [&](std::string_view words) {
    std::optional<std::size_t> found;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (words.find(' ' + lower_case(columns[c].name) + ' ') == std::string_view::npos) continue;
      if (found) return std::optional<std::size_t>();
      found = c;
    }
    return found;
  };
  const bool told = !options.long_table.empty();
  const auto name = told ? called(options.long_table.front())
                         : among(" name variable channel tag tagname signal sensor parameter kanal messstelle ");
  const auto value = told ? called(options.long_table.back()) : among(" value reading wert messwert ");
  if (!name || !value || *name == *value || !options.columns.empty() || (!told && columns.size() > 6))
    return std::nullopt;
  LongColumns found{*name, *value, std::nullopt, std::nullopt, std::nullopt};
  if (!options.batch_column.empty()) found.batch = called(options.batch_column);
  found.unit = among(" unit units einheit ");
  if (options.time_column == "none") return found;
  if (!options.time_column.empty()) {
    found.time = called(options.time_column);
    return found;
  }
  for (std::size_t c = 0; c < columns.size() && !found.time; ++c)
    if (!time_unit_in(columns[c].name).empty() || may_be_clock(columns[c].name)) found.time = c;
  if (!found.time && !told) return std::nullopt;
  return found;
}

/// A long table as one with a clock and a column for each name; row n holds the nth value of each.
class Widened {
 public:
  Widened(std::vector<CsvColumn> columns, const LongColumns& meaning, char separator, std::string path)
      : columns_(std::move(columns)), meaning_(meaning), separator_(separator), path_(std::move(path)) {}

  /// Takes a line. Throws where it has not as many fields as there are names.
  void take(std::string_view line, std::size_t number) {
    const auto broken = split_line(line, separator_, fields_);
    if (broken) throw problem(place(path_, number, broken->column), {broken->found}, {}, {broken->remedy});
    if (fields_.size() != columns_.size()) {
      if (fields_.size() == 1 && lower_case(std::string(trim(line))) == "eof") return;
      throw problem(place(path_, number),
                    {std::to_string(fields_.size()), " fields under ", std::to_string(columns_.size()), " names"},
                    {"a field for each name"});
    }
    const std::string name = fields_[meaning_.name].name();
    if (name.empty())
      throw problem(place(path_, number, fields_[meaning_.name].column), {"a value without a name"}, {"a name"});
    const auto [at, fresh] = index_.emplace(name, channels_.size());
    if (fresh) channels_.push_back({name, {}});
    Channel& channel = channels_[at->second];
    if (meaning_.unit && !fields_[*meaning_.unit].text.empty()) {
      const CsvField& unit = fields_[*meaning_.unit];
      if (!channel.unit.empty() && channel.unit != unit.text)
        throw problem(place(path_, number, unit.column), {name, " in ", unit.text, ", before in ", channel.unit},
                      {"one unit for a name"});
      channel.unit = unit.text;
    }
    const std::string batch = meaning_.batch ? cell(*meaning_.batch) : std::string();
    if (batches_.empty() || batches_.back().name != batch) {
      current_ = static_cast<std::size_t>(
          std::find_if(batches_.begin(), batches_.end(), [&](const Rows& one) { return one.name == batch; }) -
          batches_.begin());
      if (current_ == batches_.size()) batches_.push_back({batch, {}});
    } else {
      current_ = batches_.size() - 1;
    }
    auto& samples = batches_[current_].samples;
    if (samples.size() < channels_.size()) samples.resize(channels_.size());
    samples[at->second].push_back({meaning_.time ? cell(*meaning_.time) : std::string(), cell(meaning_.value), number,
                                   meaning_.time ? fields_[*meaning_.time].column : 1, fields_[meaning_.value].column});
  }

  std::size_t channels() const { return channels_.size(); }

  /// The table as text, and where its cells came from.
  std::string text(CellPlaces& places) const {
    std::string made;
    const auto separate = [&](std::size_t begin) {
      if (made.size() > begin) made += separator_;
    };
    if (meaning_.batch) made += csv_field(columns_[*meaning_.batch].title);
    for (const Channel& channel : channels_) {
      separate(0);
      if (meaning_.time) made += csv_field(columns_[*meaning_.time].title) + separator_;
      made += csv_field(channel.name + (channel.unit.empty() ? "" : " [" + channel.unit + "]"));
    }
    made += '\n';
    std::size_t line = 1;
    for (const Rows& batch : batches_) {
      std::size_t most = 0;
      for (const auto& samples : batch.samples) most = std::max(most, samples.size());
      for (std::size_t row = 0; row < most; ++row) {
        const std::size_t begin = made.size();
        ++line;
        made += batch.name;
        for (std::size_t c = 0; c < channels_.size(); ++c) {
          const bool is_there = c < batch.samples.size() && row < batch.samples[c].size();
          if (c > 0 || meaning_.batch) made += separator_;
          const Sample* const sample = is_there ? &batch.samples[c][row] : nullptr;
          if (sample) places.add(line, made.size() - begin + 1, sample->line, sample->time_column);
          if (meaning_.time) made += (sample ? sample->time : std::string()) + separator_;
          if (sample) places.add(line, made.size() - begin + 1, sample->line, sample->value_column);
          if (sample) made += sample->value;
        }
        made += '\n';
      }
    }
    return made;
  }

 private:
  struct Sample {
    std::string time, value;
    std::size_t line, time_column, value_column;
  };
  struct Channel {
    std::string name, unit;
  };
  struct Rows {
    std::string name;
    std::vector<std::vector<Sample>> samples;  ///< of each channel
  };

  std::string cell(std::size_t c) const {
    const CsvField& field = fields_[c];
    return field.quoted ? '"' + std::string(field.text) + '"' : std::string(field.text);
  }

  std::vector<CsvColumn> columns_;
  LongColumns meaning_;
  char separator_;
  std::string path_;
  std::vector<CsvField> fields_;
  std::map<std::string, std::size_t> index_;
  std::vector<Channel> channels_;
  std::vector<Rows> batches_;
  std::size_t current_ = 0;
};

}  // namespace thermfit::detail
