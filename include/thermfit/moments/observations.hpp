#pragma once

#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/moments/moments.hpp"

namespace thermfit {

/// One batch as fits and selection rules see it: its moments, and its rows where a rule or a check needs them.
template <typename Scalar = double>
struct Observations {
  std::string name;              ///< of the batch
  MatrixX<Scalar> temperatures;  ///< rows x points, K of rise or degC; empty when only moments were kept
  MatrixX<Scalar> errors;        ///< rows x responses, um
  Moments<Scalar> moments;       ///< of all its rows

  /// Whether the rows are kept, not only their moments.
  bool has_rows() const { return moments.rows() == 0 || temperatures.rows() == moments.rows(); }
};

/// Rows and moments of temperatures (rows x points, K of rise or degC) and errors (rows x responses, um) under a name.
/// Throws Error on values that are not finite. Allocates copies.
template <typename Temperatures, typename Errors>
Observations<typename Temperatures::Scalar> observe(const Eigen::MatrixBase<Temperatures>& temperatures,
                                                    const Eigen::MatrixBase<Errors>& errors, std::string name = {}) {
  Observations<typename Temperatures::Scalar> result{std::move(name), temperatures, errors, {}};
  result.moments = Moments(result.temperatures, result.errors);
  return result;
}

/// Rows and moments of a batch under `reference`. Throws Error on values that are not finite. Allocates copies.
template <typename Scalar = double>
Observations<Scalar> observe(const Batch& batch, TemperatureReference reference = TemperatureReference::rise) {
  return observe(model_temperatures<Scalar>(batch, reference),
                 detail::lazy<Scalar>(batch.errors.values).template cast<Scalar>(), batch.name);
}

/// observe() for every batch, in order.
template <typename Scalar = double>
std::vector<Observations<Scalar>> observe(const Campaign& campaign,
                                          TemperatureReference reference = TemperatureReference::rise) {
  std::vector<Observations<Scalar>> result;
  for (const Batch& batch : campaign) result.push_back(observe<Scalar>(batch, reference));
  return result;
}

/// All of them as one, in their order; rows are kept when every batch has them. Widths must agree, or Error.
/// Allocates copies.
template <typename Scalar>
Observations<Scalar> merged(const std::vector<Observations<Scalar>>& batches) {
  Observations<Scalar> all;
  bool rows = true;
  for (const Observations<Scalar>& batch : batches) {
    all.moments.merge(batch.moments);
    rows = rows && batch.has_rows();
  }
  if (!rows || all.moments.rows() == 0) return all;
  all.temperatures.resize(all.moments.rows(), all.moments.temperatures());
  all.errors.resize(all.moments.rows(), all.moments.errors());
  Index first = 0;
  for (const Observations<Scalar>& batch : batches) {
    all.temperatures.middleRows(first, batch.moments.rows()) = batch.temperatures;
    all.errors.middleRows(first, batch.moments.rows()) = batch.errors;
    first += batch.moments.rows();
  }
  return all;
}

/// The moments alone, in order. Allocates copies.
template <typename Scalar>
std::vector<Moments<Scalar>> moments_of(const std::vector<Observations<Scalar>>& batches) {
  std::vector<Moments<Scalar>> result;
  for (const Observations<Scalar>& batch : batches) result.push_back(batch.moments);
  return result;
}

}  // namespace thermfit
