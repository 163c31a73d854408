#pragma once

#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/network/effect.hpp"
#include "thermfit/network/excitation.hpp"
#include "thermfit/network/impl/integrator.hpp"
#include "thermfit/network/impl/readings.hpp"
#include "thermfit/network/impl/system_of.hpp"
#include "thermfit/network/impl/time_grid.hpp"
#include "thermfit/network/parameters.hpp"

namespace thermfit {

/// One simulated batch. Channels are the sensors in the network's order, then the displacements.
struct Simulation {
  Matrix nodes_degC;  ///< samples x nodes (hidden nodes of effects after the network's own)
  Matrix channels;    ///< samples x channels: readings in degC, displacements in um
  /// (channel * samples + sample) x parameters: derivative of `channels` with respect to the *values* of the parameters
  /// asked for. No columns when none were.
  RowMatrix jacobian;
};

namespace detail {

template <typename Scalar>
Simulation simulate_batch(const Lazy<ThermalSystem, Scalar>& system, Regimes<Scalar>& regimes,
                          const Lazy<Excitation, Scalar>& excitation) {
  const Drive<Scalar> drive(system, excitation);
  Integrator<Scalar> integrator(system, regimes, drive);
  Readings<Scalar> readings(system, drive);
  const double delay_s = readings.delay_s();
  const std::vector<GridPoint> grid = time_grid(excitation.time_s, delay_s);
  Lazy<Simulation, Scalar> result;
  result.nodes_degC.resize(excitation.samples(), static_cast<Index>(system.capacities.size()));
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const GridPoint& point = grid[i];
    const Regime<Scalar>& regime = integrator.enter(point.sample, point.time_s);
    for (const Index k : point.readings) {
      result.nodes_degC.row(k) = integrator.temperatures().transpose();
      readings.take_temperatures(k, regime, integrator);
    }
    for (const Index k : point.positions) readings.take_displacements(k, point, regime, integrator);
    if (i + 1 == grid.size()) break;
    integrator.advance(point.sample, point.time_s, grid[i + 1].time_s);
    readings.take_rates(point.sample, grid[i + 1].time_s, integrator);
  }
  readings.finish();
  result.channels = std::move(readings.values());
  result.jacobian = std::move(readings.tangents());
  return result;
}

}  // namespace detail

/// Simulates each excitation; `parameters` lists the numbers whose sensitivities are wanted (may be empty). The effects
/// of the network are looked up in `effects`; parameters of theirs that are absent take the prior's mean. Throws Error
/// on an unknown effect or a missing input.
template <typename Scalar = double>
std::vector<Simulation> simulate(const ThermalNetwork& network, const std::vector<Excitation>& excitations,
                                 const EffectLibrary& effects, const std::vector<Parameter>& parameters = {}) {
  const ThermalSystem system = system_of<Scalar>(network, effects, parameters);
  detail::Regimes<Scalar> regimes(system);
  std::vector<Simulation> result;
  for (const Excitation& excitation : excitations)
    result.push_back(detail::simulate_batch<Scalar>(system, regimes, excitation));
  return result;
}

THERMFIT_COMPILED_TEMPLATE(std::vector<Simulation> simulate<double>(
    const ThermalNetwork&, const std::vector<Excitation>&, const EffectLibrary&, const std::vector<Parameter>&));

}  // namespace thermfit
