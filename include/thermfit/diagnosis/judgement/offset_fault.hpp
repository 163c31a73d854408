#pragma once

/// A thermometer whose offset is no tolerance.

#include <cmath>
#include <limits>
#include <string>

#include "thermfit/calibration/map_fit.hpp"
#include "thermfit/diagnosis/search/account.hpp"

namespace thermfit {

/// The thermometer whose offset is least like a tolerance, and the log odds of a fault against it.
struct OffsetFault {
  Index sensor = -1;                                       ///< -1: none can be judged
  double odds = -std::numeric_limits<double>::infinity();  ///< log odds of a fault against a tolerance
  std::string effect;                                      ///< of the library that says it
};

/// From the offset that the data alone ask for, m with variance v in units of the tolerance: log N(m; 0, v + 1 + r^2) /
/// N(m; 0, v + 1), r the prior size of a fault over the tolerance. No refit: an offset is linear. None where the
/// library has no effect that does what calibration of an offset does. Allocates.
template <typename Scalar = double>
OffsetFault offset_fault(const SearchContext& context, const MapFit& fit) {
  OffsetFault result;
  for (const auto& effect : context.library.all())
    if (effect->calibration_does_the_same()) result.effect = effect->name();
  if (result.effect.empty()) return result;
  const MatrixX<Scalar> covariance = fit.covariance();
  for (Index j = 0; j < covariance.rows(); ++j) {
    const Parameter& one = fit.parameter(j);
    if (one.kind != Parameter::Kind::sensor_offset || !(covariance(j, j) < 1)) continue;
    const double precision = 1 / covariance(j, j) - 1, asked = fit.coordinates(j) / (precision * covariance(j, j));
    const ThermalNetwork::AddedEffect fault{result.effect, context.machine.sensors[one.item].column, "", {}};
    const double size = context.library.at(fault.effect).parameters(context.machine, fault)[0].sd / one.sd;
    const double tolerated = 1 / precision + 1, faulty = tolerated + size * size;
    const double odds = 0.5 * (std::log(tolerated / faulty) + asked * asked * (1 / tolerated - 1 / faulty));
    if (odds <= result.odds) continue;
    result.sensor = static_cast<Index>(one.item);
    result.odds = odds;
  }
  return result;
}

}  // namespace thermfit
