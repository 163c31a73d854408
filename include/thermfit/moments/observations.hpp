#pragma once

#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/batch/error_reference.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/lazy.hpp"
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
  bool has_rows() const { return moments.rows() == 0 || temperatures.rows() >= moments.rows(); }
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

namespace detail {

/// Of a batch whose errors are referenced() already.
template <typename Scalar>
Observations<Scalar> observe_about(const Batch& batch, ErrorReference error_reference) {
  MatrixX<Scalar> temperatures = model_temperatures<Scalar>(batch, TemperatureReference::rise);
  const bool own_mean = error_reference == ErrorReference::batch;
  if (own_mean && temperatures.rows() > 0) {
    const VectorX<Scalar> mean = temperatures.colwise().mean().transpose();
    temperatures.rowwise() -= mean.transpose();
  }
  Observations<Scalar> seen =
      observe(temperatures, detail::lazy<Scalar>(batch.errors.values).template cast<Scalar>(), batch.name);
  if (own_mean) seen.moments = seen.moments.about_own_mean();
  return seen;
}

}  // namespace detail

/// Rows and moments of a batch under `reference`, errors as `error_reference` counts them (referenced()). With
/// ErrorReference::batch temperatures and errors are both taken about their mean over the batch. Throws Error on values
/// that are not finite, and on a rise without a first reading. Allocates copies.
template <typename Scalar = double>
Observations<Scalar> observe(const Batch& batch, TemperatureReference reference = TemperatureReference::rise,
                             ErrorReference error_reference = ErrorReference::recorded) {
  require_alike(reference, error_reference);
  if (error_reference != ErrorReference::recorded)
    return detail::observe_about<Scalar>(referenced<Lazy<double, Scalar>>(batch, error_reference), error_reference);
  if (reference == TemperatureReference::rise) require_first_readings(batch, batch.temperatures.names);
  return observe(model_temperatures<Scalar>(batch, reference),
                 detail::lazy<Scalar>(batch.errors.values).template cast<Scalar>(), batch.name);
}

/// observe() for every batch, in order.
template <typename Scalar = double>
std::vector<Observations<Scalar>> observe(const Campaign& campaign,
                                          TemperatureReference reference = TemperatureReference::rise,
                                          ErrorReference error_reference = ErrorReference::recorded) {
  std::vector<Observations<Scalar>> result;
  for (const Batch& batch : campaign) result.push_back(observe<Scalar>(batch, reference, error_reference));
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
  Index first = 0;
  for (const Observations<Scalar>& batch : batches) first += batch.temperatures.rows();
  all.temperatures.resize(first, all.moments.temperatures());
  all.errors.resize(first, all.moments.errors());
  first = 0;
  for (const Observations<Scalar>& batch : batches) {
    all.temperatures.middleRows(first, batch.temperatures.rows()) = batch.temperatures;
    all.errors.middleRows(first, batch.temperatures.rows()) = batch.errors;
    first += batch.temperatures.rows();
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
