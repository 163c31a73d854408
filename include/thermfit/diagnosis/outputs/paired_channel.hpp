#pragma once

/// One channel of a paired campaign: its gap, what calibration explains of it, and how far a sample is to be trusted.

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/diagnosis/outputs/calibration_basis.hpp"
#include "thermfit/statistics/rms.hpp"
#include "thermfit/statistics/white_noise.hpp"

namespace thermfit {

/// All batches below each other.
struct PairedChannel {
  CalibrationBasis basis;   ///< grows by the columns of effects already found
  Vector gap;               ///< measured minus simulated, less what is already explained
  Matrix products;          ///< cross-products of both
  double as_simulated = 0;  ///< rms
  double calibrated = 0;    ///< rms on batches left out
  double resolution = 0;    ///< what rounding of the readings adds
  double noise = 0;         ///< of a single sample, from second differences of what calibration leaves
  double correlation = 1;   ///< how many samples count as one, (1 + rho) / (1 - rho), at most 6
  double evidence = 0;      ///< of calibration alone, nats
};

/// Lag-1 correlation of each batch's series around zero, 0 … .98.
template <typename Scalar = double>
double lag_one_correlation(const PairedCampaign& campaign, const VectorX<Scalar>& stack) {
  double product = 0, square = 0;
  for (std::size_t b = 0; b < campaign.batches.size(); ++b) {
    const VectorX<Scalar> values = campaign.part(stack, b);
    square += values.squaredNorm();
    product += values.head(values.size() - 1).dot(values.tail(values.size() - 1));
  }
  return square > 0 ? std::min(std::max(product / square, 0.), .98) : 0;
}

/// Every batch predicted from the others: gap minus regressors times the coefficients fitted without it. With a single
/// batch, the residual of the fit itself.
template <typename Scalar = double>
VectorX<Scalar> held_out_residual(const PairedCampaign& campaign, const MatrixX<Scalar>& regressors,
                                  const VectorX<Scalar>& gap, const VectorX<Scalar>& prior_sd, double noise) {
  const MatrixX<Scalar> all = cross_products(regressors, gap);
  VectorX<Scalar> residual(gap.size());
  for (std::size_t b = 0; b < campaign.batches.size(); ++b) {
    const MatrixX<Scalar> own_regressors = campaign.part(regressors, b);
    const VectorX<Scalar> own_gap = campaign.part(gap, b);
    MatrixX<Scalar> others = all;
    if (campaign.batches.size() > 1) others -= cross_products(own_regressors, own_gap);
    campaign.part(residual, b) = own_gap - own_regressors * fit_with_prior(others, prior_sd, noise).coefficients;
  }
  return residual;
}

/// Evidence of regressors with their prior, nats: the level of the noise is profiled between what calibration leaves
/// and the white part, and `correlation` samples count as one.
struct Evidence {
  double log = 0;    ///< at the best level, nats
  double noise = 0;  ///< weight of a sample at the best level
};

/// Evidence of regressors of a channel whose cross_products() with its gap are `products`, with `prior_sd` of their
/// coefficients. Allocates.
template <typename Scalar = double>
Evidence profiled_evidence(const PairedChannel& channel, const MatrixX<Scalar>& products,
                           const VectorX<Scalar>& prior_sd) {
  Evidence best{-1e300, 0};
  const double spread = std::sqrt(channel.correlation);
  const double counted = static_cast<double>(channel.gap.size()) / channel.correlation;
  for (double level = std::max(channel.calibrated, channel.noise) + 1e-6;; level /= 1.5) {
    const double floored = std::max(level, channel.noise);
    const double log = log_evidence(products, counted, prior_sd, floored, spread);
    if (log > best.log) best = {log, floored * spread};
    if (level <= channel.noise || level < 1e-6) break;
  }
  return best;
}

/// Fits calibration alone to a channel, until the weight of a sample has settled.
template <typename Scalar = double>
void judge_calibration(const PairedCampaign& campaign, PairedChannel& channel) {
  const MatrixX<Scalar>& regressors = channel.basis.regressors;
  const VectorX<Scalar>&gap = channel.gap, &prior_sd = channel.basis.prior_sd;
  channel.products = cross_products(regressors, gap);
  if (channel.calibrated == 0) channel.calibrated = .3 * rms_of<Scalar>(gap) + 1e-6;
  for (int round = 0; round < 3; ++round) {
    const VectorX<Scalar> left = held_out_residual<Scalar>(campaign, regressors, gap, prior_sd,
                                                           channel.calibrated * std::sqrt(channel.correlation));
    channel.calibrated = rms_of<Scalar>(left) + 1e-6;
    std::vector<Vector> parts;
    for (std::size_t b = 0; b < campaign.batches.size(); ++b) parts.push_back(campaign.part(left, b));
    channel.noise = std::max(white_noise(parts), channel.resolution);
    const double rho = lag_one_correlation<Scalar>(campaign, left);
    channel.correlation = std::min((1 + rho) / (1 - rho), 6.);
  }
  channel.evidence = profiled_evidence<Scalar>(channel, channel.products, prior_sd).log;
}

}  // namespace thermfit
