#pragma once

#include "thermfit/controller/row.hpp"

namespace thermfit {

/// What a coefficient of a controller model is of; as FeatureKind of features/feature.hpp, in its order.
enum class ControllerFeatureKind : std::uint8_t {
  rise,       ///< of a sensor since the zero, K
  lag,        ///< the same through a first-order lag, K
  climate,    ///< the same times how far the session began from the mean climate of training, K^2
  difference  ///< rise of a sensor less that of another, K
};

/// One derived channel.
struct ControllerFeature {
  ControllerFeatureKind kind = ControllerFeatureKind::rise;  ///< what it is
  std::uint8_t sensor = 0;                                   ///< it is made of
  std::uint8_t other = 0;                                    ///< difference: the sensor taken off
  std::uint16_t lag = 0;                                     ///< lag: which of the model's

  /// Whether it is made of that sensor.
  constexpr bool of(std::size_t one) const noexcept {
    return sensor == one || (kind == ControllerFeatureKind::difference && other == one);
  }
};

/// The derived channels of a model, each a coefficient; their lags, and the climates it was trained in.
template <class Scalar, int Features, int Lags>
struct ControllerFeatures {
  Row<ControllerFeature, Features> channels{};  ///< in the order of coefficients; none: they are of the sensors
  Row<std::uint8_t, Lags> lag_sensor{};         ///< the sensor each lag is of
  Scalar climate_lowest_degC = 0;               ///< of the coldest batch of training
  Scalar climate_highest_degC = 0;              ///< of the warmest
  Scalar climate_mean_degC = 0;                 ///< over batches
};

/// A model on the sensors themselves has none.
template <class Scalar, int Lags>
struct ControllerFeatures<Scalar, 0, Lags> {};

/// How lags and sessions go on from step to step.
template <class Scalar, int Features, int Lags>
struct FeatureRule {
  Row<Scalar, Lags> lag_share{};        ///< of the way to its input that a lag goes in a step: 1 - exp(-period / lag)
  std::uint32_t session_steps = 14400;  ///< after a pause of so many steps a session begins: its climate is taken anew
};

/// Nothing goes on where there are no features.
template <class Scalar, int Lags>
struct FeatureRule<Scalar, 0, Lags> {};

/// How many numbers the coefficients of a model multiply.
constexpr int inputs_of(int sensors, int features) noexcept { return features == 0 ? sensors : features; }

/// Sizes that are not given: known at run time where the sensors are, else none.
constexpr int none_or_dynamic(int sensors) noexcept { return sensors == dynamic_size ? dynamic_size : 0; }

}  // namespace thermfit
