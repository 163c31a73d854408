#pragma once

#include <vector>

#include "thermfit/lazy.hpp"
#include "thermfit/network/impl/drive.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit::detail {

/// The parameters that can move a temperature of one batch: tangents of the state have a column for these only, so that
/// numbers of other batches cost nothing.
template <typename Scalar>
class StateColumns {
 public:
  StateColumns(const Lazy<ThermalSystem, Scalar>& system, const Drive<Scalar>& drive)
      : columns_(system.state_columns), place_(static_cast<std::size_t>(system.columns), -1) {
    if (drive.of_batch() != nullptr)
      for (const auto* more : {&drive.of_batch()->start_columns, &drive.of_batch()->ambient_columns})
        for (const Column column : *more)
          if (column >= 0) columns_.push_back(column);
    for (std::size_t j = 0; j < columns_.size(); ++j)
      place_[static_cast<std::size_t>(columns_[j])] = static_cast<Column>(j);
  }

  Index count() const { return static_cast<Index>(columns_.size()); }

  /// The parameters, in the order of the tangents.
  const std::vector<Column>& columns() const { return columns_; }

  /// Place of a parameter in the tangents of the state, or -1.
  Column operator()(Column column) const { return place_[static_cast<std::size_t>(column)]; }

  /// Drive::ambient_tangent() of these parameters.
  RowVectorX<Scalar> ambient_tangent(const Drive<Scalar>& drive, Index sample, double time_s) const {
    const RowVectorX<Scalar> all = drive.ambient_tangent(sample, time_s);
    RowVectorX<Scalar> result(count());
    for (Index j = 0; j < result.size(); ++j) result(j) = all(columns_[static_cast<std::size_t>(j)]);
    return result;
  }

 private:
  std::vector<Column> columns_;
  std::vector<Column> place_;
};

}  // namespace thermfit::detail
