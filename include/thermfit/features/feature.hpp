#pragma once

#include <string>
#include <vector>

#include "thermfit/number.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// What a derived channel is made of.
enum class FeatureKind {
  rise,        ///< of a temperature since the first row of its batch, K
  lag,         ///< the same through a first-order lag, K
  climate,     ///< the same times how far the batch started from the mean climate of training, K^2
  difference,  ///< rise of a temperature less that of another, K
  input,       ///< change of a known input since the first row of its batch, in its unit
  input_lag    ///< a known input through a first-order lag from 0 at the first row, in its unit
};

/// Whether `kind` is made of a known input, not of a temperature. Does not allocate.
inline bool of_input(FeatureKind kind) { return kind == FeatureKind::input || kind == FeatureKind::input_lag; }

/// A channel derived from temperatures or known inputs, linear in known columns once its lag is known, so that moments
/// carry it as they carry a point.
struct Feature {
  FeatureKind kind = FeatureKind::rise;  ///< what it is
  Index point = 0;                       ///< temperature it is made of, or known input
  Index other = -1;                      ///< difference: the temperature taken off
  double lag_min = 0;                    ///< lags: their time constant

  /// Whether it is made of temperature `one`. Does not allocate.
  bool is_of(Index one) const {
    return !of_input(kind) && (point == one || (kind == FeatureKind::difference && other == one));
  }
};

/// `T3`, `T3 lag 20 min`, `T3 x climate`, `T3 - T5`, `n_spindle`, `n_spindle lag 20 min`, from the names of the
/// temperatures and of the known inputs. Allocates the text.
inline std::string name(const Feature& feature, const std::vector<std::string>& temperatures,
                        const std::vector<std::string>& inputs = {}) {
  const std::string& point = (of_input(feature.kind) ? inputs : temperatures)[static_cast<std::size_t>(feature.point)];
  switch (feature.kind) {
    case FeatureKind::lag:
    case FeatureKind::input_lag:
      return point + " lag " + exact_text(feature.lag_min) + " min";
    case FeatureKind::climate:
      return point + " x climate";
    case FeatureKind::difference:
      return point + " - " + temperatures[static_cast<std::size_t>(feature.other)];
    case FeatureKind::rise:
    case FeatureKind::input:
      break;
  }
  return point;
}

}  // namespace thermfit
