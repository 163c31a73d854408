#pragma once

#include <string>
#include <vector>

#include "thermfit/number.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// What a derived channel is made of.
enum class FeatureKind {
  rise,       ///< of a temperature since the first row of its batch, K
  lag,        ///< the same through a first-order lag, K
  climate,    ///< the same times how far the batch started from the mean climate of training, K^2
  difference  ///< rise of a temperature less that of another, K
};

/// A channel derived from temperatures, linear in known columns once its lag is known, so that moments carry it as
/// they carry a point.
struct Feature {
  FeatureKind kind = FeatureKind::rise;  ///< what it is
  Index point = 0;                       ///< temperature it is made of
  Index other = -1;                      ///< difference: the temperature taken off
  double lag_min = 0;                    ///< lag: its time constant
};

/// `T3`, `T3 lag 20 min`, `T3 x climate`, `T3 - T5`, from the names of the temperatures. Allocates the text.
inline std::string name(const Feature& feature, const std::vector<std::string>& temperatures) {
  const std::string& point = temperatures[static_cast<std::size_t>(feature.point)];
  switch (feature.kind) {
    case FeatureKind::lag:
      return point + " lag " + exact_text(feature.lag_min) + " min";
    case FeatureKind::climate:
      return point + " x climate";
    case FeatureKind::difference:
      return point + " - " + temperatures[static_cast<std::size_t>(feature.other)];
    case FeatureKind::rise:
      break;
  }
  return point;
}

}  // namespace thermfit
