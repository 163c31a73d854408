#pragma once

#include <cmath>
#include <string>

#include "thermfit/fit/options.hpp"
#include "thermfit/model/linear_model.hpp"
#include "thermfit/moments/moments.hpp"

namespace thermfit {

/// z = (value - mean) / scale per channel. Scale is 1 where nothing is scaled and for constant channels.
template <typename Scalar = double>
struct Standardisation {
  VectorX<Scalar> temperature_mean;   ///< per point, K of rise or degC
  VectorX<Scalar> temperature_scale;  ///< per point, K
  VectorX<Scalar> error_mean;         ///< per response, um
  VectorX<Scalar> error_scale;        ///< per response, um

  /// The model in um and K of standardised coefficients (points x responses):
  /// `coefficient_ij = b_ij error_scale_j / temperature_scale_i`, intercepts so that the means agree. Allocates it.
  template <typename Coefficients>
  LinearModel<Scalar> undo(const Eigen::MatrixBase<Coefficients>& coefficients) const {
    LinearModel<Scalar> model;
    model.coefficients =
        temperature_scale.cwiseInverse().asDiagonal() * coefficients.derived() * error_scale.asDiagonal();
    model.intercept = error_mean - model.coefficients.transpose() * temperature_mean;
    return model;
  }

  /// rows x points to standardised rows x points. Allocates the result.
  template <typename Temperatures>
  MatrixX<Scalar> apply(const Eigen::MatrixBase<Temperatures>& temperatures) const {
    return (temperatures.rowwise() - temperature_mean.transpose()) * temperature_scale.cwiseInverse().asDiagonal();
  }
};

/// Means and scales of `moments`. Fewer than two rows, no temperature or no error: Error. Allocates the result.
template <typename Scalar>
Standardisation<Scalar> standardisation(const Moments<Scalar>& moments, Scaling scaling) {
  if (moments.rows() < 2 || moments.temperatures() == 0 || moments.errors() == 0) {
    throw Error("fit",
                std::to_string(moments.rows()) + " rows of " + std::to_string(moments.temperatures()) +
                    " temperatures and " + std::to_string(moments.errors()) + " errors",
                "2 rows or more, 1 temperature or more, 1 error or more");
  }
  const auto deviation = [&](const auto& products, Index offset, bool wanted) {
    VectorX<Scalar> scale = VectorX<Scalar>::Ones(products.rows());
    for (Index c = 0; wanted && c < scale.size(); ++c) {
      const Scalar variance = products(c, c) / static_cast<Scalar>(moments.rows() - 1);
      if (!moments.constant(offset + c) && variance > 0) scale(c) = std::sqrt(variance);
    }
    return scale;
  };
  return {moments.temperature_mean(), deviation(moments.temperature_products(), 0, scaling != Scaling::centre),
          moments.error_mean(), deviation(moments.error_products(), moments.temperatures(), scaling == Scaling::both)};
}

}  // namespace thermfit
