#pragma once

#include <vector>

#include "thermfit/fit/impl/latent_path.hpp"

namespace thermfit {

namespace detail {

struct ExtractPcr {
  template <class Standardised, typename Scalar = typename Standardised::Scalar>
  ScoredLatentVariables<Scalar> operator()(const Standardised& data, const ComponentRule& rule) const {
    const Spectrum<Scalar> temperatures = spectrum(data);
    const Scalar total = temperatures.variance.sum();
    const Stop stop{rule};
    const Index most = stop.most(temperatures.rank());
    VectorX<Scalar> explained(most);
    Index taken = 0;
    for (; taken < most && !stop.enough(explained, taken); ++taken) {
      const Scalar gain = temperatures.variance(taken) / total;
      if (stop.too_little(gain, taken)) break;
      if (stop.refuses()) temperatures.require_resolved(taken);
      explained(taken) = gain + (taken > 0 ? explained(taken - 1) : 0);
    }
    ScoredLatentVariables<Scalar> found;
    VectorX<Scalar> sign(taken);
    for (Index a = 0; a < taken; ++a) sign(a) = sign_of_largest<Scalar>(temperatures.directions.col(a));
    found.weights = temperatures.directions.leftCols(taken) * sign.asDiagonal();
    found.loadings = found.rotations = found.weights;
    found.error_loadings = temperatures.slopes.topRows(taken).transpose() * sign.asDiagonal();
    found.score_variance = temperatures.variance.head(taken);
    complete(found, total, data.error_variance());
    return found;
  }
};

template <typename Scalar>
LinearFit<Scalar> pcr_of_rows(const MatrixView<Scalar>& temperatures, const MatrixView<Scalar>& errors,
                              const FitOptions& options) {
  return fit_latent(StandardisedRows<Scalar>(temperatures, errors, options.scaling), options.components, ExtractPcr{});
}

}  // namespace detail

/// Principal component regression from moments: scores on the leading eigenvectors of the temperatures' correlation
/// matrix, then least squares on the scores. Components stop by `options.components` (which looks at temperatures
/// only) and at the rank; the largest weight is positive. Errors as for fit_pls. Allocates.
template <typename Scalar>
LinearFit<Scalar> fit_pcr(const Moments<Scalar>& moments, const FitOptions& options = {}) {
  return detail::fit_latent(detail::StandardisedMoments<Scalar>(moments, options.scaling), options.components,
                            detail::ExtractPcr{});
}

/// The same row-wise (QR, then SVD). Temperatures rows x points, errors rows x responses, um. Allocates copies.
template <typename Temperatures, typename Errors, typename Scalar = typename Temperatures::Scalar>
LinearFit<Scalar> fit_pcr(const Eigen::MatrixBase<Temperatures>& temperatures, const Eigen::MatrixBase<Errors>& errors,
                          const FitOptions& options = {}) {
  return detail::pcr_of_rows<Scalar>(temperatures, errors, options);
}

/// One fit over several batches, from their merged moments; the number of components may be chosen by them.
template <typename Scalar>
LinearFit<Scalar> fit_pcr(const std::vector<Moments<Scalar>>& batches, const FitOptions& options = {}) {
  return detail::fit_latent(batches, options, detail::ExtractPcr{});
}

/// Models with 1, 2, … components, as pls_path.
template <typename Scalar>
std::vector<LinearModel<Scalar>> pcr_path(const Moments<Scalar>& moments, const FitOptions& options = {}) {
  return detail::latent_path(moments, options, detail::ExtractPcr{});
}

THERMFIT_COMPILED_TEMPLATE(std::vector<LinearModel<double>> pcr_path<double>(const Moments<double>&,
                                                                             const FitOptions&));
THERMFIT_COMPILED_TEMPLATE(LinearFit<double> fit_pcr<double>(const Moments<double>&, const FitOptions&));
THERMFIT_COMPILED_TEMPLATE(LinearFit<double> fit_pcr<double>(const std::vector<Moments<double>>&, const FitOptions&));
namespace detail {
THERMFIT_COMPILED_TEMPLATE(LinearFit<double> pcr_of_rows<double>(const MatrixView<double>&, const MatrixView<double>&,
                                                                 const FitOptions&));
}  // namespace detail

}  // namespace thermfit
