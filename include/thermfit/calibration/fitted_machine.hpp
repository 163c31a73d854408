#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "thermfit/calibration/linearized.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/lazy.hpp"

namespace thermfit {

/// A machine fitted to a campaign: maximum a posteriori values of all its parameters and the noise of every channel.
struct MapFit {
  ThermalNetwork prior;               ///< the machine before the data: the means of the priors, effects complete
  std::vector<Parameter> parameters;  ///< what was fitted
  Vector coordinates;                 ///< working coordinates: prior standard deviations from the prior's mean
  double prior_scale = 1;             ///< the machine's own priors are as wide as this times what its document says
  std::vector<ResidualNoise> noise;   ///< by channel
  std::vector<Simulation> simulated;  ///< without sensitivities
  ChannelResiduals residual;          ///< measured minus simulated
  SummedEquations equations;          ///< at the coordinates
  double log_likelihood = 0;          ///< nats, without the constant of 2 pi
  double log_posterior = 0;           ///< log_likelihood + log_prior(coordinates)
  double log_evidence = 0;            ///< Laplace: log_posterior - log|J'R^-1 J + precision| / 2
  int iterations = 0;                 ///< of Levenberg-Marquardt
  bool converged = false;             ///< before they ran out

  /// The parameters' values at working coordinates, in their own units. Allocates.
  Vector values(const Vector& at) const {
    Vector result(at.size());
    for (Index j = 0; j < at.size(); ++j) result(j) = parameter(j).value(at(j));
    return result;
  }
  /// The machine at working coordinates. Allocates.
  ThermalNetwork network_at(const Vector& at) const { return with_values(prior, parameters, values(at)); }
  /// The fitted machine. Allocates.
  ThermalNetwork network() const { return network_at(coordinates); }
  /// d(value)/d(coordinate) of each parameter at the coordinates. Allocates.
  Vector slopes() const {
    Vector result(coordinates.size());
    for (Index j = 0; j < coordinates.size(); ++j) result(j) = parameter(j).slope(coordinates(j));
    return result;
  }
  /// The parameter of coordinate j.
  const Parameter& parameter(Index j) const { return parameters[static_cast<std::size_t>(j)]; }

  /// Of the prior of each working coordinate.
  template <typename Scalar = double>
  VectorX<Scalar> precision() const {
    VectorX<Scalar> result = VectorX<Scalar>::Ones(static_cast<Index>(parameters.size()));
    for (Index j = 0; j < result.size(); ++j)
      if (parameter(j).of_machine()) result(j) /= prior_scale * prior_scale;
    return result;
  }
  /// log density of the prior at working coordinates, without the constant of 2 pi.
  template <typename Scalar = double>
  double log_prior(const Lazy<VectorX<Scalar>>& at) const {
    const VectorX<Scalar> weight = precision<Scalar>();
    return 0.5 * (weight.array().log().sum() - weight.dot(at.cwiseAbs2()));
  }

  /// Sum over all batches, without the prior.
  template <typename Scalar = double>
  NormalEquations total() const {
    NormalEquations result(coordinates.size());
    for (const NormalEquations& one : equations.by_batch) result.operator+=<Scalar>(one);
    return result;
  }
  /// Of the working coordinates after the data: J'R^-1 J + precision.
  template <typename Scalar = double>
  MatrixX<Scalar> posterior_information() const;
  /// Of the working coordinates after the data: the inverse of posterior_information().
  template <typename Scalar = double>
  MatrixX<Scalar> covariance() const;
};

template <typename Scalar>
MatrixX<Scalar> MapFit::posterior_information() const {
  MatrixX<Scalar> result = total<Scalar>().information;
  result.diagonal() += precision<Scalar>();
  return result;
}

template <typename Scalar>
MatrixX<Scalar> MapFit::covariance() const {
  const Index n = coordinates.size();
  return posterior_information<Scalar>().llt().solve(MatrixX<Scalar>::Identity(n, n));
}

THERMFIT_COMPILED_TEMPLATE(Matrix MapFit::posterior_information<double>() const);
THERMFIT_COMPILED_TEMPLATE(Matrix MapFit::covariance<double>() const);

namespace detail {

/// Coordinates between which a parameter may move.
inline std::pair<double, double> coordinate_range(const Parameter& parameter) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const auto at = [&](double value, double open) {
    if (!std::isfinite(value)) return open;
    const double t = parameter.coordinate(value);
    return std::isfinite(t) ? t : open;
  };
  // Ten prior standard deviations are beyond belief, and beyond what the exponential of a logarithm should be asked.
  const double wide = parameter.logarithmic ? 10 : inf;
  return {std::max(-wide, at(parameter.lower, -inf)), std::min(wide, at(parameter.upper, inf))};
}

}  // namespace detail

}  // namespace thermfit
