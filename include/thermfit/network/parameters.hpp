#pragma once

#include <string>
#include <vector>

#include "thermfit/effects/effect.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// One number that calibration may move, with what is known of it beforehand.
///
/// Its working coordinate t is 0 at the prior's mean and counts prior standard deviations:
/// value = mean exp(sd t) where `logarithmic`, else mean + sd t. So the prior of every t is N(0, 1).
struct Parameter {
  enum class Kind { capacity, ambient, conductance, power, expansion, sensor_offset, effect };
  Kind kind = Kind::capacity;
  std::size_t item = 0;  ///< node, node, link, source, displacement, sensor, effect
  std::size_t part = 0;  ///< entry of the displacement's um_per_K, or parameter of the effect
  std::string name;      ///< "capacity of head_front"
  std::string unit;
  bool logarithmic = false;
  double mean = 0, sd = 1;
  double lower = 0, upper = 0;

  double value(double t) const;
  double coordinate(double value) const;
  /// dvalue/dt at t.
  double slope(double t) const;
};

/// Everything that can be calibrated, in this order: capacities, ambient conductances, links, powers, expansions,
/// sensor offsets, then each effect's own. Numbers that are zero and cannot be negative stay zero and are left out, and
/// so are offsets of ambient sensors.
std::vector<Parameter> calibration_parameters(const ThermalNetwork& network, const EffectLibrary& effects);

/// Value of a parameter in a network, and the network with other values (in the order of `parameters`).
double value_in(const ThermalNetwork& network, const Parameter& parameter);
ThermalNetwork with_values(ThermalNetwork network, const std::vector<Parameter>& parameters, const Vector& values);
Vector values_of(const ThermalNetwork& network, const std::vector<Parameter>& parameters);

}  // namespace thermfit
