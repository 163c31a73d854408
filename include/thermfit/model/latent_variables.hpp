#pragma once

#include "thermfit/types.hpp"

namespace thermfit {

/// The latent variables behind a PLS or PCR model, in standardised units; empty for MLR and ridge.
struct LatentVariables {
  Matrix weights, loadings, rotations;                              ///< sensors x components
  Matrix error_loadings;                                            ///< errors x components
  Vector explained_temperature_variance, explained_error_variance;  ///< cumulative share per component, 0…1
  Vector vip;                                                       ///< per sensor
};

}  // namespace thermfit
