#pragma once

#include "thermfit/fit/mlr.hpp"

namespace thermfit {

/// The penalty of Hoerl, Kennard and Baldwin (Communications in Statistics 4, 1975) for one batch, where none can be
/// chosen by leaving batches out: `lambda = p s^2 / b'b` with the least-squares b and residual variance s^2 in
/// correlation form, averaged over the errors. 0 where least squares leaves nothing. Errors as fit_mlr.
inline double hoerl_kennard_baldwin(const Moments& moments) {
  const LinearFit least_squares = fit_mlr(moments);
  double sum = 0;
  for (Index e = 0; e < moments.errors(); ++e) {
    const double total = moments.error_products()(e, e);
    const double coefficients = least_squares.standardised_coefficients.col(e).squaredNorm();
    if (!(total > 0) || !(coefficients > 0) || !(least_squares.degrees_of_freedom > 0)) continue;
    const double deviation = least_squares.residual_deviation_um(e);
    const double unexplained = deviation * deviation * static_cast<double>(moments.rows() - 1) / total;
    sum += static_cast<double>(moments.temperatures()) * unexplained / least_squares.degrees_of_freedom / coefficients;
  }
  return sum / static_cast<double>(moments.errors());
}

}  // namespace thermfit
