#pragma once

#include "thermfit/fit/latent_path.hpp"

namespace thermfit {

namespace detail {

struct ExtractPcr {
  template <class Standardised>
  ScoredLatentVariables operator()(const Standardised& data, const ComponentRule& rule) const {
    const Spectrum temperatures = spectrum(data);
    const double total = temperatures.variance.sum();
    const Stop stop{rule};
    const Index most = stop.most(temperatures.rank());
    Vector explained(most);
    Index taken = 0;
    for (; taken < most && !stop.enough(explained, taken); ++taken) {
      const double gain = temperatures.variance(taken) / total;
      if (stop.too_little(gain, taken)) break;
      if (stop.refuses()) temperatures.require_resolved(taken);
      explained(taken) = gain + (taken > 0 ? explained(taken - 1) : 0);
    }
    ScoredLatentVariables found;
    Vector sign(taken);
    for (Index a = 0; a < taken; ++a) sign(a) = sign_of_largest(temperatures.directions.col(a));
    found.weights = temperatures.directions.leftCols(taken) * sign.asDiagonal();
    found.loadings = found.rotations = found.weights;
    found.error_loadings = temperatures.slopes.topRows(taken).transpose() * sign.asDiagonal();
    found.score_variance = temperatures.variance.head(taken);
    complete(found, total, data.error_variance());
    return found;
  }
};

}  // namespace detail

/// Principal component regression from moments: scores on the leading eigenvectors of the temperatures' correlation
/// matrix, then least squares on the scores. Components stop by `options.components` (which looks at temperatures
/// only) and at the rank; the largest weight is positive. Errors as for fit_pls.
inline LinearFit fit_pcr(const Moments& moments, const FitOptions& options = {}) {
  return detail::fit_latent(StandardisedMoments(moments, options.scaling), options.components, detail::ExtractPcr{});
}

/// The same row-wise (QR, then SVD). Temperatures rows x points, errors rows x responses, um.
inline LinearFit fit_pcr(const Matrix& temperatures, const Matrix& errors, const FitOptions& options = {}) {
  return detail::fit_latent(StandardisedRows(temperatures, errors, options.scaling), options.components,
                            detail::ExtractPcr{});
}

/// One fit over several batches, from their merged moments; the number of components may be chosen by them.
inline LinearFit fit_pcr(const std::vector<Moments>& batches, const FitOptions& options = {}) {
  return detail::fit_latent(batches, options, detail::ExtractPcr{});
}

/// Models with 1, 2, … components, as pls_path.
inline std::vector<LinearModel<>> pcr_path(const Moments& moments, const FitOptions& options = {}) {
  return detail::latent_path(moments, options, detail::ExtractPcr{});
}

}  // namespace thermfit
