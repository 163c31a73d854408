#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/linearized.hpp"

namespace thermfit {

/// A machine fitted to a campaign: maximum a posteriori values of all its parameters and the noise of every channel.
struct MapFit {
  ThermalNetwork prior;  ///< the machine before the data: the means of the priors, effects complete
  std::vector<Parameter> parameters;
  Vector coordinates;                 ///< working coordinates: prior standard deviations from the prior's mean
  double prior_scale = 1;             ///< the machine's own priors are as wide as this times what its document says
  std::vector<ResidualNoise> noise;   ///< by channel
  std::vector<Simulation> simulated;  ///< without sensitivities
  ChannelResiduals residual;
  SummedEquations equations;
  double log_likelihood = 0;
  double log_posterior = 0;  ///< log_likelihood + log_prior(coordinates)
  double log_evidence = 0;   ///< Laplace: log_posterior - log|J'R^-1 J + precision| / 2
  int iterations = 0;
  bool converged = false;

  Vector values(const Vector& at) const {
    Vector result(at.size());
    for (Index j = 0; j < at.size(); ++j) result(j) = parameter(j).value(at(j));
    return result;
  }
  ThermalNetwork network_at(const Vector& at) const { return with_values(prior, parameters, values(at)); }
  ThermalNetwork network() const { return network_at(coordinates); }
  Vector slopes() const {
    Vector result(coordinates.size());
    for (Index j = 0; j < coordinates.size(); ++j) result(j) = parameter(j).slope(coordinates(j));
    return result;
  }
  const Parameter& parameter(Index j) const { return parameters[static_cast<std::size_t>(j)]; }

  /// Of the prior of each working coordinate.
  Vector precision() const {
    Vector result = Vector::Ones(static_cast<Index>(parameters.size()));
    for (Index j = 0; j < result.size(); ++j)
      if (parameter(j).of_machine()) result(j) /= prior_scale * prior_scale;
    return result;
  }
  double log_prior(const Vector& at) const {
    const Vector weight = precision();
    return 0.5 * (weight.array().log().sum() - weight.dot(at.cwiseAbs2()));
  }

  /// Sum over all batches, without the prior.
  NormalEquations total() const {
    NormalEquations result(coordinates.size());
    for (const NormalEquations& one : equations.by_batch) {
      result.information += one.information;
      result.score += one.score;
      result.squares += one.squares;
    }
    return result;
  }
  /// Of the working coordinates after the data: J'R^-1 J + precision.
  Matrix posterior_information() const {
    Matrix result = total().information;
    result.diagonal() += precision();
    return result;
  }
  Matrix covariance() const {
    return posterior_information().llt().solve(Matrix::Identity(coordinates.size(), coordinates.size()));
  }
};

struct MapFitOptions {
  int most_iterations = 30;
  double tolerance = 0.3;            ///< nats of log posterior an iteration must gain to go on
  std::vector<ResidualNoise> noise;  ///< to start from; empty: from the residual at the start
  Vector start;                      ///< working coordinates; empty: the prior's means
  double prior_scale = 1;            ///< see MapFit::prior_scale
  bool fit_prior_scale = false;      ///< whether it follows the data: by most evidence, never wider than documented
};

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

/// Minimises s't - t'As/2 style quadratics: the step of (information + damping) step = gradient that stays in the box,
/// by fixing the coordinates that would leave it.
inline Vector step_in_box(const Matrix& information, const Vector& gradient, const Vector& t, const Vector& low,
                          const Vector& high) {
  const Index n = t.size();
  std::vector<char> fixed(static_cast<std::size_t>(n), 0);
  Vector step = Vector::Zero(n);
  for (int pass = 0; pass < 4; ++pass) {
    std::vector<Index> free;
    Vector pushed = gradient;
    for (Index j = 0; j < n; ++j)
      if (fixed[static_cast<std::size_t>(j)])
        pushed -= step(j) * information.col(j);
      else
        free.push_back(j);
    const Index m = static_cast<Index>(free.size());
    if (m == 0) return step;
    Vector solution;
    if (m == n) {
      solution = information.llt().solve(pushed);
    } else {
      Matrix part(m, m);
      Vector right(m);
      for (Index i = 0; i < m; ++i) {
        right(i) = pushed(free[static_cast<std::size_t>(i)]);
        for (Index j = 0; j < m; ++j)
          part(i, j) = information(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
      }
      solution = part.llt().solve(right);
    }
    bool left = false;
    for (Index i = 0; i < m; ++i) {
      const Index j = free[static_cast<std::size_t>(i)];
      step(j) = solution(i);
      const double to = t(j) + step(j);
      if (to >= low(j) && to <= high(j)) continue;
      step(j) = std::clamp(to, low(j), high(j)) - t(j);
      fixed[static_cast<std::size_t>(j)] = 1;
      left = true;
    }
    if (!left) return step;
  }
  return step;
}

inline double whitened_squares(const ChannelResiduals& residual, const std::vector<std::vector<Whitener>>& whiteners) {
  double sum = 0;
  for (std::size_t c = 0; c < residual.size(); ++c)
    for (std::size_t b = 0; b < residual[c].size(); ++b) {
      Vector r = residual[c][b];
      whiteners[c][b].apply(r);
      sum += r.squaredNorm();
    }
  return sum;
}

inline bool all_finite(const MachineRecord& seen, const std::vector<Simulation>& simulated) {
  for (const ObservedChannel& channel : seen.channels)
    for (const Simulation& one : simulated)
      if (!one.channels.col(channel.column).allFinite()) return false;
  return true;
}

/// Least that MapFit::prior_scale may become: no machine document is exact.
constexpr double least_prior_scale = 0.2;

/// MapFit::prior_scale of most evidence near the present one: the mean square of the coordinates over the number of
/// them that the data determine (MacKay 1992).
inline double better_prior_scale(const MapFit& fit) {
  const Matrix covariance = fit.covariance();
  double squares = 0, determined = 0;
  for (Index j = 0; j < fit.coordinates.size(); ++j) {
    if (!fit.parameter(j).of_machine()) continue;
    squares += fit.coordinates(j) * fit.coordinates(j);
    determined += 1 - covariance(j, j) / (fit.prior_scale * fit.prior_scale);
  }
  return determined > 0 ? std::clamp(std::sqrt(squares / determined), least_prior_scale, 1.0) : fit.prior_scale;
}

}  // namespace detail

/// Noise of every channel from its residual, within the channel's bounds.
inline std::vector<ResidualNoise> noise_of(const MachineRecord& seen, const ChannelResiduals& residual,
                                           const std::vector<ResidualNoise>& start = {}) {
  std::vector<ResidualNoise> result;
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    result.push_back(
        estimate_noise(residual[c], seen.time_s, seen.channels[c].bounds, start.empty() ? nullptr : &start[c]));
  return result;
}

inline double log_likelihood(const MachineRecord& seen, const ChannelResiduals& residual,
                             const std::vector<ResidualNoise>& noise) {
  double sum = 0;
  for (std::size_t c = 0; c < residual.size(); ++c) sum += log_likelihood(noise[c], residual[c], seen.time_s);
  return sum;
}

/// Fits all calibration parameters of `machine`, those of its effects included, by maximum a posteriori.
///
/// Levenberg-Marquardt on the whitened residual, the noise of each channel estimated anew after every step, so that the
/// weights are those of a concentrated likelihood. Damping is in units of the prior. `machine` holds the means of the
/// priors. Where asked to, the width of the machine's own priors follows too once the rest has settled: too wide, they
/// let calibration swallow what a well-known machine lacks.
inline MapFit map_fit(const MachineRecord& seen, const ThermalNetwork& machine, const EffectLibrary& library,
                      const MapFitOptions& options = {}) {
  MapFit fit;
  fit.prior = with_complete_effects(machine, library);
  fit.parameters = calibration_parameters(fit.prior, library);
  const Index n = static_cast<Index>(fit.parameters.size());
  Vector low(n), high(n);
  for (Index j = 0; j < n; ++j) std::tie(low(j), high(j)) = detail::coordinate_range(fit.parameter(j));
  fit.coordinates = options.start.size() == n ? options.start : Vector::Zero(n);
  fit.coordinates = fit.coordinates.cwiseMax(low).cwiseMin(high);
  fit.prior_scale = options.prior_scale;

  const auto simulated_at = [&](const Vector& t) {
    return simulate(fit.network_at(t), seen.excitations, library, fit.parameters);
  };
  fit.simulated = simulated_at(fit.coordinates);
  fit.residual = residuals_of(seen, fit.simulated);
  fit.noise = noise_of(seen, fit.residual, options.noise);
  const auto posterior = [&] { return log_likelihood(seen, fit.residual, fit.noise) + fit.log_prior(fit.coordinates); };
  fit.log_posterior = posterior();

  double damping = 1e-2;
  int trials_of_prior_scale = options.fit_prior_scale ? 4 : 0;
  const Matrix identity = Matrix::Identity(n, n);
  for (fit.iterations = 0; fit.iterations < options.most_iterations && !fit.converged; ++fit.iterations) {
    const auto whiteners = whiteners_of(seen, fit.noise);
    fit.equations = summed_equations(linearized(seen, fit.simulated, fit.slopes(), whiteners));
    const NormalEquations total = fit.total();
    const Vector precision = fit.precision();
    const Matrix information = fit.posterior_information();
    const Vector gradient = total.score - precision.cwiseProduct(fit.coordinates);
    const double cost = total.squares + precision.dot(fit.coordinates.cwiseAbs2());
    bool accepted = false;
    for (int attempt = 0; attempt < 8 && !accepted; ++attempt) {
      const Vector step = detail::step_in_box(information + damping * identity, gradient, fit.coordinates, low, high);
      const Vector t = fit.coordinates + step;
      std::vector<Simulation> trial = simulated_at(t);
      if (detail::all_finite(seen, trial)) {
        ChannelResiduals residual = residuals_of(seen, trial);
        if (detail::whitened_squares(residual, whiteners) + precision.dot(t.cwiseAbs2()) < cost) {
          fit.coordinates = t;
          fit.simulated = std::move(trial);
          fit.residual = std::move(residual);
          accepted = true;
        }
      }
      damping = accepted ? std::max(damping / 5, 1e-7) : damping * 8;
    }
    if (accepted) fit.noise = noise_of(seen, fit.residual, fit.noise);
    const double reached = posterior();
    fit.converged = !accepted || reached - fit.log_posterior < options.tolerance;
    fit.log_posterior = reached;
    if (!fit.converged || trials_of_prior_scale-- <= 0) continue;
    const double prior_scale = detail::better_prior_scale(fit);
    if (std::abs(std::log(prior_scale / fit.prior_scale)) < 0.1) continue;
    fit.prior_scale = prior_scale;
    fit.log_posterior = posterior();
    fit.converged = false;
  }
  fit.equations = summed_equations(linearized(seen, fit.simulated, fit.slopes(), whiteners_of(seen, fit.noise)));
  for (Simulation& one : fit.simulated) one.jacobian.resize(0, 0);
  fit.log_likelihood = log_likelihood(seen, fit.residual, fit.noise);
  fit.log_posterior = fit.log_likelihood + fit.log_prior(fit.coordinates);
  const Eigen::LLT<Matrix> factor(fit.posterior_information());
  fit.log_evidence = fit.log_posterior - Matrix(factor.matrixL()).diagonal().array().log().sum();
  return fit;
}

}  // namespace thermfit
