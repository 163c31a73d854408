#pragma once

#include <utility>

#include "thermfit/fit/residuals.hpp"
#include "thermfit/fit/standardisation.hpp"
#include "thermfit/model/latent_variables.hpp"
#include "thermfit/model/linear_model.hpp"

namespace thermfit {

/// What every fit returns: the model in um and K, and how it came about.
template <typename Scalar = double>
struct LinearFit {
  LinearModel<Scalar> model;                  ///< in um and K
  MatrixX<Scalar> standardised_coefficients;  ///< points x responses
  Standardisation<Scalar> channels;           ///< means and scales of the rows of the fit
  Index rows = 0;                             ///< that were fitted
  Index rank = 0;                             ///< independent directions among the temperatures
  Scalar condition_number = 1;     ///< largest over smallest singular value of the standardised temperatures, among
                                   ///< the `rank` independent directions
  Index components = 0;            ///< latent variables used; 0 for MLR and ridge
  double ridge_lambda = 0;         ///< penalty used; 0 for the others
  LatentVariables<Scalar> latent;  ///< PLS and PCR
  VectorX<Scalar> score_variance;  ///< of each latent variable, standardised units, divisor rows - 1
  Scalar degrees_of_freedom = 0;   ///< rows - 1 - parameters (MLR: rank; PLS, PCR: components; ridge: trace of the hat)
  VectorX<Scalar> residual_deviation_um;  ///< S of eq. (10) per error, on the rows of the fit
};

/// The model of what a fitter returned: a LinearFit or the bare LinearModel.
template <typename Scalar>
const LinearModel<Scalar>& model_of(const LinearFit<Scalar>& fit) {
  return fit.model;
}
/// A bare model is its own.
template <typename Scalar>
const LinearModel<Scalar>& model_of(const LinearModel<Scalar>& model) {
  return model;
}
/// A fit is its own.
template <typename Scalar>
LinearFit<Scalar> fit_of(LinearFit<Scalar> fit) {
  return fit;
}
/// A bare model as a fit of which nothing else is known.
template <typename Scalar>
LinearFit<Scalar> fit_of(LinearModel<Scalar> model) {
  LinearFit<Scalar> fit;
  fit.model = std::move(model);
  return fit;
}

/// Scores (latent variables) of rows: rows x points to rows x components, standardised units. Allocates the result.
template <typename Scalar, typename Temperatures>
MatrixX<Scalar> scores(const LinearFit<Scalar>& fit, const Eigen::MatrixBase<Temperatures>& temperatures) {
  return fit.channels.apply(temperatures) * fit.latent.rotations;
}

}  // namespace thermfit
