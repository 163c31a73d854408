#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/fit/impl/spectrum.hpp"
#include "thermfit/fit/left_out.hpp"

namespace thermfit {

/// Penalties tried when none is given: 0, then 1e-6 to 10 in half decades.
inline std::vector<double> ridge_grid() {
  std::vector<double> grid{0};
  for (int half_decade = -12; half_decade <= 2; ++half_decade) grid.push_back(std::pow(10.0, half_decade / 2.0));
  return grid;
}

namespace detail {

template <typename Scalar>
MatrixX<Scalar> ridge_coefficients(const Spectrum<Scalar>& temperatures, Scalar lambda) {
  const VectorX<Scalar> kept = temperatures.variance.array() / (temperatures.variance.array() + lambda);
  return temperatures.directions * (kept.asDiagonal() * temperatures.slopes);
}

template <class Standardised, typename Scalar = typename Standardised::Scalar>
LinearFit<Scalar> fit_ridge(const Standardised& data, const FitOptions& options) {
  const Scalar lambda = static_cast<Scalar>(options.ridge_lambda.value_or(-1));
  if (!options.ridge_lambda) {
    throw Error("ridge", "no penalty", "a number of 0 or more, or several batches to choose it by");
  }
  if (!(lambda >= 0) || !std::isfinite(lambda)) throw Error("ridge", "a negative or infinite penalty", "0 or more");
  const Spectrum<Scalar> temperatures = spectrum(data);
  temperatures.require_resolved(temperatures.rank() - 1, lambda);
  const Scalar parameters = (temperatures.variance.array() / (temperatures.variance.array() + lambda)).sum();
  LinearFit<Scalar> fit = linear_fit(data, ridge_coefficients(temperatures, lambda), temperatures, parameters);
  fit.ridge_lambda = *options.ridge_lambda;
  return fit;
}

/// The penalty of ridge_grid() with the least error on batches left out, the larger on a tie.
template <typename Scalar>
double chosen_penalty(const std::vector<Moments<Scalar>>& batches, Scaling scaling) {
  std::vector<double> grid = ridge_grid();
  std::reverse(grid.begin(), grid.end());
  const VectorX<Scalar> error = left_out_error(batches, [&](const Moments<Scalar>& others) {
    const StandardisedMoments<Scalar> data(others, scaling);
    const Spectrum<Scalar> temperatures = spectrum(data);
    std::vector<LinearModel<Scalar>> models;
    for (const double lambda : grid)
      models.push_back(data.channels.undo(ridge_coefficients(temperatures, static_cast<Scalar>(lambda))));
    return models;
  });
  Index best = 0;
  error.minCoeff(&best);
  return grid[static_cast<std::size_t>(best)];
}

template <typename Scalar>
LinearFit<Scalar> ridge_of_rows(const MatrixView<Scalar>& temperatures, const MatrixView<Scalar>& errors,
                                const FitOptions& options) {
  return fit_ridge(StandardisedRows<Scalar>(temperatures, errors, options.scaling), options);
}

}  // namespace detail

/// Ridge regression from moments: standardised coefficients `b = (R_xx + lambda I)^-1 r_xy` with correlations R
/// (Hoerl and Kennard, Technometrics 12, 1970), so that lambda has no unit and does not depend on the number of rows;
/// other packages' penalty on the sum of squares is lambda (n - 1). The intercept is not penalised. Errors: as
/// fit_mlr; no penalty in the options. Allocates.
template <typename Scalar>
LinearFit<Scalar> fit_ridge(const Moments<Scalar>& moments, const FitOptions& options) {
  return detail::fit_ridge(detail::StandardisedMoments<Scalar>(moments, options.scaling), options);
}

/// The same row-wise (QR, then SVD). Temperatures rows x points, errors rows x responses, um. Allocates copies.
template <typename Temperatures, typename Errors, typename Scalar = typename Temperatures::Scalar>
LinearFit<Scalar> fit_ridge(const Eigen::MatrixBase<Temperatures>& temperatures,
                            const Eigen::MatrixBase<Errors>& errors, const FitOptions& options) {
  return detail::ridge_of_rows<Scalar>(temperatures, errors, options);
}

/// One fit over several batches; without a penalty in the options, the one of ridge_grid() with the least error on
/// batches left out (left_out_error) is used, the larger on a tie.
template <typename Scalar>
LinearFit<Scalar> fit_ridge(const std::vector<Moments<Scalar>>& batches, FitOptions options = {}) {
  if (!options.ridge_lambda) options.ridge_lambda = detail::chosen_penalty(batches, options.scaling);
  return fit_ridge(merged(batches), options);
}

THERMFIT_COMPILED_TEMPLATE(LinearFit<double> fit_ridge<double>(const Moments<double>&, const FitOptions&));
THERMFIT_COMPILED_TEMPLATE(LinearFit<double> fit_ridge<double>(const std::vector<Moments<double>>&, FitOptions));
namespace detail {
THERMFIT_COMPILED_TEMPLATE(LinearFit<double> ridge_of_rows<double>(const MatrixView<double>&, const MatrixView<double>&,
                                                                   const FitOptions&));
}  // namespace detail

}  // namespace thermfit
