#pragma once

/// Root mean squares.

#include <cmath>
#include <vector>

#include "thermfit/lazy.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// sqrt(sum x^2 / n) of complete values, in their unit; 0 of none. Does not allocate.
template <typename Scalar = double>
Scalar rms_of(const Eigen::Ref<const Lazy<VectorX<Scalar>>>& values) {
  return values.size() ? std::sqrt(values.squaredNorm() / static_cast<Scalar>(values.size())) : 0;
}

/// The same over several series, missing samples (not finite) left out. Does not allocate.
inline double rms_of(const std::vector<Vector>& series) {
  double squares = 0, count = 0;
  for (const Vector& one : series)
    for (Index k = 0; k < one.size(); ++k)
      if (std::isfinite(one(k))) squares += one(k) * one(k), ++count;
  return count > 0 ? std::sqrt(squares / count) : 0;
}

}  // namespace thermfit
