#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/error.hpp"
#include "thermfit/fit/transfer_choice.hpp"

namespace thermfit {

/// One error by the method `transfer`.
template <typename Scalar = double>
struct TransferFit {
  TransferPenalties<Scalar> penalties;        ///< as chosen or given
  TransferCoefficients<Scalar> coefficients;  ///< in um and K
  ClimateRange<Scalar> climate;               ///< of the batches fitted
};

/// Error `error` from several batches so that the model transfers to the next one:
/// `z = a + sum_j b_j R_j + sum_j c_j x_j + (clip(m) - mean m) sum_j g_j R_j`, R_j the rise of point j, x_j the same
/// through a first-order lag, m the mean temperature at the start of the batch, clipped to the range of these batches.
///
/// Known inputs u and differences add their changes, the inputs' lags and the differences, where the batches hold them.
/// Block ridge (block_ridge) with a penalty for each block; penalties and lag are those with the least error on
/// batches left out, so that a block that does not pay vanishes. Every batch counts alike, whatever its rows, and the
/// order of batches makes no difference. Batches must agree in points, lags and errors. Fewer than two: Error.
/// Allocates.
template <typename Scalar>
TransferFit<Scalar> fit_transfer(const std::vector<const TransferBatch<Scalar>*>& batches, Index error,
                                 const TransferOptions& options = {}) {
  if (batches.size() < 2)
    throw Error("batches", std::to_string(batches.size()), "2 or more to choose penalties by leaving one out");
  TransferFit<Scalar> fit;
  fit.penalties = detail::TransferChoice<Scalar>(batches, error, options).choose();
  fit.climate = climate_range(batches);
  fit.coefficients = TransferSystem<Scalar>(batches, fit.penalties.lag_index, fit.climate.mean)
                         .solve(error, fit.penalties, fit.climate.mean, options.intercept);
  return fit;
}

/// The same from all of `batches`.
template <typename Scalar>
TransferFit<Scalar> fit_transfer(const std::vector<TransferBatch<Scalar>>& batches, Index error,
                                 const TransferOptions& options = {}) {
  std::vector<const TransferBatch<Scalar>*> all;
  for (const TransferBatch<Scalar>& batch : batches) all.push_back(&batch);
  return fit_transfer(all, error, options);
}

/// What a fit leaves of its error in a batch.
template <typename Scalar>
Residuals<Scalar> residuals(const TransferFit<Scalar>& fit, const TransferBatch<Scalar>& batch, Index error) {
  return residuals(fit.coefficients, batch, fit.penalties.lag_index, fit.climate.factor(batch.climate_degC), error);
}

/// Root mean square over `batch` of how much further a fit would predict, um, were the climate's part to go on beyond
/// the climates it was fitted in as within them; 0 within. That much clipping the climate withholds.
template <typename Scalar>
Scalar withheld_by_climate_um(const TransferFit<Scalar>& fit, const TransferBatch<Scalar>& batch) {
  const VectorX<Scalar>& g = fit.coefficients.climate;
  const MatrixX<Scalar>& products = batch.products[fit.penalties.lag_index];
  const Scalar square = g.dot(products.topLeftCorner(g.size(), g.size()) * g);
  return fit.climate.beyond_K(batch.climate_degC) * std::sqrt(std::max(Scalar(0), square));
}

THERMFIT_COMPILED_TEMPLATE(TransferFit<double> fit_transfer<double>(const std::vector<const TransferBatch<double>*>&,
                                                                    Index, const TransferOptions&));

}  // namespace thermfit
