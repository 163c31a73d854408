#pragma once

#include <string>
#include <vector>

#include "thermfit/io/csv/rows.hpp"

namespace thermfit {

/// A file of numbers as it stands: no roles, no units.
struct CsvTable {
  std::vector<std::string> names;  ///< of the columns of numbers, in the order of the file
  Matrix values;                   ///< rows x names.size()
};

/// Reads every column of numbers of a file, time too, in the order of the file; columns of text are left out.
/// Throws Error as read_rows does. Allocates.
template <typename Scalar = double>
CsvTable read_table(const std::string& path, CsvOptions options = {}) {
  options.time_column = "none";
  options.temperatures.clear();
  options.errors.clear();
  options.inputs.reset();
  options.plain = true;
  CsvTable table;
  std::vector<double> values;
  read_rows(
      path, options, [&](const CsvFile& file) { table.names = file.roles.inputs; },
      [&](const CsvRow& row) {
        values.insert(values.end(), row.inputs.data(), row.inputs.data() + row.inputs.size());
      });
  const auto columns = static_cast<Index>(table.names.size());
  const Index rows = columns == 0 ? 0 : static_cast<Index>(values.size()) / columns;
  table.values = Eigen::Map<const RowMatrixX<Scalar>>(values.data(), rows, columns);
  return table;
}

}  // namespace thermfit
