#pragma once

#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/moments/moments.hpp"

namespace thermfit {

/// One batch as fits and selection rules see it: its moments, and its rows where a rule or a check needs them.
struct Observations {
  std::string name;     ///< of the batch
  Matrix temperatures;  ///< rows x points, K of rise or degC; empty when only moments were kept
  Matrix errors;        ///< rows x responses, um
  Moments moments;

  bool has_rows() const { return moments.rows() == 0 || temperatures.rows() == moments.rows(); }
};

/// Rows and moments of a batch under `reference`. Throws Error on values that are not finite. Allocates copies.
inline Observations observe(const Batch& batch, TemperatureReference reference = TemperatureReference::rise) {
  Observations result{batch.name, model_temperatures(batch, reference), batch.errors.values, {}};
  result.moments = Moments(result.temperatures, result.errors);
  return result;
}

/// observe() for every batch, in order.
inline std::vector<Observations> observe(const Campaign& campaign,
                                         TemperatureReference reference = TemperatureReference::rise) {
  std::vector<Observations> result;
  for (const Batch& batch : campaign) result.push_back(observe(batch, reference));
  return result;
}

/// All of them as one, in their order; rows are kept when every batch has them.
inline Observations merged(const std::vector<Observations>& batches) {
  Observations all;
  bool rows = true;
  for (const Observations& batch : batches) {
    all.moments.merge(batch.moments);
    rows = rows && batch.has_rows();
  }
  if (!rows || all.moments.rows() == 0) return all;
  all.temperatures.resize(all.moments.rows(), all.moments.temperatures());
  all.errors.resize(all.moments.rows(), all.moments.errors());
  Index first = 0;
  for (const Observations& batch : batches) {
    all.temperatures.middleRows(first, batch.moments.rows()) = batch.temperatures;
    all.errors.middleRows(first, batch.moments.rows()) = batch.errors;
    first += batch.moments.rows();
  }
  return all;
}

/// The moments alone, in order.
inline std::vector<Moments> moments_of(const std::vector<Observations>& batches) {
  std::vector<Moments> result;
  for (const Observations& batch : batches) result.push_back(batch.moments);
  return result;
}

}  // namespace thermfit
