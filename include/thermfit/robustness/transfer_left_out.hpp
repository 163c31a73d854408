#pragma once

#include <string>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/error.hpp"
#include "thermfit/fit/transfer.hpp"
#include "thermfit/robustness/robustness.hpp"
#include "thermfit/statistics/parallel.hpp"

namespace thermfit {

/// Every batch predicted by the method `transfer` from all the others.
template <typename Scalar = double>
struct TransferLeftOut {
  std::vector<std::vector<TransferFit<Scalar>>> fits;     ///< per batch, per error: fitted and chosen without it
  std::vector<std::vector<Residuals<Scalar>>> residuals;  ///< per batch, per error: on it
  std::vector<Scalar> beyond_K;                  ///< per batch: how far it starts beyond the climates of the others
  std::vector<std::vector<Scalar>> withheld_um;  ///< per batch, per error: root mean square of what the climate's part
                                                 ///< would add if it went on there (withheld_by_climate_um)

  /// S_mean and S_std of one error over the batches, um.
  MeanAndStd<Scalar> figure(std::size_t error) const { return figure_of(residuals, error); }
};

/// Leaves every batch out once. A batch takes no part in the choice of what predicts it. On `threads` threads (0: all
/// cores), which change no digit. Fewer than three batches: Error. Allocates.
template <typename Scalar>
TransferLeftOut<Scalar> transfer_left_out(const std::vector<TransferBatch<Scalar>>& batches, Index errors,
                                          const TransferOptions& options = {}, unsigned threads = 0) {
  if (batches.size() < 3)
    throw Error("batches", std::to_string(batches.size()),
                "3 or more, to leave one out and choose penalties by leaving out one of the others");
  TransferLeftOut<Scalar> result;
  result.fits.resize(batches.size());
  result.residuals.resize(batches.size());
  result.beyond_K.resize(batches.size());
  result.withheld_um.resize(batches.size());
  in_parallel(batches.size(), threads, [&](std::size_t out) {
    std::vector<const TransferBatch<Scalar>*> others;
    for (std::size_t b = 0; b < batches.size(); ++b)
      if (b != out) others.push_back(&batches[b]);
    result.beyond_K[out] = climate_range(others).beyond_K(batches[out].climate_degC);
    for (Index error = 0; error < errors; ++error) {
      result.fits[out].push_back(fit_transfer(others, error, options));
      result.residuals[out].push_back(residuals(result.fits[out].back(), batches[out], error));
      result.withheld_um[out].push_back(withheld_by_climate_um(result.fits[out].back(), batches[out]));
    }
  });
  return result;
}

THERMFIT_COMPILED_TEMPLATE(TransferLeftOut<double> transfer_left_out<double>(const std::vector<TransferBatch<double>>&,
                                                                             Index, const TransferOptions&, unsigned));

}  // namespace thermfit
