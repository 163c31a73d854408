#pragma once

#include "thermfit/fit/mlr.hpp"

namespace thermfit {

/// The penalty of Hoerl, Kennard and Baldwin (Communications in Statistics 4, 1975) for one batch, where none can be
/// chosen by leaving batches out: `lambda = p s^2 / b'b` with the least-squares b and residual variance s^2 in
/// correlation form, averaged over the errors. 0 where least squares leaves nothing. Errors as fit_mlr. Allocates.
template <typename Scalar>
Scalar hoerl_kennard_baldwin(const Moments<Scalar>& moments) {
  const LinearFit<Scalar> least_squares = fit_mlr(moments);
  Scalar sum = 0;
  for (Index e = 0; e < moments.errors(); ++e) {
    const Scalar total = moments.error_products()(e, e);
    const Scalar coefficients = least_squares.standardised_coefficients.col(e).squaredNorm();
    if (!(total > 0) || !(coefficients > 0) || !(least_squares.degrees_of_freedom > 0)) continue;
    const Scalar deviation = least_squares.residual_deviation_um(e);
    const Scalar unexplained = deviation * deviation * static_cast<Scalar>(moments.rows() - 1) / total;
    sum += static_cast<Scalar>(moments.temperatures()) * unexplained / least_squares.degrees_of_freedom / coefficients;
  }
  return sum / static_cast<Scalar>(moments.errors());
}

}  // namespace thermfit
