#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "thermfit/calibration/held_out.hpp"
#include "thermfit/calibration/map_fit.hpp"

namespace thermfit {

/// One account of a campaign: the machine calibrated together with some effects (none: calibration only).
struct Account {
  std::vector<ThermalNetwork::AddedEffect> effects;  ///< with fitted values
  MapFit fit;                                        ///< to all batches
  HeldOut held;                                      ///< what it leaves on batches that were left out
  int steps = 0;                                     ///< between its place and one that the catalogue lists
};

/// Evidence counts by this power: lumping errors repeat from batch to batch, so its nats are not worth what they would
/// be if the model were exact (a coarsened likelihood, Miller and Dunson 2019). Set on generated campaigns
/// (tests/blind).
constexpr double evidence_power = 0.15;

/// Log probability of an account up to a constant, nats: its evidence, and for every step off the listed places the
/// number of nodes that the step could have taken.
inline double plausibility(const Account& one) {
  return evidence_power * one.fit.log_evidence -
         one.steps * std::log(static_cast<double>(std::max<std::size_t>(2, one.fit.prior.nodes.size())));
}

/// What looking at many places costs the best of them, nats: the log of how many there were.
inline double price_of_search(std::size_t candidates) {
  return std::log(static_cast<double>(std::max<std::size_t>(1, candidates)));
}

/// Most plausible first; ties stay in order.
template <typename Scalar = double>
void best_first(std::vector<Account>& accounts) {
  std::stable_sort(accounts.begin(), accounts.end(),
                   [](const Account& a, const Account& b) { return plausibility(a) > plausibility(b); });
}

/// Whether two effects are the same but for the values of their parameters. Does not allocate.
inline bool same_place(const ThermalNetwork::AddedEffect& a, const ThermalNetwork::AddedEffect& b) {
  return a.effect == b.effect && a.location == b.location && a.driver == b.driver;
}

/// What stays the same while accounts of one campaign are compared.
struct SearchContext {
  const MachineRecord& seen;      ///< what the campaign says
  const ThermalNetwork& machine;  ///< as given, with placements
  const EffectLibrary& library;   ///< knows every effect of the accounts
  const Folds& folds;             ///< batches that are left out together
  unsigned threads = 0;           ///< 0: all cores
};

/// `how` begun where `fit` ended: its noise, the width of its priors, and its first `count` coordinates.
template <typename Scalar = double>
MapFitOptions onward_from(const MapFit& fit, MapFitOptions how, Index count) {
  const VectorX<Scalar>& coordinates = fit.coordinates;
  how.start = coordinates.head(count);
  how.noise = fit.noise;
  how.prior_scale = fit.prior_scale;
  return how;
}

/// Fits the machine with `effects` and judges it on the folds. `how.start` holds the working coordinates of the machine
/// and of all effects but those at the end that have none yet, which begin at the values they carry.
template <typename Scalar = double>
Account explained_by(const SearchContext& context, const std::vector<ThermalNetwork::AddedEffect>& effects,
                     MapFitOptions how) {
  ThermalNetwork network = context.machine;
  network.effects.insert(network.effects.end(), effects.begin(), effects.end());
  network = with_complete_effects(std::move(network), context.library);
  const std::vector<Parameter> parameters = calibration_parameters(network, context.library);
  const Index count = static_cast<Index>(parameters.size()), given = std::min(count, how.start.size());
  VectorX<Scalar> start = VectorX<Scalar>::Zero(count);
  for (Index j = 0; j < count; ++j) {
    const Parameter& one = parameters[static_cast<std::size_t>(j)];
    const double value = value_in(network, one);
    // An effect that vanishes at its start has no logarithm: begin three prior deviations below the mean.
    start(j) = j < given ? how.start(j) : one.logarithmic && value <= 0 ? -3 : one.coordinate(value);
  }
  how.start = std::move(start);
  Account result;
  result.fit = map_fit(context.seen, network, context.library, how);
  const ThermalNetwork fitted = result.fit.network();
  result.effects.assign(fitted.effects.end() - static_cast<std::ptrdiff_t>(effects.size()), fitted.effects.end());
  result.held = held_out(context.seen, result.fit, context.library, context.folds);
  return result;
}

}  // namespace thermfit
