#pragma once

#include <map>
#include <string>
#include <vector>

#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/io/csv/rows.hpp"
#include "thermfit/moments/moments.hpp"

namespace thermfit {

/// What remains of a batch when its rows have gone by.
struct BatchMoments {
  std::string name;   ///< value of the batch column; empty without one
  Vector first_degC;  ///< temperatures of its first row, also where that is left out; NaN where it has none
  Moments<> moments;  ///< of all its rows: temperatures in degC or, as rises, in K; errors in um
};

/// The batches of one file as moments, in order of appearance, and what was met while reading.
struct CsvMoments {
  CsvFile file;                       ///< what was met
  std::vector<BatchMoments> batches;  ///< in order of appearance
};

/// Reads a file of any size in constant memory: 256 rows a batch at a time become moments. With
/// TemperatureReference::rise temperatures count from the first row of their batch. Throws Error as read_rows does, and
/// on a rise without a first reading.
template <typename Scalar = double>
CsvMoments read_moments(const std::string& path, CsvOptions options = {},
                        TemperatureReference reference = TemperatureReference::rise) {
  constexpr Index block_rows = 256;
  struct Growing {
    MatrixX<Scalar> temperatures, errors;
    Index filled = 0;
  };
  options.inputs = std::vector<std::string>{};
  CsvMoments result;
  std::vector<Growing> growing;
  std::vector<Index> begins;
  std::map<std::string, std::size_t, std::less<>> index;
  std::size_t current = 0;
  const auto flush = [&](std::size_t b) {
    Growing& rows = growing[b];
    result.batches[b].moments.add_rows(rows.temperatures.topRows(rows.filled), rows.errors.topRows(rows.filled));
    rows.filled = 0;
  };
  result.file = read_rows(path, options, nullptr, [&](const CsvRow& row) {
    if (result.batches.empty() || result.batches[current].name != row.batch) {
      const auto [found, fresh] = index.emplace(row.batch, result.batches.size());
      current = found->second;
      if (fresh) {
        result.batches.push_back(
            {std::string(row.batch), row.first_degC.transpose(), {row.temperatures.size(), row.errors.size()}});
        begins.push_back(row.number);
        growing.push_back(
            {MatrixX<Scalar>(block_rows, row.temperatures.size()), MatrixX<Scalar>(block_rows, row.errors.size()), 0});
      }
    }
    Growing& rows = growing[current];
    rows.temperatures.row(rows.filled) = row.temperatures;
    rows.errors.row(rows.filled) = row.errors;
    if (++rows.filled == block_rows) flush(current);
  });
  for (std::size_t b = 0; b < growing.size(); ++b) {
    flush(b);
    BatchMoments& batch = result.batches[b];
    if (reference == TemperatureReference::absolute) continue;
    Batch begun;
    begun.source = path;
    begun.temperatures.names = result.file.roles.temperatures;
    begun.first_degC = batch.first_degC;
    begun.row_numbers = {begins[b]};
    require_first_readings(begun, begun.temperatures.names);
    batch.moments = batch.moments.minus(batch.first_degC);
  }
  return result;
}

}  // namespace thermfit
