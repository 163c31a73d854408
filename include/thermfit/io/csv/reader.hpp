#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/io/csv/join_files.hpp"
#include "thermfit/io/csv/reading.hpp"
#include "thermfit/io/csv/rows.hpp"
#include "thermfit/io/files/batch_digest.hpp"
#include "thermfit/io/files/file_identity.hpp"

namespace thermfit {

namespace detail {

/// Rows of one batch as they come, to become columns at the end.
struct GrowingBatch {
  std::string key;
  std::vector<double> time_s, values, first_degC;
  std::vector<Index> numbers;  ///< of the rows in the file, from 1
  double begins_s = missing_value;
  Index held_values = 0;
};

/// The columns `names` of the rows, `width` values each, from the `first`th on.
inline Channels channels(const std::vector<std::string>& names, const GrowingBatch& rows, std::size_t first,
                         std::size_t width) {
  Channels made{names, Matrix(static_cast<Index>(rows.time_s.size()), static_cast<Index>(names.size()))};
  double* to = made.values.data();
  for (std::size_t c = first; c < first + names.size(); ++c)
    for (std::size_t row = 0; row < rows.time_s.size(); ++row) *to++ = rows.values[row * width + c];
  return made;
}

/// Turns rows that came newest first round, `met` of them with those left out, and counts from the oldest where the
/// newest was 0.
inline void turn_round(GrowingBatch& rows, std::size_t width, Index met) {
  const std::size_t count = rows.time_s.size();
  std::reverse(rows.numbers.begin(), rows.numbers.end());
  for (Index& number : rows.numbers) number = met - number + 1;
  std::reverse(rows.time_s.begin(), rows.time_s.end());
  if (count > 0 && rows.time_s.back() == 0) {
    const double first = rows.time_s.front();
    for (double& time : rows.time_s) time -= first;
    rows.begins_s += first;
  }
  for (std::size_t row = 0; row < count / 2; ++row)
    std::swap_ranges(rows.values.begin() + static_cast<std::ptrdiff_t>(row * width),
                     rows.values.begin() + static_cast<std::ptrdiff_t>((row + 1) * width),
                     rows.values.begin() + static_cast<std::ptrdiff_t>((count - 1 - row) * width));
}

inline void read_file(const std::string& path, CsvOptions options, Problems& problems, CsvReading& reading) {
  options.newest_first = true;
  CsvRowReader reader(path, options, problems);
  const CsvRoles& roles = reader.file().roles;
  if (roles.temperatures.empty()) {
    std::vector<std::string> others = roles.inputs;
    others.insert(others.end(), roles.ignored.begin(), roles.ignored.end());
    problems.add(problem(
        reader.file().path, {"no temperature point"}, {"T1, T2, … or the names given by CsvOptions::temperatures"},
        {others.size() == 1 ? "one column only: is the separator another? CsvOptions::separator says which"
                            : "columns there are: " + name_list(others)}));
    return;
  }
  const std::size_t width = roles.temperatures.size() + roles.errors.size() + roles.inputs.size();
  std::vector<GrowingBatch> batches;
  std::map<std::string, std::size_t, std::less<>> index;
  GrowingBatch* current = nullptr;
  CsvRow row{0, {}, 0, {nullptr, 0}, {nullptr, 0}, {nullptr, 0}};
  while (reader.next(row)) {
    if (!current || current->key != row.batch) {
      const auto [found, fresh] = index.emplace(row.batch, batches.size());
      if (fresh) batches.push_back({std::string(row.batch), {}, {}, {}, {}, missing_value, 0});
      current = &batches[found->second];
      if (fresh) current->first_degC.assign(row.first_degC.data(), row.first_degC.data() + row.first_degC.size());
    }
    current->held_values += row.held_values;
    current->numbers.push_back(row.number);
    current->begins_s = row.begins_s;
    current->time_s.push_back(row.time_s);
    current->values.insert(current->values.end(), row.temperatures.data(), row.temperatures.data() + width);
  }
  bool turned = false;
  for (GrowingBatch& rows : batches) {
    if (reader.newest_first(rows.key)) {
      if (rows.held_values > 0)
        problems.add(problem(reader.file().path, {"comes newest row first, where the last value would be a later one"},
                             {"CsvOptions::missing = drop"}));
      turn_round(rows, width, reader.rows_met(rows.key));
      rows.first_degC = reader.first_degC(rows.key);
      turned = true;
    }
    Batch batch;
    batch.name = roles.batch.empty() ? stem(reader.file().path) : rows.key;
    batch.source = reader.file().path;
    if (!roles.time.empty()) {
      batch.time_s.resize(static_cast<Index>(rows.time_s.size()));
      std::copy(rows.time_s.begin(), rows.time_s.end(), batch.time_s.data());
    }
    batch.temperatures = channels(roles.temperatures, rows, 0, width);
    batch.errors = channels(roles.errors, rows, roles.temperatures.size(), width);
    batch.inputs = channels(roles.inputs, rows, roles.temperatures.size() + roles.errors.size(), width);
    batch.dropped_rows = reader.dropped_rows(rows.key);
    batch.held_values = rows.held_values;
    if (rows.numbers.front() != 1)
      batch.first_degC = Eigen::Map<const Vector>(rows.first_degC.data(), static_cast<Index>(rows.first_degC.size()));
    if (rows.numbers.back() != static_cast<Index>(rows.numbers.size())) batch.row_numbers = std::move(rows.numbers);
    batch.begins_s = rows.begins_s;
    batch.digest = batch_digest(batch);
    reading.batches.push_back(std::move(batch));
    rows = {};
  }
  reading.files.push_back(reader.file());
  reading.files.back().newest_first = turned;
}

/// Brings the channels of a batch into the order of the first one. Throws when a name is missing or surplus.
inline void agree(const Channels& wanted, Channels& channels, Batch& batch, const Batch& first, const std::string& kind,
                  const std::string& option) {
  if (channels.names == wanted.names) return;
  std::vector<std::string> missing, surplus;
  for (const std::string& name : wanted.names)
    if (channels.find(name) < 0) missing.push_back(name);
  for (const std::string& name : channels.names)
    if (wanted.find(name) < 0) surplus.push_back(name);
  if (!missing.empty() || !surplus.empty())
    throw problem(batch.source,
                  {(missing.empty() ? "has " + kind + " " + name_list(surplus) + " beyond those"
                                    : "lacks " + kind + " " + name_list(missing)) +
                       " of ",
                   first.source},
                  {"the same in every batch: ", name_list(wanted.names)}, {"choose common ones with ", option});
  const Index rows = channels.values.rows();
  Channels ordered{wanted.names, Matrix(rows, channels.values.cols())};
  const bool has_first = &channels == &batch.temperatures && batch.first_degC.size() > 0;
  Vector first_degC = batch.first_degC;
  for (Index c = 0; c < wanted.count(); ++c) {
    const Index there = channels.find(wanted.names[static_cast<std::size_t>(c)]);
    const double* from = channels.values.data() + rows * there;
    std::copy(from, from + rows, ordered.values.data() + rows * c);
    if (has_first) first_degC(c) = batch.first_degC(there);
  }
  batch.first_degC = std::move(first_degC);
  channels = std::move(ordered);
}

/// Names that occur twice get their path (or path and value) instead.
inline void make_names_differ(Campaign& batches) {
  std::map<std::string, std::size_t> count;
  for (const Batch& batch : batches) ++count[batch.name];
  for (Batch& batch : batches) {
    if (count[batch.name] < 2) continue;
    const std::string path = batch.source.substr(0, batch.source.rfind('/') + 1) + stem(batch.source);
    batch.name = stem(batch.source) == batch.name ? path : path + ':' + batch.name;
  }
}

}  // namespace detail

/// Reads batches from files (`-`: standard input), in the order given. All have the same temperature points and errors,
/// in the order of the first. Those whose files are like a glob of options.join become one. Throws Error, or Errors
/// with everything that is wrong in all files up to options.max_errors. Allocates.
template <typename Scalar = double>
CsvReading read_campaign(const std::vector<std::string>& paths, const CsvOptions& options = {}) {
  CsvReading reading;
  Problems problems(options.max_errors);
  std::map<std::pair<dev_t, ino_t>, std::string> names;  // by which each file was read
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const auto before = paths.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(paths.begin(), before, paths[i]) != before) {
      problems.add(detail::problem(paths[i], {"is given twice"}, {"each file once"}));
      continue;
    }
    if (const auto identity = file_identity(paths[i])) {
      const auto [first, fresh] = names.emplace(*identity, paths[i]);
      if (!fresh) {
        problems.add(detail::problem(paths[i], {"is the same file as ", first->second}, {"each file once"},
                                     {"leave one of them out"}));
        continue;
      }
    }
    try {
      detail::read_file(paths[i], options, problems, reading);
    } catch (const Errors&) {
      throw;
    } catch (const Error& error) {
      problems.add(error);
    }
  }
  problems.throw_if_any();
  for (Batch& batch : reading.batches) {
    const Batch& first = reading.batches.front();
    detail::agree(first.temperatures, batch.temperatures, batch, first, "temperature points",
                  "CsvOptions::temperatures");
    detail::agree(first.errors, batch.errors, batch, first, "errors", "CsvOptions::errors");
  }
  if (!options.join.empty()) detail::join_files(options.join, reading);
  detail::make_names_differ(reading.batches);
  return reading;
}

THERMFIT_COMPILED_TEMPLATE(CsvReading read_campaign<double>(const std::vector<std::string>&, const CsvOptions&));

}  // namespace thermfit
