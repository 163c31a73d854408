#pragma once

#include "thermfit/fit/spectrum.hpp"

namespace thermfit {

namespace detail {

template <class Standardised>
LinearFit fit_mlr(const Standardised& data) {
  const Spectrum temperatures = spectrum(data);
  temperatures.require_resolved(temperatures.rank() - 1);
  return linear_fit(data, temperatures.directions * temperatures.slopes, temperatures,
                    static_cast<double>(temperatures.rank()));
}

}  // namespace detail

/// Multiple linear regression (least squares with intercept) from moments.
///
/// Channels are standardised, which changes nothing but the rounding. Dependent temperatures (constant, duplicated,
/// sums of others) lower the reported rank, and of the many least-squares solutions the one with the smallest
/// standardised coefficients is returned. Errors: fewer than two rows; condition number past moments_condition_limit.
inline LinearFit fit_mlr(const Moments& moments) {
  return detail::fit_mlr(StandardisedMoments(moments, Scaling::both));
}

/// The same over several batches: from their merged moments.
inline LinearFit fit_mlr(const std::vector<Moments>& batches) { return fit_mlr(merged(batches)); }

/// The same row-wise (QR, then SVD): for condition numbers up to about 1e13. Temperatures rows x points, errors
/// rows x responses, um.
inline LinearFit fit_mlr(const Matrix& temperatures, const Matrix& errors) {
  return detail::fit_mlr(StandardisedRows(temperatures, errors, Scaling::both));
}

}  // namespace thermfit
