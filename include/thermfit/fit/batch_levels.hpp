#pragma once

#include <limits>
#include <vector>

#include "thermfit/fit/impl/spectrum.hpp"

namespace thermfit {

/// Variances of each error over several batches, um^2: how much of it lies between batches, and what the temperatures
/// say of that.
template <typename Scalar = double>
struct BatchLevels {
  VectorX<Scalar> total;   ///< about the mean of all rows
  VectorX<Scalar> common;  ///< left by the temperatures, one intercept for all batches
  VectorX<Scalar> own;     ///< left by the temperatures, an intercept for each batch

  /// Share of an error that the levels of the batches explain and the temperatures do not; NaN where nothing is left to
  /// tell by.
  Scalar share(Index error) const { return (common(error) - own(error)) / total(error); }
};

namespace detail {

/// Variance per error, and what the temperatures leave of it by least squares; each with its degrees of freedom. Nearly
/// dependent temperatures do no harm: no coefficient is asked for. NaN where no degree of freedom is left.
template <typename Scalar>
void variances(const Moments<Scalar>& moments, VectorX<Scalar>& total, VectorX<Scalar>& left) {
  const StandardisedMoments<Scalar> data(moments, Scaling::both);
  const Spectrum<Scalar> temperatures = spectrum(data);
  const VectorX<Scalar> explained =
      (temperatures.slopes.cwiseAbs2().transpose() * temperatures.variance).cwiseMin(data.yy);
  const Scalar freedom = static_cast<Scalar>(moments.rows() - 1 - temperatures.rank());
  total = data.yy.cwiseProduct(data.channels.error_scale.cwiseAbs2());
  left = (data.yy - explained).cwiseProduct(data.channels.error_scale.cwiseAbs2());
  if (freedom > 0)
    left *= static_cast<Scalar>(moments.rows() - 1) / freedom;
  else
    left.setConstant(std::numeric_limits<Scalar>::quiet_NaN());
}

}  // namespace detail

/// Levels of `batches`, about no own means (ErrorReference::recorded or start). Analysis of covariance from moments:
/// the same least squares with and without the term between batches. Fewer than two rows: Error. Allocates.
template <typename Scalar>
BatchLevels<Scalar> batch_levels(const std::vector<Moments<Scalar>>& batches) {
  BatchLevels<Scalar> levels;
  detail::variances(merged(batches), levels.total, levels.common);
  std::vector<Moments<Scalar>> about_own;
  for (const Moments<Scalar>& batch : batches) about_own.push_back(batch.about_own_mean());
  VectorX<Scalar> within;
  detail::variances(merged(about_own), within, levels.own);
  return levels;
}

THERMFIT_COMPILED_TEMPLATE(BatchLevels<double> batch_levels<double>(const std::vector<Moments<double>>&));

}  // namespace thermfit
