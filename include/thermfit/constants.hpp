#pragma once

/// Numbers of mathematics and physics that more than one header needs.

namespace thermfit {

/// Half the circumference of the unit circle.
constexpr double pi = 3.14159265358979323846;

/// 0 degC on the thermodynamic scale, K.
constexpr double ice_point_K = 273.15;

/// The lowest temperature there is, degC.
constexpr double absolute_zero_degC = -ice_point_K;

}  // namespace thermfit
