#pragma once

#include <vector>

#include "thermfit/features/feature.hpp"
#include "thermfit/features/lag.hpp"

namespace thermfit {

/// Derived channels of one batch, rows x features, from the rises of its points (rows x points, K), its clock (rows
/// long; needed by lags only), what the climate multiplies rises by, and its known inputs (rows x inputs, in their
/// units; needed by features of inputs only). One pass a feature. Allocates the result.
template <typename Rises, typename Scalar = typename Rises::Scalar>
MatrixX<Scalar> feature_columns(const std::vector<Feature>& features, const Eigen::MatrixBase<Rises>& rises,
                                const VectorX<Scalar>& time_s, Scalar climate_factor,
                                const MatrixX<Scalar>& inputs = {}) {
  MatrixX<Scalar> columns(rises.rows(), static_cast<Index>(features.size()));
  for (Index f = 0; f < columns.cols(); ++f) {
    const Feature& feature = features[static_cast<std::size_t>(f)];
    if (of_input(feature.kind)) {
      if (rises.rows() == 0) continue;
      if (feature.kind == FeatureKind::input)
        columns.col(f) = inputs.col(feature.point).array() - inputs(0, feature.point);
      else
        columns.col(f) = lagged(inputs.col(feature.point), time_s, static_cast<Scalar>(60 * feature.lag_min));
      continue;
    }
    columns.col(f) = rises.col(feature.point);
    if (feature.kind == FeatureKind::lag)
      columns.col(f) = lagged(rises.col(feature.point), time_s, static_cast<Scalar>(60 * feature.lag_min));
    if (feature.kind == FeatureKind::climate) columns.col(f) *= climate_factor;
    if (feature.kind == FeatureKind::difference) columns.col(f) -= rises.col(feature.other);
  }
  return columns;
}

}  // namespace thermfit
