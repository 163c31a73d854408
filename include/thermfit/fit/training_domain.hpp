#pragma once

#include <algorithm>

#include "thermfit/fit/impl/spectrum.hpp"
#include "thermfit/model/domain_limits.hpp"
#include "thermfit/model/training_domain.hpp"

namespace thermfit {

/// Where `fit` may be trusted, from the moments it was made of: per-point range, and T2 and SPE limits at 95 % and
/// 99 % for new observations. PLS and PCR bring their latent variables; for MLR and ridge these are all independent
/// principal directions of the temperatures. A point that was constant in training, or a combination of points that
/// was, shows in SPE as soon as it moves. Allocates.
template <typename Scalar>
TrainingDomain<Scalar> training_domain(const LinearFit<Scalar>& fit, const Moments<Scalar>& moments) {
  const detail::StandardisedMoments<Scalar> data(moments, Scaling::both);
  TrainingDomain<Scalar> domain;
  domain.lowest = moments.temperature_lowest();
  domain.highest = moments.temperature_highest();
  domain.mean = fit.channels.temperature_mean;
  domain.scale = fit.channels.temperature_scale;
  const VectorX<Scalar> rescale = data.channels.temperature_scale.cwiseQuotient(domain.scale);
  const MatrixX<Scalar> covariance = rescale.asDiagonal() * data.xx * rescale.asDiagonal();
  if (fit.components > 0) {
    domain.rotations = fit.latent.rotations;
    domain.loadings = fit.latent.loadings;
    domain.score_variance = fit.score_variance;
  } else {
    const detail::Spectrum<Scalar> temperatures = detail::spectrum(data);
    domain.rotations = rescale.cwiseInverse().asDiagonal() * temperatures.directions;
    domain.loadings = rescale.asDiagonal() * temperatures.directions;
    domain.score_variance = temperatures.variance;
  }
  const Index components = domain.score_variance.size();
  domain.t2_limit_95 = static_cast<Scalar>(t2_limit(.95, components, moments.rows()));
  domain.t2_limit_99 = static_cast<Scalar>(t2_limit(.99, components, moments.rows()));
  if (components == domain.mean.size()) return domain;  // no direction is left for SPE
  const MatrixX<Scalar> left =
      MatrixX<Scalar>::Identity(covariance.rows(), covariance.cols()) - domain.rotations * domain.loadings.transpose();
  const MatrixX<Scalar> residual = left.transpose() * covariance * left;
  // What is left of dependent directions is rounding; a limit of that size keeps their own rows inside.
  const Scalar rounding = detail::rank_tolerance<Scalar>(covariance.rows()) * std::max(Scalar(1), covariance.trace());
  const Index directions = fit.rank - components;
  domain.spe_limit_95 = std::max(rounding, spe_limit(.95, residual, directions, components, moments.rows()));
  domain.spe_limit_99 = std::max(rounding, spe_limit(.99, residual, directions, components, moments.rows()));
  return domain;
}

THERMFIT_COMPILED_TEMPLATE(TrainingDomain<double> training_domain<double>(const LinearFit<double>&,
                                                                          const Moments<double>&));

}  // namespace thermfit
