#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "thermfit/calibration/fitted_machine.hpp"
#include "thermfit/calibration/linearized.hpp"
#include "thermfit/calibration/step_in_box.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/lazy.hpp"

namespace thermfit {

/// How map_fit() searches.
struct MapFitOptions {
  int most_iterations = 30;          ///< of Levenberg-Marquardt
  double tolerance = 0.3;            ///< nats of log posterior an iteration must gain to go on
  std::vector<ResidualNoise> noise;  ///< to start from; empty: from the residual at the start
  Vector start;                      ///< working coordinates; empty: the prior's means
  double prior_scale = 1;            ///< see MapFit::prior_scale
  bool fit_prior_scale = false;      ///< whether it follows the data: by most evidence, never wider than documented
};

namespace detail {

template <typename Scalar>
double whitened_squares(const ChannelResiduals& residual, const std::vector<std::vector<Whitener>>& whiteners) {
  double sum = 0;
  for (std::size_t c = 0; c < residual.size(); ++c)
    for (std::size_t b = 0; b < residual[c].size(); ++b) {
      VectorX<Scalar> r = residual[c][b];
      whiteners[c][b].apply(r);
      sum += r.squaredNorm();
    }
  return sum;
}

template <typename Scalar = double>
bool all_finite(const MachineRecord& seen, const std::vector<Simulation>& simulated) {
  for (const ObservedChannel& channel : seen.channels)
    for (const Lazy<Simulation, Scalar>& one : simulated)
      if (!one.channels.col(channel.column).allFinite()) return false;
  return true;
}

/// Least that MapFit::prior_scale may become: no machine document is exact.
constexpr double least_prior_scale = 0.2;

/// MapFit::prior_scale of most evidence near the present one: the mean square of the coordinates over the number of
/// them that the data determine (MacKay 1992).
template <typename Scalar>
double better_prior_scale(const MapFit& fit) {
  const MatrixX<Scalar> covariance = fit.covariance<Scalar>();
  double squares = 0, determined = 0;
  for (Index j = 0; j < fit.coordinates.size(); ++j) {
    if (!fit.parameter(j).of_machine()) continue;
    squares += fit.coordinates(j) * fit.coordinates(j);
    determined += 1 - covariance(j, j) / (fit.prior_scale * fit.prior_scale);
  }
  return determined > 0 ? std::clamp(std::sqrt(squares / determined), least_prior_scale, 1.0) : fit.prior_scale;
}

}  // namespace detail

/// Noise of every channel from its residual, within the channel's bounds. `start`, where given, is by channel too.
/// Allocates.
template <typename Scalar = double>
std::vector<ResidualNoise> noise_of(const MachineRecord& seen, const ChannelResiduals& residual,
                                    const std::vector<ResidualNoise>& start = {}) {
  std::vector<ResidualNoise> result;
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    result.push_back(
        estimate_noise<Scalar>(residual[c], seen.time_s, seen.channels[c].bounds, start.empty() ? nullptr : &start[c]));
  return result;
}

/// log density of all residuals under the noise of their channels, nats.
template <typename Scalar = double>
double log_likelihood(const MachineRecord& seen, const ChannelResiduals& residual,
                      const std::vector<ResidualNoise>& noise) {
  double sum = 0;
  for (std::size_t c = 0; c < residual.size(); ++c) sum += log_likelihood<Scalar>(noise[c], residual[c], seen.time_s);
  return sum;
}

namespace detail {

/// A MapFit on its way: Levenberg-Marquardt with damping in units of the prior.
template <typename Scalar>
class MapSearch {
 public:
  MapSearch(const Lazy<MachineRecord, Scalar>& seen, const ThermalNetwork& machine, const EffectLibrary& library,
            const Lazy<MapFitOptions, Scalar>& options)
      : seen_(seen), library_(library) {
    fit_.prior = with_complete_effects(machine, library);
    fit_.parameters = calibration_parameters<Scalar>(fit_.prior, library);
    const Index n = static_cast<Index>(fit_.parameters.size());
    low_.resize(n), high_.resize(n);
    for (Index j = 0; j < n; ++j) std::tie(low_(j), high_(j)) = coordinate_range(fit_.parameter(j));
    fit_.coordinates = options.start.size() == n ? options.start : VectorX<Scalar>::Zero(n);
    fit_.coordinates = fit_.coordinates.cwiseMax(low_).cwiseMin(high_);
    fit_.prior_scale = options.prior_scale;
    fit_.simulated = simulated_at(fit_.coordinates);
    fit_.residual = residuals_of<Scalar>(seen, fit_.simulated);
    fit_.noise = noise_of<Scalar>(seen, fit_.residual, options.noise);
    fit_.log_posterior = log_posterior();
  }

  bool converged() const { return fit_.converged; }

  /// One accepted step, or none where eight dampings find nothing better; the noise anew. Converged where the log
  /// posterior gained less than `tolerance`.
  void step(double tolerance) {
    const auto whiteners = whiteners_of(seen_, fit_.noise);
    fit_.equations = summed_equations<Scalar>(linearized<Scalar>(seen_, fit_.simulated, fit_.slopes(), whiteners));
    const Lazy<NormalEquations, Scalar> total = fit_.total();
    const VectorX<Scalar> precision = fit_.precision();
    const MatrixX<Scalar> information = fit_.posterior_information();
    const VectorX<Scalar> gradient = total.score - precision.cwiseProduct(fit_.coordinates);
    const double cost = total.squares + precision.dot(fit_.coordinates.cwiseAbs2());
    const Index n = gradient.size();
    const MatrixX<Scalar> identity = MatrixX<Scalar>::Identity(n, n);
    bool accepted = false;
    for (int attempt = 0; attempt < 8 && !accepted; ++attempt) {
      const VectorX<Scalar> step =
          step_in_box<Scalar>(information + damping_ * identity, gradient, fit_.coordinates, low_, high_);
      const VectorX<Scalar> t = fit_.coordinates + step;
      std::vector<Simulation> trial = simulated_at(t);
      if (all_finite<Scalar>(seen_, trial)) {
        ChannelResiduals residual = residuals_of<Scalar>(seen_, trial);
        if (whitened_squares<Scalar>(residual, whiteners) + precision.dot(t.cwiseAbs2()) < cost) {
          fit_.coordinates = t;
          fit_.simulated = std::move(trial);
          fit_.residual = std::move(residual);
          accepted = true;
        }
      }
      damping_ = accepted ? std::max(damping_ / 5, 1e-7) : damping_ * 8;
    }
    if (accepted) fit_.noise = noise_of<Scalar>(seen_, fit_.residual, fit_.noise);
    const double reached = log_posterior();
    fit_.converged = !accepted || reached - fit_.log_posterior < tolerance;
    fit_.log_posterior = reached;
    ++fit_.iterations;
  }

  /// Lets MapFit::prior_scale follow the data; where it moves by a tenth, the search goes on.
  void follow_prior_scale() {
    const double prior_scale = better_prior_scale<Scalar>(fit_);
    if (std::abs(std::log(prior_scale / fit_.prior_scale)) < 0.1) return;
    fit_.prior_scale = prior_scale;
    fit_.log_posterior = log_posterior();
    fit_.converged = false;
  }

  /// The fit with its equations and its evidence, the sensitivities dropped.
  MapFit finished() && {
    fit_.equations = summed_equations<Scalar>(
        linearized<Scalar>(seen_, fit_.simulated, fit_.slopes(), whiteners_of(seen_, fit_.noise)));
    for (auto& one : fit_.simulated) one.jacobian.resize(0, 0);
    fit_.log_likelihood = log_likelihood<Scalar>(seen_, fit_.residual, fit_.noise);
    fit_.log_posterior = fit_.log_likelihood + fit_.log_prior(fit_.coordinates);
    const Eigen::LLT<MatrixX<Scalar>> factor(fit_.posterior_information());
    fit_.log_evidence = fit_.log_posterior - MatrixX<Scalar>(factor.matrixL()).diagonal().array().log().sum();
    return std::move(fit_);
  }

 private:
  std::vector<Simulation> simulated_at(const VectorX<Scalar>& t) const {
    return simulate<Scalar>(fit_.network_at(t), seen_.excitations, library_, fit_.parameters);
  }
  double log_posterior() const {
    return log_likelihood<Scalar>(seen_, fit_.residual, fit_.noise) + fit_.log_prior(fit_.coordinates);
  }

  const Lazy<MachineRecord, Scalar>& seen_;
  const EffectLibrary& library_;
  Lazy<MapFit, Scalar> fit_;
  VectorX<Scalar> low_, high_;
  double damping_ = 1e-2;
};

}  // namespace detail

/// Fits all calibration parameters of `machine`, those of its effects included, by maximum a posteriori.
///
/// Levenberg-Marquardt on the whitened residual, the noise of each channel estimated anew after every step, so that the
/// weights are those of a concentrated likelihood. Damping is in units of the prior. `machine` holds the means of the
/// priors. Where asked to, the width of the machine's own priors follows too once the rest has settled: too wide, they
/// let calibration swallow what a well-known machine lacks. Throws Error as simulate() does. Allocates.
template <typename Scalar = double>
MapFit map_fit(const MachineRecord& seen, const ThermalNetwork& machine, const EffectLibrary& library,
               const MapFitOptions& options = {}) {
  detail::MapSearch<Scalar> search(seen, machine, library, options);
  int trials_of_prior_scale = options.fit_prior_scale ? 4 : 0;
  for (int k = 0; k < options.most_iterations && !search.converged(); ++k) {
    search.step(options.tolerance);
    if (search.converged() && trials_of_prior_scale-- > 0) search.follow_prior_scale();
  }
  return std::move(search).finished();
}

THERMFIT_COMPILED_TEMPLATE(MapFit map_fit<double>(const MachineRecord&, const ThermalNetwork&, const EffectLibrary&,
                                                  const MapFitOptions&));

}  // namespace thermfit
