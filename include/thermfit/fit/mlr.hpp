#pragma once

#include <vector>

#include "thermfit/fit/impl/spectrum.hpp"

namespace thermfit {

namespace detail {

template <class Standardised, typename Scalar = typename Standardised::Scalar>
LinearFit<Scalar> fit_mlr(const Standardised& data) {
  const Spectrum<Scalar> temperatures = spectrum(data);
  temperatures.require_resolved(temperatures.rank() - 1);
  return linear_fit(data, MatrixX<Scalar>(temperatures.directions * temperatures.slopes), temperatures,
                    static_cast<Scalar>(temperatures.rank()));
}

template <typename Scalar>
LinearFit<Scalar> mlr_of_rows(const MatrixView<Scalar>& temperatures, const MatrixView<Scalar>& errors) {
  return fit_mlr(StandardisedRows<Scalar>(temperatures, errors, Scaling::both));
}

}  // namespace detail

/// Multiple linear regression (least squares with intercept) from moments.
///
/// Channels are standardised, which changes nothing but the rounding. Dependent temperatures (constant, duplicated,
/// sums of others) lower the reported rank, and of the many least-squares solutions the one with the smallest
/// standardised coefficients is returned. Errors: fewer than two rows; condition number past moments_condition_limit.
/// Allocates.
template <typename Scalar>
LinearFit<Scalar> fit_mlr(const Moments<Scalar>& moments) {
  return detail::fit_mlr(detail::StandardisedMoments<Scalar>(moments, Scaling::both));
}

/// The same over several batches: from their merged moments.
template <typename Scalar>
LinearFit<Scalar> fit_mlr(const std::vector<Moments<Scalar>>& batches) {
  return fit_mlr(merged(batches));
}

/// The same row-wise (QR, then SVD): for condition numbers up to about 1e13 in double, 1e5 in float. Temperatures rows
/// x points, errors rows x responses, um. Allocates copies.
template <typename Temperatures, typename Errors, typename Scalar = typename Temperatures::Scalar>
LinearFit<Scalar> fit_mlr(const Eigen::MatrixBase<Temperatures>& temperatures,
                          const Eigen::MatrixBase<Errors>& errors) {
  return detail::mlr_of_rows<Scalar>(temperatures, errors);
}

THERMFIT_COMPILED_TEMPLATE(LinearFit<double> fit_mlr<double>(const Moments<double>&));
namespace detail {
THERMFIT_COMPILED_TEMPLATE(LinearFit<double> mlr_of_rows<double>(const MatrixView<double>&, const MatrixView<double>&));
}  // namespace detail

}  // namespace thermfit
