#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "thermfit/robustness/cross_batch.hpp"

namespace thermfit {

/// Every batch predicted by a model of all the others.
template <typename Scalar = double>
struct LeftOut {
  /// A member of Residuals, such as `&Residuals<>::rmse`.
  using Figure = Scalar (Residuals<Scalar>::*)() const;

  std::vector<LinearFit<Scalar>> fits;                    ///< per batch: fitted without it
  std::vector<std::vector<Residuals<Scalar>>> residuals;  ///< per batch, per error: on it

  /// Mean over batches of a figure of one error, e.g. `mean(0, &Residuals<>::rmse)`.
  Scalar mean(std::size_t error, Figure figure) const {
    Scalar sum = 0;
    for (const auto& batch : residuals) sum += (batch[error].*figure)();
    return residuals.empty() ? 0 : sum / static_cast<Scalar>(residuals.size());
  }

  /// The batch with the largest figure, the first of equals.
  std::size_t worst(std::size_t error, Figure figure) const {
    std::size_t worst = 0;
    for (std::size_t b = 1; b < residuals.size(); ++b) {
      if ((residuals[b][error].*figure)() > (residuals[worst][error].*figure)()) worst = b;
    }
    return worst;
  }

  /// All left-out rows together.
  Residuals<Scalar> pooled(std::size_t error) const {
    Residuals<Scalar> all;
    for (const auto& batch : residuals) all.add(batch[error]);
    return all;
  }
};

/// Leaves every batch out once; the rest is merged, not read again. `fitter` is called with the moments of the other
/// batches, std::vector<Moments<Scalar>>, if it takes that (to choose components or a penalty by them), else with their
/// merged Moments. Fewer than two batches: Error. Allocates.
template <typename Scalar, class Fitter>
LeftOut<Scalar> leave_one_batch_out(const std::vector<Moments<Scalar>>& batches, const Fitter& fitter) {
  constexpr bool takes_several =
      std::is_invocable_r_v<LinearFit<Scalar>, const Fitter&, const std::vector<Moments<Scalar>>&>;
  static_assert(takes_several || is_fitter<Fitter, Scalar>,
                "A fitter is called as fitter(const thermfit::Moments<Scalar>&), or with a std::vector of them, and "
                "returns thermfit::LinearFit<Scalar> or thermfit::LinearModel<Scalar>.");
  if (batches.size() < 2) throw Error("batches", std::to_string(batches.size()), "2 or more to leave one out");
  LeftOut<Scalar> result;
  std::vector<Moments<Scalar>> others;
  if constexpr (!takes_several) others = leave_one_out(batches);
  for (std::size_t i = 0; i < batches.size(); ++i) {
    if constexpr (takes_several) {
      std::vector<Moments<Scalar>> rest = batches;
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
