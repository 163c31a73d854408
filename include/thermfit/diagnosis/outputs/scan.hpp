#pragma once

/// Every trace weighed against calibration alone, channel by channel.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/outputs/paired_channel.hpp"
#include "thermfit/effects/output_traces.hpp"

namespace thermfit {

/// A trace's worth in one channel.
struct ChannelScore {
  Index channel = 0;        ///< in PairedCampaign::channels
  double gain = 0;          ///< evidence over calibration alone, nats
  Vector coefficients;      ///< of the trace's columns
  Vector standard_errors;   ///< of `coefficients`
  double contribution = 0;  ///< rms of the fitted trace, in the unit of the channel
  double direction = 0;     ///< its correlation with the second column (a heat flow, lagged), -1…1
};

/// A trace's worth in all channels where it counts.
struct TraceScore {
  std::size_t trace = 0;                  ///< its place in OutputScan::traces
  double gain = 0;                        ///< summed over its channels, nats
  std::vector<ChannelScore> channels;     ///< in the order of OutputTrace::channels
  std::optional<RuledOutBy> implausible;  ///< why it cannot be its effect; empty where it can
};

/// Prior of a trace's coefficients where its columns are scaled to rms one: free ones may be three times what the
/// channel shows; a law of unit strength has 1 +- 10 %.
template <typename Scalar = double>
struct TracePrior {
  VectorX<Scalar> mean;   ///< of the coefficients of the scaled columns
  VectorX<Scalar> sd;     ///< of the same
  VectorX<Scalar> scale;  ///< rms of each column, never 0

  /// In one channel. Allocates.
  TracePrior(const OutputTrace& trace, const PairedChannel& channel) {
    const MatrixX<Scalar>& regressors = trace.columns;
    const Index columns = regressors.cols();
    scale = (regressors.colwise().squaredNorm().transpose() / static_cast<double>(regressors.rows()))
                .cwiseSqrt()
                .cwiseMax(1e-12);
    const double wide = 3 * std::max(channel.as_simulated, channel.calibrated) + 1e-9;
    sd = trace.unit_strength ? VectorX<Scalar>(.1 * scale) : VectorX<Scalar>::Constant(columns, wide);
    mean = trace.unit_strength ? scale : VectorX<Scalar>::Zero(columns);
  }
};

/// Fits a trace beside the calibration of channel `index`, which is `channel`. Allocates.
template <typename Scalar = double>
ChannelScore score_in(const OutputTrace& trace, const PairedChannel& channel, Index index) {
  const TracePrior<Scalar> prior(trace, channel);
  const MatrixX<Scalar>&regressors = trace.columns, &calibration = channel.basis.regressors,
        &known_products = channel.products;
  const VectorX<Scalar>&all = channel.gap, &known_sd = channel.basis.prior_sd;
  const Index columns = prior.scale.size(), known = known_sd.size();
  const MatrixX<Scalar> scaled = regressors * prior.scale.cwiseInverse().asDiagonal();
  const VectorX<Scalar> gap = all - scaled * prior.mean;
  MatrixX<Scalar> products(known + columns + 1, known + columns + 1);  // calibration, trace, gap
  products.topLeftCorner(known, known) = known_products.topLeftCorner(known, known);
  products.block(known, known, columns, columns).noalias() = scaled.transpose() * scaled;
  products.block(0, known, known, columns).noalias() = calibration.transpose() * scaled;
  products.block(0, known + columns, known, 1) =
      known_products.topRightCorner(known, 1) - products.block(0, known, known, columns) * prior.mean;
  products.block(known, known + columns, columns, 1).noalias() = scaled.transpose() * gap;
  products(known + columns, known + columns) = gap.squaredNorm();
  products.template triangularView<Eigen::StrictlyLower>() = products.transpose();

  VectorX<Scalar> prior_sd(known + columns);
  prior_sd << known_sd, prior.sd;
  const Evidence evidence = profiled_evidence<Scalar>(channel, products, prior_sd);
  const PriorFit fit = fit_with_prior(products, prior_sd, evidence.noise, true);
  const VectorX<Scalar>& coefficients = fit.coefficients;
  const MatrixX<Scalar>& covariance = fit.covariance;
  const VectorX<Scalar> tail = coefficients.tail(columns) + prior.mean;
  const VectorX<Scalar> fitted = scaled * tail;
  ChannelScore score{index,
                     evidence.log - channel.evidence,
                     tail.cwiseQuotient(prior.scale),
                     covariance.diagonal().tail(columns).cwiseSqrt().cwiseQuotient(prior.scale),
                     rms_of<Scalar>(fitted),
                     0};
  if (score.contribution > 0)
    score.direction = fitted.dot(scaled.col(std::min<Index>(1, columns - 1))) /
                      (score.contribution * static_cast<double>(fitted.size()));
  return score;
}

/// The sensor in which a trace shows most, or null where it shows in none.
inline const ChannelScore* strongest_sensor(const TraceScore& score, Index temperatures) {
  const ChannelScore* strongest = nullptr;
  for (const ChannelScore& one : score.channels)
    if (one.channel < temperatures && (!strongest || one.contribution > strongest->contribution)) strongest = &one;
  return strongest;
}

/// Sensors to which the simulator gives the same course sit on the same node.
inline bool same_node(const PairedCampaign& campaign, Index a, Index b) {
  if (a == b) return true;
  for (const PairedBatch& batch : campaign.batches)
    for (Index k = 0; k < batch.simulated.rows(); ++k)
      if (std::abs(batch.simulated(k, a) - batch.simulated(k, b)) > 1e-6) return false;
  return true;
}

/// A law of unit strength may come out this far below it, since its trace is an approximation …
constexpr double least_strength = .75;
/// … and this far above it.
constexpr double most_strength = 1.33;
/// Share of what the strongest thermometer shows that a heat flow must show where it acts.
constexpr double shows_here = .4;

/// A law of unit strength must come out with a coefficient near one; a heat exchange between two places must show
/// most at one of them (or on its node), any other heat flow at least strongly where it acts, with the sign of its law.
inline std::optional<RuledOutBy> why_implausible(const OutputTrace& trace, const TraceScore& score,
                                                 const PairedCampaign& campaign) {
  if (trace.unit_strength) {
    const double strength = score.channels[0].coefficients(0);
    if (strength > least_strength && strength < most_strength) return std::nullopt;
    return RuledOutBy::strength;
  }
  if (trace.acts_on.empty()) return std::nullopt;
  const ChannelScore* strongest = strongest_sensor(score, campaign.temperatures);
  bool here = false;
  double directions = 1;
  for (const auto& [channel, sign] : trace.acts_on) {
    here = here || (strongest && same_node(campaign, strongest->channel, channel));
    for (const ChannelScore& one : score.channels) {
      if (one.channel != channel) continue;
      here = here || (trace.acts_on.size() == 1 && one.contribution > shows_here * strongest->contribution);
      if (sign * one.direction < 0) return RuledOutBy::sign;
      directions *= one.direction;
    }
  }
  if (!here) return RuledOutBy::elsewhere;
  if (trace.acts_on.size() == 2 && directions > 0) return RuledOutBy::same_sign;
  return std::nullopt;
}

/// Weighs trace number `index` of a scan in every channel where it counts, and asks whether it can be its effect.
/// `channels` are those of `campaign`. Allocates.
template <typename Scalar = double>
TraceScore score_of(std::size_t index, const OutputTrace& trace, const std::vector<PairedChannel>& channels,
                    const PairedCampaign& campaign) {
  TraceScore score;
  score.trace = index;
  for (const Index channel : trace.channels) {
    score.channels.push_back(score_in<Scalar>(trace, channels[static_cast<std::size_t>(channel)], channel));
    score.gain += score.channels.back().gain;
  }
  score.implausible = why_implausible(trace, score, campaign);
  return score;
}

}  // namespace thermfit
