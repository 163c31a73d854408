#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "thermfit/calibration/map_fit.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/statistics/random.hpp"

namespace thermfit {

/// How well the data know one parameter.
struct Identified {
  double sd = 1;           ///< posterior, in prior standard deviations
  Index trades_with = -1;  ///< the parameter it is most correlated with, where that is above 0.9 either way
  double correlation = 0;  ///< with it
  bool at_bound = false;   ///< it would go further if it were allowed
  bool pinned() const { return sd < 0.8; }  ///< the data say more about it than was known before
};

/// Posterior standard deviations and correlations from the information of the data and the unit prior.
/// By parameter. Allocates.
template <typename Scalar = double>
std::vector<Identified> identified(const MapFit& fit) {
  const Index n = fit.coordinates.size();
  const MatrixX<Scalar> covariance = fit.covariance<Scalar>();
  std::vector<Identified> result(static_cast<std::size_t>(n));
  for (Index j = 0; j < n; ++j) {
    Identified& one = result[static_cast<std::size_t>(j)];
    one.sd = std::sqrt(covariance(j, j));
    for (Index i = 0; i < n; ++i) {
      const double correlation = covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
      if (i == j || std::abs(correlation) <= std::max(0.9, std::abs(one.correlation))) continue;
      one.trades_with = i;
      one.correlation = correlation;
    }
    const auto [low, high] = detail::coordinate_range(fit.parameter(j));
    one.at_bound = fit.coordinates(j) <= low + 1e-9 || fit.coordinates(j) >= high - 1e-9;
  }
  return result;
}

/// How calibrate() searches.
struct CalibrationOptions {
  int starts = 3;            ///< the prior's means, then points drawn around them
  std::uint64_t seed = 1;    ///< of the points drawn
  double spread = 0.7;       ///< their distance from the means, in prior standard deviations
  int most_iterations = 50;  ///< of each start
};

/// The best of several fits, and whether the others found the same.
struct Calibration {
  MapFit fit;                                  ///< the start with the largest log posterior
  std::vector<Identified> identified;          ///< by parameter
  std::vector<double> log_posteriors;          ///< by start
  int agreeing = 0;                            ///< starts that ended within one nat of the best
  std::vector<SeriesByBatch> residual_before;  ///< of the machine as it was given, by channel
};

/// Fits all parameters of `machine` to a campaign, from several starts. Throws Error as observations_of() and
/// simulate() do; that the data do not know a parameter is part of the result. Allocates.
template <typename Scalar = double>
Calibration calibrate(const MachineRecord& seen, const ThermalNetwork& machine, const EffectLibrary& library,
                      const CalibrationOptions& options = {}) {
  Calibration best;
  const ThermalNetwork complete = with_complete_effects(machine, library);
  best.residual_before = residuals_of<Scalar>(seen, simulate<Scalar>(complete, seen.excitations, library));
  MapFitOptions how;
  how.most_iterations = options.most_iterations;
  how.tolerance = 0.01;
  std::uint64_t state = options.seed;
  for (int start = 0; start < std::max(1, options.starts); ++start) {
    if (start > 0) {
      how.start.resize(best.fit.coordinates.size());
      for (Index j = 0; j < how.start.size(); ++j) how.start(j) = options.spread * symmetric_uniform(state);
    }
    MapFit fit = map_fit<Scalar>(seen, complete, library, how);
    best.log_posteriors.push_back(fit.log_posterior);
    if (start == 0 || fit.log_posterior > best.fit.log_posterior) best.fit = std::move(fit);
  }
  for (const double one : best.log_posteriors) best.agreeing += one > best.fit.log_posterior - 1;
  best.identified = identified<Scalar>(best.fit);
  return best;
}

THERMFIT_COMPILED_TEMPLATE(Calibration calibrate<double>(const MachineRecord&, const ThermalNetwork&,
                                                         const EffectLibrary&, const CalibrationOptions&));

}  // namespace thermfit
