#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/error.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Known inputs `names` of a batch, rows x names. Throws Error on a column that is not
/// there or lacks a number. Allocates the result.
template <typename Scalar>
MatrixX<Scalar> known_inputs(const Batch& batch, const std::vector<std::string>& names) {
  MatrixX<Scalar> values(batch.rows(), static_cast<Index>(names.size()));
  const std::string& place = batch.source.empty() ? batch.name : batch.source;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Index column = batch.inputs.find(names[i]);
    if (column < 0) {
      std::string there;
      for (const std::string& name : batch.inputs.names) there += (there.empty() ? "" : ", ") + name;
      throw Error(place, "no known input '" + names[i] + "', which the model needs", there);
    }
    for (Index row = 0; row < batch.rows(); ++row) {
      const double value = batch.inputs.values(row, column);
      if (!std::isfinite(value))
        throw Error(place,
                    "no number of the known input '" + names[i] + "' in row " + std::to_string(batch.number_of(row)),
                    "a number in every row");
      values(row, static_cast<Index>(i)) = static_cast<Scalar>(value);
    }
  }
  return values;
}

}  // namespace thermfit
