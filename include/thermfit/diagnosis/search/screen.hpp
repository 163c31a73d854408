#pragma once

/// What every candidate promises, to first order.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/search/beginnings.hpp"
#include "thermfit/diagnosis/search/screening_base.hpp"
#include "thermfit/statistics/parallel.hpp"

namespace thermfit {

/// An effect at a place as the screening leaves it: where its refit should begin and what it promises.
struct Candidate {
  ThermalNetwork::AddedEffect added;                       ///< with the size that the linear step found
  Vector start;                                            ///< of the machine's own working coordinates
  double score = 0;                                        ///< chi-square of its size with calibration projected out
  double gain = -std::numeric_limits<double>::infinity();  ///< of log posterior, predicted
};

namespace detail {

/// What an effect changes in the outputs, and its products with what calibration can change.
template <typename Scalar>
struct Signature {
  std::vector<SeriesByBatch> series;    ///< by channel: with the effect less without
  std::vector<VectorX<Scalar>> across;  ///< by channel, whitened: J'V of the active columns
  VectorX<Scalar> own, along;           ///< by channel, whitened: V'V, V'r
  bool visible = false;                 ///< finite, and something to see at this place
};

/// Signatures below this whitened square show nothing.
constexpr double least_visible = 1e-9;

/// Of `begun` on the bare machine. The placement of a sensor imitates a fault of it, and would then hide it: the
/// signature of what acts on a sensor is that at no placement.
template <typename Scalar>
Signature<Scalar> signature_of(const ScreeningBase<Scalar>& base, const EffectLibrary& library,
                               const ThermalNetwork::AddedEffect& begun) {
  const MachineRecord& seen = base.seen();
  ThermalNetwork network = base.bare();
  const auto faulty = std::find_if(network.sensors.begin(), network.sensors.end(),
                                   [&](const auto& sensor) { return sensor.column == begun.location; });
  std::vector<Simulation> moved;
  if (faulty != network.sensors.end()) {
    for (auto& share : faulty->placement) share.second = 0;
    moved = simulate(network, seen.excitations, library);
  }
  const std::vector<Simulation>& without = moved.empty() ? base.bare_simulated() : moved;
  network.effects.push_back(begun);
  const std::vector<Simulation> with = simulate(network, seen.excitations, library);
  const std::size_t channels = seen.channels.size();
  Signature<Scalar> result;
  if (!all_finite(seen, with)) return result;
  result.series.resize(channels);
  result.across.resize(channels);
  result.own = result.along = VectorX<Scalar>::Zero(static_cast<Index>(channels));
  for (std::size_t c = 0; c < channels; ++c) {
    const Linearized::Channel& channel = base.model().channels[c];
    result.across[c] = VectorX<Scalar>::Zero(static_cast<Index>(channel.active.size()));
    for (std::size_t b = 0; b < with.size(); ++b) {
      const MatrixX<Scalar>&on = with[b].channels, &off = without[b].channels;
      const Index column = seen.channels[c].column;
      VectorX<Scalar> white = on.col(column) - off.col(column);
      result.series[c].push_back(white);
      if (white.cwiseAbs().maxCoeff() == 0) continue;
      base.whiteners()[c][b].apply(white);
      const MatrixX<Scalar>& jacobian = channel.batches[b].jacobian;
      result.across[c].noalias() += jacobian.transpose() * white;
      result.own(static_cast<Index>(c)) += white.squaredNorm();
      result.along(static_cast<Index>(c)) += white.dot(channel.batches[b].residual);
    }
  }
  result.visible = !(result.own.sum() < least_visible);
  return result;
}

/// Size of an effect and move of calibration that fit best, to first order.
template <typename Scalar>
struct LinearStep {
  double size = 0;          ///< 0: calibration does the same, or the effect does not help
  double score = 0;         ///< chi-square of the size at the first weights
  VectorX<Scalar> move;     ///< of the working coordinates
  VectorX<Scalar> weights;  ///< by channel: by how much its residual shrinks, in square
};

/// An effect whose information is less than this share of its own is what calibration can do.
constexpr double least_information = 1e-9;
/// No channel is expected to shrink to less than this share of its square.
constexpr double least_remaining = 0.1;

/// Projects calibration out of the signature through the normal equations; channels are reweighted as their residual
/// shrinks.
template <typename Scalar>
LinearStep<Scalar> linear_step(const ScreeningBase<Scalar>& base, const Signature<Scalar>& signature,
                               const SizeRange& range) {
  const MapFit& fit = base.fit();
  const std::size_t channels = base.seen().channels.size();
  const VectorX<Scalar>& coordinates = fit.coordinates;
  const Index n = coordinates.size();
  LinearStep<Scalar> step;
  step.weights = VectorX<Scalar>::Ones(static_cast<Index>(channels));
  step.move = VectorX<Scalar>::Zero(n);
  for (int pass = 0; pass < 3; ++pass) {
    const Eigen::LLT<MatrixX<Scalar>> factor = base.factor(step.weights);
    MatrixX<Scalar> right = MatrixX<Scalar>::Zero(n, 2);  // J'WV, gradient
    const VectorX<Scalar> precision = fit.precision();
    right.col(1) = -precision.cwiseProduct(coordinates);
    double own_sum = range.prior_information, along_sum = range.prior_information * range.prior_mean;
    for (std::size_t c = 0; c < channels; ++c) {
      const double weight = step.weights(static_cast<Index>(c));
      const auto& active = base.model().channels[c].active;
      for (std::size_t j = 0; j < active.size(); ++j) {
        right(active[j], 0) += weight * signature.across[c](static_cast<Index>(j));
        right(active[j], 1) += weight * fit.equations.by_channel[c].score(static_cast<Index>(j));
      }
      own_sum += weight * signature.own(static_cast<Index>(c));
      along_sum += weight * signature.along(static_cast<Index>(c));
    }
    const MatrixX<Scalar> solved = factor.solve(right);
    const double information = own_sum - right.col(0).dot(solved.col(0));
    if (information <= least_information * own_sum) {
      step.size = 0;
      return step;
    }
    const double free_size = (along_sum - right.col(0).dot(solved.col(1))) / information;
    step.size = std::clamp(free_size, range.low, range.high);
    step.move = solved.col(1) - step.size * solved.col(0);
    if (pass == 0) step.score = step.size * free_size > 0 ? information * step.size * (2 * free_size - step.size) : 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const NormalEquations& part = fit.equations.by_channel[c];
      const auto& active = base.model().channels[c].active;
      VectorX<Scalar> local(static_cast<Index>(active.size()));
      for (std::size_t j = 0; j < active.size(); ++j) local(static_cast<Index>(j)) = step.move(active[j]);
      const Index i = static_cast<Index>(c);
      const MatrixX<Scalar>& information_c = part.information;
      const double after = part.squares - 2 * local.dot(part.score) - 2 * step.size * signature.along(i) +
                           local.dot(information_c * local) + 2 * step.size * local.dot(signature.across[c]) +
                           step.size * step.size * signature.own(i);
      step.weights(i) = part.squares > 0 ? part.squares / std::max(after, least_remaining * part.squares) : 1;
    }
  }
  return step;
}

/// Log likelihood of what the step is predicted to leave, under noise estimated anew.
template <typename Scalar>
double predicted_likelihood(const ScreeningBase<Scalar>& base, const Signature<Scalar>& signature,
                            const LinearStep<Scalar>& step) {
  const MapFit& fit = base.fit();
  const MachineRecord& seen = base.seen();
  ChannelResiduals predicted(seen.channels.size());
  const VectorX<Scalar> slopes = fit.slopes();
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    for (std::size_t b = 0; b < seen.batches(); ++b) {
      const RowMatrixX<Scalar>& jacobian = base.simulated()[b].jacobian;
      const VectorX<Scalar>&residual = fit.residual[c][b], &series = signature.series[c][b];
      const Index rows = residual.size(), first = seen.channels[c].column * rows;
      predicted[c].push_back(residual - step.size * series -
                             jacobian.middleRows(first, rows) * slopes.cwiseProduct(step.move));
    }
  return log_likelihood(seen, predicted, noise_of(seen, predicted, fit.noise));
}

/// Half the log by which the whitened squares of all channels shrink, sample by sample: cheaper than the likelihood.
template <typename Scalar>
double gain_of_squares(const ScreeningBase<Scalar>& base, const LinearStep<Scalar>& step) {
  double gain = 0;
  for (std::size_t c = 0; c < base.seen().channels.size(); ++c) {
    Index count = 0;
    for (const auto& one : base.whiteners()[c]) count += one.count();
    gain += 0.5 * static_cast<double>(count) * std::log(step.weights(static_cast<Index>(c)));
  }
  return gain;
}

}  // namespace detail

/// What adding `begun` to the calibrated machine promises when calibration moves along, to first order: its signature
/// is one simulation; calibration is projected out of it. The gain is that of the predicted residual under noise
/// estimated anew, or without that, of its whitened squares: enough to tell what is worth more. Allocates.
template <typename Scalar = double>
Candidate screen_one(const ScreeningBase<Scalar>& base, const EffectLibrary& library,
                     const ThermalNetwork::AddedEffect& begun, bool with_noise = true) {
  const MapFit& fit = base.fit();
  Candidate result;
  result.added = begun;
  const std::vector<EffectParameter> parameters = library.at(begun.effect).parameters(base.bare(), begun);
  const detail::SizeRange range = detail::size_range(parameters, begun);
  const detail::Signature<Scalar> signature = detail::signature_of(base, library, begun);
  if (!signature.visible) return result;
  const detail::LinearStep<Scalar> step = detail::linear_step(base, signature, range);
  result.score = step.score;
  if (step.size == 0) return result;
  const VectorX<Scalar>& coordinates = fit.coordinates;
  result.start = coordinates + step.move;
  const double shift = step.size - range.prior_mean;
  const double prior = fit.log_prior(result.start) - 0.5 * shift * shift * range.prior_information;
  for (std::size_t k = 0; k < parameters.size(); ++k)
    if (detail::carries_size(parameters[k]))
      result.added.parameters[k].second = detail::value_at_size(parameters[k], begun.parameters[k].second, step.size);
  result.gain = with_noise ? detail::predicted_likelihood(base, signature, step) + prior - fit.log_posterior
                           : prior - fit.log_prior(fit.coordinates) + detail::gain_of_squares(base, step);
  return result;
}

/// All candidates from every beginning, the best beginning of each place kept; strongest first, ties in catalogue
/// order. All are tried cheaply; the `closer` best, and the best two of every effect, are looked at closely.
template <typename Scalar = double>
std::vector<Candidate> screen(const ScreeningBase<Scalar>& base, const EffectLibrary& library,
                              const std::vector<ThermalNetwork::AddedEffect>& candidates, unsigned threads,
                              std::size_t closer = 80) {
  std::vector<ThermalNetwork::AddedEffect> begun;
  std::vector<std::size_t> owner;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (auto& one : detail::beginnings(library.at(candidates[i].effect), base.fit().prior, candidates[i])) {
      begun.push_back(std::move(one));
      owner.push_back(i);
    }
  std::vector<Candidate> tried(begun.size());
  in_parallel(begun.size(), threads, [&](std::size_t i) { tried[i] = screen_one(base, library, begun[i], false); });
  std::vector<std::size_t> order(begun.size()), close;
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return tried[a].gain > tried[b].gain; });
  std::map<std::string, int> of_effect;
  for (std::size_t k = 0; k < order.size(); ++k)
    if (tried[order[k]].start.size() > 0 && (k < closer || of_effect[begun[order[k]].effect] < 2)) {
      ++of_effect[begun[order[k]].effect];
      close.push_back(order[k]);
    }
  for (Candidate& one : tried) one.gain = -std::numeric_limits<double>::infinity();
  in_parallel(close.size(), threads,
              [&](std::size_t k) { tried[close[k]] = screen_one(base, library, begun[close[k]]); });
  std::vector<Candidate> best(candidates.size());
  for (std::size_t i = 0; i < tried.size(); ++i)
    if (best[owner[i]].added.effect.empty() || tried[i].gain > best[owner[i]].gain)
      best[owner[i]] = std::move(tried[i]);
  std::stable_sort(best.begin(), best.end(), [](const Candidate& a, const Candidate& b) { return a.gain > b.gain; });
  return best;
}

}  // namespace thermfit
