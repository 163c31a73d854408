#pragma once

#include <cmath>
#include <limits>

#include "thermfit/fit/left_out.hpp"
#include "thermfit/fit/spectrum.hpp"

namespace thermfit {

/// Penalties tried when none is given: 0, then 1e-6 to 10 in half decades.
inline std::vector<double> ridge_grid() {
  std::vector<double> grid{0};
  for (int half_decade = -12; half_decade <= 2; ++half_decade) grid.push_back(std::pow(10.0, half_decade / 2.0));
  return grid;
}

namespace detail {

inline Matrix ridge_coefficients(const Spectrum& temperatures, double lambda) {
  const Vector kept = temperatures.variance.array() / (temperatures.variance.array() + lambda);
  return temperatures.directions * (kept.asDiagonal() * temperatures.slopes);
}

template <class Standardised>
LinearFit fit_ridge(const Standardised& data, const FitOptions& options) {
  const double lambda = options.ridge_lambda.value_or(-1);
  if (!options.ridge_lambda) {
    throw Error("ridge", "no penalty", "a number of 0 or more, or several batches to choose it by");
  }
  if (!(lambda >= 0) || !std::isfinite(lambda)) throw Error("ridge", "a negative or infinite penalty", "0 or more");
  const Spectrum temperatures = spectrum(data);
  temperatures.require_resolved(temperatures.rank() - 1, lambda);
  const double parameters = (temperatures.variance.array() / (temperatures.variance.array() + lambda)).sum();
  LinearFit fit = linear_fit(data, ridge_coefficients(temperatures, lambda), temperatures, parameters);
  fit.ridge_lambda = lambda;
  return fit;
}

}  // namespace detail

/// Ridge regression from moments: standardised coefficients `b = (R_xx + lambda I)^-1 r_xy` with correlations R
/// (Hoerl and Kennard, Technometrics 12, 1970), so that lambda has no unit and does not depend on the number of rows;
/// other packages' penalty on the sum of squares is lambda (n - 1). The intercept is not penalised. Errors: as
/// fit_mlr; no penalty in the options.
inline LinearFit fit_ridge(const Moments& moments, const FitOptions& options) {
  return detail::fit_ridge(StandardisedMoments(moments, options.scaling), options);
}

/// The same row-wise (QR, then SVD).
inline LinearFit fit_ridge(const Matrix& temperatures, const Matrix& errors, const FitOptions& options) {
  return detail::fit_ridge(StandardisedRows(temperatures, errors, options.scaling), options);
}

/// One fit over several batches; without a penalty in the options, the one of ridge_grid() with the least error on
/// batches left out (left_out_error) is used, the larger on a tie.
inline LinearFit fit_ridge(const std::vector<Moments>& batches, FitOptions options = {}) {
  if (!options.ridge_lambda) {
    std::vector<double> grid = ridge_grid();
    std::reverse(grid.begin(), grid.end());
    const Vector error = left_out_error(batches, [&](const Moments& others) {
      const StandardisedMoments data(others, options.scaling);
      const Spectrum temperatures = spectrum(data);
      std::vector<LinearModel<>> models;
      for (const double lambda : grid)
        models.push_back(data.channels.undo(detail::ridge_coefficients(temperatures, lambda)));
      return models;
    });
    Index best = 0;
    error.minCoeff(&best);
    options.ridge_lambda = grid[static_cast<std::size_t>(best)];
  }
  return fit_ridge(merged(batches), options);
}

}  // namespace thermfit
