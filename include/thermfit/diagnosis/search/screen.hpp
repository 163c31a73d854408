#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/map_fit.hpp"
#include "thermfit/statistics/parallel.hpp"

namespace thermfit {

/// An effect at a place as the screening leaves it: where its refit should begin and what it promises.
struct Candidate {
  ThermalNetwork::AddedEffect added;                       ///< with the size that the linear step found
  Vector start;                                            ///< of the machine's own working coordinates
  double score = 0;                                        ///< chi-square of its size with calibration projected out
  double gain = -std::numeric_limits<double>::infinity();  ///< of log posterior, predicted
};

/// What the screening of every candidate shares: the calibrated machine, linearised.
class ScreeningBase {
 public:
  /// `own_effects`: how many effects the machine brought along; those that the search added after them are left out of
  /// the machine on which signatures are taken, which to first order changes nothing and is far cheaper.
  ScreeningBase(const MachineRecord& seen, const MapFit& fit, const EffectLibrary& library, std::size_t own_effects)
      : seen_(seen),
        fit_(fit),
        simulated_(simulate(fit.network(), seen.excitations, library, fit.parameters)),
        whiteners_(whiteners_of(seen, fit.noise)),
        model_(linearized(seen, simulated_, fit.slopes(), whiteners_)),
        prior_(fit.precision().asDiagonal()),
        factor_(fit.total().information + prior_),
        bare_(fit.network()) {
    bare_.effects.resize(own_effects);
    bare_simulated_ = simulate(bare_, seen.excitations, library);
  }

  const MachineRecord& seen() const { return seen_; }
  const MapFit& fit() const { return fit_; }
  const std::vector<Simulation>& simulated() const { return simulated_; }  ///< with sensitivities
  const ThermalNetwork& bare() const { return bare_; }                     ///< on which signatures are taken
  const std::vector<Simulation>& bare_simulated() const { return bare_simulated_; }
  const std::vector<std::vector<Whitener>>& whiteners() const { return whiteners_; }
  const Linearized& model() const { return model_; }

  /// Information of the machine's parameters with channels reweighted, and its factor; the factor at unit weights is
  /// kept.
  Eigen::LLT<Matrix> factor(const Vector& weights) const {
    if ((weights.array() == 1).all()) return factor_;
    Matrix information = prior_;
    for (std::size_t c = 0; c < model_.channels.size(); ++c) {
      const auto& active = model_.channels[c].active;
      const Matrix& part = fit_.equations.by_channel[c].information;
      for (std::size_t j = 0; j < active.size(); ++j)
        for (std::size_t i = 0; i < active.size(); ++i)
          information(active[i], active[j]) +=
              weights(static_cast<Index>(c)) * part(static_cast<Index>(i), static_cast<Index>(j));
    }
    return information.llt();
  }

 private:
  const MachineRecord& seen_;
  const MapFit& fit_;
  std::vector<Simulation> simulated_;
  std::vector<std::vector<Whitener>> whiteners_;
  Linearized model_;
  Matrix prior_;
  Eigen::LLT<Matrix> factor_;
  ThermalNetwork bare_;
  std::vector<Simulation> bare_simulated_;
};

namespace detail {

/// Size of an effect in units of where it begins: 0 is no effect, 1 as begun.
struct SizeRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double prior_mean = 0, prior_information = 0;
};

/// Whether a parameter carries the size of an effect (else it only shapes it).
inline bool carries_size(const EffectParameter& one) { return !one.shapes && !one.fixed; }

inline double value_at_size(const EffectParameter& one, double begun, double size) {
  const double null = one.logarithmic ? 0 : one.null;
  const double value = null + size * (begun - null);
  return std::clamp(value, one.lower, one.upper);
}

/// The values at which to begin: every combination of what the parameters list, at most eight.
inline std::vector<ThermalNetwork::AddedEffect> beginnings(const Effect& effect, const ThermalNetwork& network,
                                                           const ThermalNetwork::AddedEffect& added) {
  std::vector<ThermalNetwork::AddedEffect> result{added};
  result[0].parameters.clear();
  for (const EffectParameter& one : effect.parameters(network, added)) {
    std::vector<double> starts = one.starts;
    if (one.fixed) starts = {added.value(one.name, one.mean)};
    if (starts.empty()) {
      const bool vanishes = carries_size(one) && !one.logarithmic && one.mean == one.null;
      starts = {vanishes ? std::clamp(one.null + one.sd, one.lower, one.upper) : one.mean};
      if (starts[0] == one.null && vanishes) starts[0] = std::clamp(one.null - one.sd, one.lower, one.upper);
    }
    std::vector<ThermalNetwork::AddedEffect> longer;
    for (const auto& begun : result)
      for (const double value : starts) {
        longer.push_back(begun);
        longer.back().parameters.emplace_back(one.name, value);
      }
    if (longer.size() <= 8) {
      result = std::move(longer);
    } else {
      for (auto& begun : result) begun.parameters.emplace_back(one.name, starts[0]);
    }
  }
  return result;
}

inline SizeRange size_range(const std::vector<EffectParameter>& parameters, const ThermalNetwork::AddedEffect& begun) {
  SizeRange range;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const EffectParameter& one = parameters[k];
    if (!carries_size(one)) continue;
    const double at = begun.parameters[k].second;
    if (one.logarithmic) {
      range.low = std::max(range.low, 0.02);
      range.high = std::min(range.high, std::exp(4 * one.sd) * one.mean / at);
      continue;
    }
    const double unit = at - one.null;
    if (unit == 0) continue;
    double a = (one.lower - one.null) / unit, b = (one.upper - one.null) / unit;
    if (a > b) std::swap(a, b);
    range.low = std::max(range.low, a);
    range.high = std::min(range.high, b);
    const double information = unit * unit / (one.sd * one.sd);
    range.prior_mean = (one.mean - one.null) / unit;
    range.prior_information += information;
  }
  return range;
}

inline double whitened_count(const ScreeningBase& base, std::size_t channel) {
  Index count = 0;
  for (const Whitener& one : base.whiteners()[channel]) count += one.count();
  return static_cast<double>(count);
}

}  // namespace detail

/// What adding `begun` to the calibrated machine promises when calibration moves along, to first order: its signature
/// is one simulation; calibration is projected out of it through the normal equations; channels are reweighted as their
/// residual shrinks. The gain is that of the predicted residual under noise estimated anew, or without that, of its
/// whitened squares: cheaper, and enough to tell what is worth more.
inline Candidate screen_one(const ScreeningBase& base, const EffectLibrary& library,
                            const ThermalNetwork::AddedEffect& begun, bool with_noise = true) {
  const MapFit& fit = base.fit();
  const MachineRecord& seen = base.seen();
  Candidate result;
  result.added = begun;
  ThermalNetwork network = base.bare();
  const std::vector<EffectParameter> parameters = library.at(begun.effect).parameters(network, begun);
  const detail::SizeRange range = detail::size_range(parameters, begun);
  // The placement of a sensor imitates a fault of it, and would then hide it: its signature is that at no placement.
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
  if (!detail::all_finite(seen, with)) return result;

  const std::size_t channels = seen.channels.size();
  const Index n = fit.coordinates.size();
  std::vector<SeriesByBatch> signature(channels);
  std::vector<Vector> across(channels);                                  // J'V of the active columns
  Vector own = Vector::Zero(static_cast<Index>(channels)), along = own;  // V'V, V'r
  for (std::size_t c = 0; c < channels; ++c) {
    const Linearized::Channel& channel = base.model().channels[c];
    across[c] = Vector::Zero(static_cast<Index>(channel.active.size()));
    for (std::size_t b = 0; b < with.size(); ++b) {
      const Index column = seen.channels[c].column;
      signature[c].push_back(with[b].channels.col(column) - without[b].channels.col(column));
      Vector white = signature[c][b];
      if (white.cwiseAbs().maxCoeff() == 0) continue;
      base.whiteners()[c][b].apply(white);
      across[c].noalias() += channel.batches[b].jacobian.transpose() * white;
      own(static_cast<Index>(c)) += white.squaredNorm();
      along(static_cast<Index>(c)) += white.dot(channel.batches[b].residual);
    }
  }
  if (own.sum() < 1e-9) return result;  // nothing to see at this place

  Vector weights = Vector::Ones(static_cast<Index>(channels)), move = Vector::Zero(n);
  double size = 0;
  for (int pass = 0; pass < 3; ++pass) {
    const Eigen::LLT<Matrix> factor = base.factor(weights);
    Matrix right = Matrix::Zero(n, 2);  // J'WV, gradient
    right.col(1) = -fit.precision().cwiseProduct(fit.coordinates);
    double own_sum = range.prior_information, along_sum = range.prior_information * range.prior_mean;
    for (std::size_t c = 0; c < channels; ++c) {
      const double weight = weights(static_cast<Index>(c));
      const auto& active = base.model().channels[c].active;
      for (std::size_t j = 0; j < active.size(); ++j) {
        right(active[j], 0) += weight * across[c](static_cast<Index>(j));
        right(active[j], 1) += weight * fit.equations.by_channel[c].score(static_cast<Index>(j));
      }
      own_sum += weight * own(static_cast<Index>(c));
      along_sum += weight * along(static_cast<Index>(c));
    }
    const Matrix solved = factor.solve(right);
    const double information = own_sum - right.col(0).dot(solved.col(0));
    if (information <= 1e-9 * own_sum) return result;  // calibration does the same
    const double free_size = (along_sum - right.col(0).dot(solved.col(1))) / information;
    size = std::clamp(free_size, range.low, range.high);
    move = solved.col(1) - size * solved.col(0);
    if (pass == 0) result.score = size * free_size > 0 ? information * size * (2 * free_size - size) : 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const NormalEquations& part = fit.equations.by_channel[c];
      const auto& active = base.model().channels[c].active;
      Vector local(static_cast<Index>(active.size()));
      for (std::size_t j = 0; j < active.size(); ++j) local(static_cast<Index>(j)) = move(active[j]);
      const Index i = static_cast<Index>(c);
      const double after = part.squares - 2 * local.dot(part.score) - 2 * size * along(i) +
                           local.dot(part.information * local) + 2 * size * local.dot(across[c]) + size * size * own(i);
      weights(i) = part.squares > 0 ? part.squares / std::max(after, 0.1 * part.squares) : 1;
    }
  }
  if (size == 0) return result;
  result.start = fit.coordinates + move;
  const double shift = size - range.prior_mean;
  const double prior = fit.log_prior(result.start) - 0.5 * shift * shift * range.prior_information;
  for (std::size_t k = 0; k < parameters.size(); ++k)
    if (detail::carries_size(parameters[k]))
      result.added.parameters[k].second = detail::value_at_size(parameters[k], begun.parameters[k].second, size);
  if (!with_noise) {
    result.gain = prior - fit.log_prior(fit.coordinates);
    for (std::size_t c = 0; c < channels; ++c)
      result.gain += 0.5 * detail::whitened_count(base, c) * std::log(weights(static_cast<Index>(c)));
    return result;
  }

  ChannelResiduals predicted(channels);
  const Vector slopes = fit.slopes();
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t b = 0; b < with.size(); ++b) {
      const Index rows = with[b].channels.rows(), first = seen.channels[c].column * rows;
      predicted[c].push_back(fit.residual[c][b] - size * signature[c][b] -
                             base.simulated()[b].jacobian.middleRows(first, rows) * slopes.cwiseProduct(move));
    }
  result.gain = log_likelihood(seen, predicted, noise_of(seen, predicted, fit.noise)) + prior - fit.log_posterior;
  return result;
}

/// All candidates from every beginning, the best beginning of each place kept; strongest first, ties in catalogue
/// order. All are tried cheaply; the `closer` best, and the best two of every effect, are looked at closely.
inline std::vector<Candidate> screen(const ScreeningBase& base, const EffectLibrary& library,
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
