#pragma once

/// Ways in which a column can be written down that are not thermfit's own, as maps of what was measured onto what is
/// simulated.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/constants.hpp"

namespace thermfit {

/// A column written down differently on one of the sides: simulated = scale measured + shift.
struct Reading {
  std::string unit;        ///< what the column of that side seems to hold: "mm"; "" for thermfit's own
  bool simulated = false;  ///< the simulator's column, else the measured one
  bool turned = false;     ///< the signs of the two sides differ
  double scale = 1;        ///< as above
  double shift = 0;        ///< as above, degC

  /// Nothing but thermfit's own unit.
  bool as_given() const { return unit.empty() && !turned; }
};

/// Every way in which a temperature can be written: kelvin, degrees Fahrenheit, tenths, hundredths or thousandths of a
/// degree, on either side. The first is as given. Allocates.
inline std::vector<Reading> temperature_readings() {
  std::vector<Reading> result{{}};
  struct Way {
    const char* unit;
    double scale, shift;  // degC = scale value + shift
  };
  for (const Way& way : {Way{"K", 1, -ice_point_K}, Way{"degF", 5. / 9, -160. / 9}, Way{"0.1 degC", .1, 0},
                         Way{"0.01 degC", .01, 0}, Way{"0.001 degC", .001, 0}}) {
    result.push_back({way.unit, false, false, way.scale, way.shift});
    result.push_back({way.unit, true, false, 1 / way.scale, -way.shift / way.scale});
  }
  return result;
}

/// A unit of length; "counts" stand for every other factor.
struct LengthUnit {
  const char* name;  ///< as in a header
  double um;         ///< how many micrometres it is
};
/// Units in which displacements are written down, from the smallest.
constexpr std::array<LengthUnit, 6> length_units{
    {{"nm", 1e-3}, {"0.1 um", .1}, {"um", 1}, {"mm", 1e3}, {"in", 25400}, {"m", 1e6}}};

}  // namespace thermfit
