#pragma once

#include <vector>

#include "thermfit/effects/effect.hpp"
#include "thermfit/network/excitation.hpp"
#include "thermfit/network/parameters.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// One simulated batch. Channels are the sensors in the network's order, then the displacements.
struct Simulation {
  Matrix nodes_degC;  ///< samples x nodes (hidden nodes of effects after the network's own)
  Matrix channels;    ///< samples x channels: readings in degC, displacements in um
  /// (channel * samples + sample) x parameters: derivative of `channels` with respect to the *values* of the parameters
  /// asked for. Empty when none were.
  Matrix jacobian;
};

/// Simulates each excitation; `parameters` lists the numbers whose sensitivities are wanted (may be empty).
std::vector<Simulation> simulate(const ThermalNetwork& network, const std::vector<Excitation>& excitations,
                                 const EffectLibrary& effects, const std::vector<Parameter>& parameters = {});

}  // namespace thermfit
