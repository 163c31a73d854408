#pragma once

#include <vector>

#include "thermfit/features/feature.hpp"
#include "thermfit/features/lag.hpp"

namespace thermfit {

/// Derived channels of one batch, rows x features, from the rises of its points (rows x points, K), its clock (rows
/// long; needed by lags only) and what the climate multiplies rises by. One pass a feature. Allocates the result.
template <typename Rises, typename Scalar = typename Rises::Scalar>
MatrixX<Scalar> feature_columns(const std::vector<Feature>& features, const Eigen::MatrixBase<Rises>& rises,
                                const VectorX<Scalar>& time_s, Scalar climate_factor) {
  MatrixX<Scalar> columns(rises.rows(), static_cast<Index>(features.size()));
  for (Index f = 0; f < columns.cols(); ++f) {
    const Feature& feature = features[static_cast<std::size_t>(f)];
    columns.col(f) = rises.col(feature.point);
    if (feature.kind == FeatureKind::lag)
      columns.col(f) = lagged(rises.col(feature.point), time_s, static_cast<Scalar>(60 * feature.lag_min));
    if (feature.kind == FeatureKind::climate) columns.col(f) *= climate_factor;
    if (feature.kind == FeatureKind::difference) columns.col(f) -= rises.col(feature.other);
  }
  return columns;
}

}  // namespace thermfit
