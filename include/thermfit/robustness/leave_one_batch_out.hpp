#pragma once

#include <algorithm>
#include <vector>

#include "thermfit/robustness/cross_batch.hpp"

namespace thermfit {

/// Every batch predicted by a model of all the others.
struct LeftOut {
  std::vector<LinearFit> fits;                    ///< per batch: fitted without it
  std::vector<std::vector<Residuals>> residuals;  ///< per batch, per error: on it

  /// Mean over batches of a figure of one error, e.g. `mean(0, &Residuals::rmse)`.
  double mean(std::size_t error, double (Residuals::*figure)() const) const {
    double sum = 0;
    for (const auto& batch : residuals) sum += (batch[error].*figure)();
    return residuals.empty() ? 0 : sum / static_cast<double>(residuals.size());
  }

  /// The batch with the largest figure, the first of equals.
  std::size_t worst(std::size_t error, double (Residuals::*figure)() const) const {
    std::size_t worst = 0;
    for (std::size_t b = 1; b < residuals.size(); ++b) {
      if ((residuals[b][error].*figure)() > (residuals[worst][error].*figure)()) worst = b;
    }
    return worst;
  }

  /// All left-out rows together.
  Residuals pooled(std::size_t error) const {
    Residuals all;
    for (const auto& batch : residuals) all.add(batch[error]);
    return all;
  }
};

/// Leaves every batch out once; the rest is merged, not read again. `fitter` is called with the moments of the other
/// batches, std::vector<Moments>, if it takes that (to choose components or a penalty by them), else with their merged
/// Moments. Fewer than two batches: Error.
template <class Fitter>
LeftOut leave_one_batch_out(const std::vector<Moments>& batches, const Fitter& fitter) {
  constexpr bool takes_several = std::is_invocable_r_v<LinearFit, const Fitter&, const std::vector<Moments>&>;
  static_assert(takes_several || is_fitter<Fitter>,
                "A fitter is called as fitter(const thermfit::Moments&), or with std::vector<thermfit::Moments>, and "
                "returns thermfit::LinearFit or thermfit::LinearModel<>.");
  if (batches.size() < 2) throw Error("batches", std::to_string(batches.size()), "2 or more to leave one out");
  LeftOut result;
  const std::vector<Moments> others = takes_several ? std::vector<Moments>{} : leave_one_out(batches);
  for (std::size_t i = 0; i < batches.size(); ++i) {
    if constexpr (takes_several) {
      std::vector<Moments> rest = batches;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      result.fits.push_back(fitter(rest));
    } else {
      result.fits.push_back(fit_of(fitter(others[i])));
    }
    result.residuals.push_back(residuals(result.fits.back().model, batches[i]));
  }
  return result;
}

}  // namespace thermfit
