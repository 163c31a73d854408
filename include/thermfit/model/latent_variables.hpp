#pragma once

#include "thermfit/types.hpp"

namespace thermfit {

/// The latent variables behind a PLS or PCR model, in standardised units; empty for MLR and ridge.
template <typename Scalar = double>
struct LatentVariables {
  MatrixX<Scalar> weights;                         ///< sensors x components
  MatrixX<Scalar> loadings;                        ///< sensors x components
  MatrixX<Scalar> rotations;                       ///< sensors x components
  MatrixX<Scalar> error_loadings;                  ///< errors x components
  VectorX<Scalar> explained_temperature_variance;  ///< cumulative share per component, 0…1
  VectorX<Scalar> explained_error_variance;        ///< cumulative share per component, 0…1
  VectorX<Scalar> vip;                             ///< per sensor

  /// The same, rounded to Other.
  template <typename Other>
  LatentVariables<Other> cast() const {
    const auto to = [](const auto& numbers) { return numbers.template cast<Other>(); };
    return {to(weights),
            to(loadings),
            to(rotations),
            to(error_loadings),
            to(explained_temperature_variance),
            to(explained_error_variance),
            to(vip)};
  }
};

}  // namespace thermfit
