#pragma once

#include <utility>

#include "thermfit/fit/residuals.hpp"
#include "thermfit/fit/standardise.hpp"
#include "thermfit/model/latent_variables.hpp"
#include "thermfit/model/linear_model.hpp"

namespace thermfit {

/// What every fit returns: the model in um and K, and how it came about.
struct LinearFit {
  LinearModel<> model;
  Matrix standardised_coefficients;  ///< points x responses
  Standardisation channels;
  Index rows = 0;
  Index rank = 0;                 ///< independent directions among the temperatures
  double condition_number = 1;    ///< largest over smallest singular value of the standardised temperatures, among
                                  ///< the `rank` independent directions
  Index components = 0;           ///< latent variables used; 0 for MLR and ridge
  double ridge_lambda = 0;        ///< penalty used; 0 for the others
  LatentVariables latent;         ///< PLS and PCR
  Vector score_variance;          ///< of each latent variable, standardised units, divisor rows - 1
  double degrees_of_freedom = 0;  ///< rows - 1 - parameters (MLR: rank; PLS, PCR: components; ridge: trace of the hat)
  Vector residual_deviation_um;   ///< S of eq. (10) per error, on the rows of the fit
};

/// A fitter may return a LinearFit or the bare LinearModel<>: either as a model, either as a fit.
inline const LinearModel<>& model_of(const LinearFit& fit) { return fit.model; }
inline const LinearModel<>& model_of(const LinearModel<>& model) { return model; }
inline LinearFit fit_of(LinearFit fit) { return fit; }
inline LinearFit fit_of(LinearModel<> model) {
  LinearFit fit;
  fit.model = std::move(model);
  return fit;
}

/// Scores (latent variables) of rows: rows x points to rows x components, standardised units.
inline Matrix scores(const LinearFit& fit, const Matrix& temperatures) {
  return fit.channels.apply(temperatures) * fit.latent.rotations;
}

}  // namespace thermfit
