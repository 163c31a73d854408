#pragma once

#include <vector>

#include "thermfit/lazy.hpp"
#include "thermfit/network/impl/drive.hpp"
#include "thermfit/network/thermal_system.hpp"

namespace thermfit::detail {

/// The parameters that can move a temperature: tangents of the state have a column for these only.
template <typename Scalar>
class StateColumns {
 public:
  explicit StateColumns(const Lazy<ThermalSystem, Scalar>& system)
      : columns_(system.state_columns), place_(static_cast<std::size_t>(system.columns), -1) {
    for (std::size_t j = 0; j < columns_.size(); ++j)
      place_[static_cast<std::size_t>(columns_[j])] = static_cast<Column>(j);
  }

  Index count() const { return static_cast<Index>(columns_.size()); }

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
  const std::vector<Column>& columns_;
  std::vector<Column> place_;
};

}  // namespace thermfit::detail
