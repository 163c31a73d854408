#pragma once

#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"

namespace thermfit {

/// The batch with only its rows `kept`, increasing, from 0. They keep their numbers in the file, and rises count from
/// the first row all the same. Batch::dropped_rows counts those that went. Allocates.
inline Batch kept_rows(Batch batch, const std::vector<Index>& kept) {
  const auto size = static_cast<Index>(kept.size());
  if (size == batch.rows()) return batch;
  Channels& temperatures = batch.temperatures;
  if (batch.first_degC.size() == 0 && batch.rows() > 0 && (kept.empty() || kept.front() > 0)) {
    batch.first_degC.resize(temperatures.count());
    for (Index c = 0; c < temperatures.count(); ++c) batch.first_degC(c) = temperatures.values(0, c);
  }
  std::vector<Index> numbers;
  for (const Index row : kept) numbers.push_back(batch.number_of(row));
  batch.dropped_rows += batch.rows() - size;
  batch.row_numbers = std::move(numbers);
  for (Channels* channels : {&batch.temperatures, &batch.errors, &batch.inputs}) {
    Matrix values(channels->values.rows() > 0 ? size : 0, channels->values.cols());
    for (Index c = 0; c < values.cols(); ++c)
      for (Index row = 0; row < values.rows(); ++row)
        values(row, c) = channels->values(kept[static_cast<std::size_t>(row)], c);
    channels->values = std::move(values);
  }
  if (!batch.has_time()) return batch;
  Vector time_s(size);
  for (Index row = 0; row < size; ++row) time_s(row) = batch.time_s(kept[static_cast<std::size_t>(row)]);
  batch.time_s = std::move(time_s);
  return batch;
}

}  // namespace thermfit
