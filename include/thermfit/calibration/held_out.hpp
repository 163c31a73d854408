#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "thermfit/calibration/lone_input.hpp"
#include "thermfit/calibration/map_fit.hpp"

namespace thermfit {

/// Batches left out together, one set a fold.
using Folds = std::vector<std::vector<std::size_t>>;

/// Every batch left out once: alone up to `most_folds` batches, else every most_folds-th together, so that each fold
/// keeps all conditions. A batch that alone drives an input judges nothing and stays with the others. Fewer than two
/// batches leave nothing to judge by: no folds. Allocates.
template <typename Scalar = double>
Folds folds_of(const ThermalNetwork& network, const MachineRecord& seen, std::size_t most_folds = 12) {
  std::vector<std::size_t> judges;
  const std::vector<LoneInput> lone = lone_inputs<Scalar>(network, seen);
  for (std::size_t b = 0; b < seen.batches(); ++b)
    if (std::none_of(lone.begin(), lone.end(), [&](const LoneInput& one) { return one.batch == b; }))
      judges.push_back(b);
  if (judges.size() < 2) return {};
  Folds result(std::min(judges.size(), most_folds));
  for (std::size_t k = 0; k < judges.size(); ++k) result[k % result.size()].push_back(judges[k]);
  return result;
}

/// What a model leaves on batches that did not take part in fitting it.
struct HeldOut {
  ChannelResiduals residual;         ///< measured minus predicted
  std::vector<ResidualNoise> noise;  ///< of this residual
  double log_score = 0;              ///< log predictive density of all channels
  Vector by_channel;                 ///< the same by channel
};

/// Such residuals with their noise and their scores; `start` as in noise_of(). Allocates.
template <typename Scalar = double>
HeldOut scored(const MachineRecord& seen, ChannelResiduals residual, const std::vector<ResidualNoise>& start) {
  Lazy<HeldOut, Scalar> result;
  result.noise = noise_of<Scalar>(seen, residual, start);
  result.by_channel.resize(static_cast<Index>(residual.size()));
  for (std::size_t c = 0; c < residual.size(); ++c)
    result.by_channel(static_cast<Index>(c)) = log_likelihood<Scalar>(result.noise[c], residual[c], seen.time_s);
  result.log_score = result.by_channel.sum();
  result.residual = std::move(residual);
  return result;
}

/// Working coordinates fitted without some batches: a Gauss-Newton step away from the fit to all of them, with the
/// normal equations of the left-out batches subtracted, damped until the training batches agree with it.
/// n long; `whiteners` by channel and batch. Allocates.
template <typename Scalar = double>
VectorX<Scalar> coordinates_without(const Lazy<MachineRecord, Scalar>& seen, const Lazy<MapFit, Scalar>& fit,
                                    const EffectLibrary& library, const std::vector<std::size_t>& left_out,
                                    const std::vector<std::vector<Whitener>>& whiteners) {
  Lazy<NormalEquations, Scalar> kept = fit.total();
  for (const std::size_t b : left_out) kept -= fit.equations.by_batch[b];
  const Index n = fit.coordinates.size();
  VectorX<Scalar> low(n), high(n);
  for (Index j = 0; j < n; ++j) std::tie(low(j), high(j)) = detail::coordinate_range(fit.parameter(j));
  const VectorX<Scalar> precision = fit.precision();
  MatrixX<Scalar> information = kept.information;
  information.diagonal() += precision;

  std::vector<Excitation> training;
  std::vector<std::size_t> batches;
  for (std::size_t b = 0; b < seen.batches(); ++b)
    if (std::find(left_out.begin(), left_out.end(), b) == left_out.end()) {
      training.push_back(seen.excitations[b]);
      batches.push_back(b);
    }
  const auto cost = [&](const VectorX<Scalar>& t) {
    const Lazy<std::vector<Simulation>, Scalar> simulated = simulate<Scalar>(fit.network_at(t), training, library);
    double sum = precision.dot(t.cwiseAbs2());
    for (std::size_t i = 0; i < batches.size(); ++i)
      for (std::size_t c = 0; c < seen.channels.size(); ++c) {
        VectorX<Scalar> r = seen.channels[c].measured[batches[i]] - simulated[i].channels.col(seen.channels[c].column);
        whiteners[c][batches[i]].apply(r);
        sum += r.squaredNorm();
      }
    return sum;
  };
  double before = precision.dot(fit.coordinates.cwiseAbs2());
  for (const std::size_t b : batches) before += fit.equations.by_batch[b].squares;
  const MatrixX<Scalar> identity = MatrixX<Scalar>::Identity(n, n);
  for (double damping = 0; damping<1e6; damping = damping> 0 ? 30 * damping : 0.3) {
    const VectorX<Scalar> step =
        step_in_box<Scalar>(information + damping * identity, kept.score - precision.cwiseProduct(fit.coordinates),
                            fit.coordinates, low, high);
    const double after = cost(fit.coordinates + step);
    if (std::isfinite(after) && after < before) return fit.coordinates + step;
  }
  return fit.coordinates;
}

/// The fitted machine at coordinates, the numbers of the batch `b` alone (Parameter::of_batch) fitted to that batch: no
/// other batch can tell them. They enter linearly, so that two Gauss-Newton steps suffice. Allocates.
template <typename Scalar = double>
ThermalNetwork with_own_numbers(const Lazy<MachineRecord, Scalar>& seen, const Lazy<MapFit, Scalar>& fit,
                                const EffectLibrary& library, const Lazy<VectorX<Scalar>>& coordinates, std::size_t b,
                                const std::vector<std::vector<Whitener>>& whiteners) {
  ThermalNetwork network = fit.network_at(coordinates);
  std::vector<Parameter> own;
  for (const Parameter& one : fit.parameters)
    if (one.of_batch() && one.item == b) own.push_back(one);
  const Index n = static_cast<Index>(own.size());
  if (n == 0) return network;
  VectorX<Scalar> t = VectorX<Scalar>::Zero(n), slopes(n), values(n);
  for (Index j = 0; j < n; ++j) slopes(j) = own[static_cast<std::size_t>(j)].sd;
  for (int step = 0; step < 2; ++step) {
    for (Index j = 0; j < n; ++j) values(j) = own[static_cast<std::size_t>(j)].value(t(j));
    network = with_values(std::move(network), own, values);
    const Lazy<std::vector<Simulation>, Scalar> simulated =
        simulate<Scalar>(network, {seen.excitations[b]}, library, own);
    const Lazy<Simulation, Scalar>& one = simulated[0];
    const Index samples = one.channels.rows();
    MatrixX<Scalar> information = MatrixX<Scalar>::Identity(n, n);
    VectorX<Scalar> score = -t;
    for (std::size_t c = 0; c < seen.channels.size(); ++c) {
      const Index column = seen.channels[c].column;
      MatrixX<Scalar> jacobian = one.jacobian.middleRows(column * samples, samples) * slopes.asDiagonal();
      VectorX<Scalar> residual = seen.channels[c].measured[b] - one.channels.col(column);
      whiteners[c][b].apply(jacobian);
      whiteners[c][b].apply(residual);
      information += jacobian.transpose() * jacobian;
      score += jacobian.transpose() * residual;
    }
    t += information.llt().solve(score);
  }
  for (Index j = 0; j < n; ++j) values(j) = own[static_cast<std::size_t>(j)].value(t(j));
  return with_values(std::move(network), own, values);
}

/// Residuals of every batch from a fit that has not seen it, but for the batch's own numbers; of a batch in no fold,
/// nothing (NaN). Throws Error as simulate() does. Allocates.
template <typename Scalar = double>
HeldOut held_out(const Lazy<MachineRecord, Scalar>& seen, const Lazy<MapFit, Scalar>& fit, const EffectLibrary& library,
                 const Folds& folds) {
  if (folds.empty()) return scored<Scalar>(seen, fit.residual, fit.noise);
  const auto whiteners = whiteners_of(seen, fit.noise);
  ChannelResiduals residual(seen.channels.size());
  for (SeriesByBatch& channel : residual)
    for (const Vector& time_s : seen.time_s) channel.push_back(VectorX<Scalar>::Constant(time_s.size(), std::nan("")));
  for (const std::vector<std::size_t>& left_out : folds) {
    const VectorX<Scalar> t = coordinates_without<Scalar>(seen, fit, library, left_out, whiteners);
    std::vector<Excitation> unseen;
    for (const std::size_t b : left_out) unseen.push_back(seen.excitations[b]);
    ThermalNetwork network = fit.network_at(t);
    if (!network.batches.empty())
      for (const std::size_t b : left_out)
        network.batches[b] = with_own_numbers<Scalar>(seen, fit, library, t, b, whiteners).batches[b];
    const Lazy<std::vector<Simulation>, Scalar> simulated = simulate<Scalar>(network, unseen, library);
    for (std::size_t i = 0; i < left_out.size(); ++i)
      for (std::size_t c = 0; c < seen.channels.size(); ++c)
        residual[c][left_out[i]] =
            seen.channels[c].measured[left_out[i]] - simulated[i].channels.col(seen.channels[c].column);
  }
  return scored<Scalar>(seen, std::move(residual), fit.noise);
}

THERMFIT_COMPILED_TEMPLATE(HeldOut held_out<double>(const MachineRecord&, const MapFit&, const EffectLibrary&,
                                                    const Folds&));

}  // namespace thermfit
