#pragma once

/// Where a model is deficient, without assuming what the effect is: an unknown heat flow per node, a wandering bias per
/// sensor, a disturbance of the displacement, and spread families, all competing (Kristensen, Madsen, Joergensen 2004).

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/where/disturbances.hpp"

namespace thermfit {

namespace detail {

template <typename Scalar = double>
class PlaceSearch {
 public:
  static constexpr double least_gain_nats = 5;  ///< of a place that is picked
  static constexpr int most_places = 3;         ///< that are picked

  PlaceSearch(const MachineRecord& seen, const MapFit& fit, const EffectLibrary& library)
      : seen_(seen), fit_(fit), library_(library), disturbances_(seen, fit, library) {}

  /// Places in the order in which they are picked, then the others by what they add alone.
  std::vector<DisturbedPlace> run() {
    whiten_model();
    traces_ = disturbances_.all();
    std::vector<DisturbedPlace> picked;
    for (PlaceTraces<Scalar>& one : traces_) one.place.gain = one.place.gain_beside = gain_of(one).gain;
    for (int round = 0; round < most_places; ++round) {
      PlaceTraces<Scalar>* best = nullptr;
      for (PlaceTraces<Scalar>& one : traces_)
        if (!one.by_batch.empty() && (!best || one.place.gain_beside > best->place.gain_beside)) best = &one;
      if (!best || best->place.gain_beside < least_gain_nats) break;
      const double variance = gain_of(*best).variance;
      picked.push_back(best->place);
      add_nuisance(*best, variance);
      best->by_batch.clear();
      if (round + 1 < most_places)
        for (PlaceTraces<Scalar>& one : traces_)
          if (!one.by_batch.empty()) one.place.gain_beside = gain_of(one).gain;
    }
    std::vector<DisturbedPlace> others;
    for (const PlaceTraces<Scalar>& one : traces_)
      if (!one.by_batch.empty()) others.push_back(one.place);
    std::stable_sort(others.begin(), others.end(),
                     [](const DisturbedPlace& a, const DisturbedPlace& b) { return a.gain > b.gain; });
    for (DisturbedPlace& other : others) other.gain_beside = 0;
    picked.insert(picked.end(), others.begin(), others.end());
    return picked;
  }

 private:
  struct Best {
    double gain = 0, variance = 0;
  };

  void whiten_model() {
    const std::vector<Simulation> simulated =
        simulate(disturbances_.machine(), seen_.excitations, library_, fit_.parameters);
    const VectorX<Scalar> slopes = fit_.slopes();
    const Index n = slopes.size();
    information_ = MatrixX<Scalar>::Identity(n, n);
    for (std::size_t b = 0; b < seen_.batches(); ++b) {
      const Index samples = seen_.time_s[b].size();
      nuisance_.push_back(disturbances_.stacked(b, n, [&](std::size_t c) -> MatrixX<Scalar> {
        return simulated[b].jacobian.middleRows(seen_.channels[c].column * samples, samples) * slopes.asDiagonal();
      }));
      residual_.push_back(disturbances_.stacked(b, 1, [&](std::size_t c) -> MatrixX<Scalar> {
        return seen_.channels[c].measured[b] - simulated[b].channels.col(seen_.channels[c].column);
      }));
      information_ += nuisance_[b].transpose() * nuisance_[b];
    }
    factor_ = information_.llt();
  }

  /// Adds a disturbance of known variance to what is free.
  void add_nuisance(const PlaceTraces<Scalar>& one, double variance) {
    const Index old = information_.rows(), batches = static_cast<Index>(one.by_batch.size());
    const Index more = one.by_batch[0].cols();
    MatrixX<Scalar> larger = MatrixX<Scalar>::Zero(old + more * batches, old + more * batches);
    larger.topLeftCorner(old, old) = information_;
    for (Index b = 0; b < batches; ++b) {
      const std::size_t k = static_cast<std::size_t>(b);
      const Index at = old + b * more;
      larger.block(at, at, more, more) =
          one.by_batch[k].transpose() * one.by_batch[k] + MatrixX<Scalar>::Identity(more, more) / variance;
      larger.block(0, at, old, more) = nuisance_[k].transpose() * one.by_batch[k];
      larger.block(at, 0, more, old) = larger.block(0, at, old, more).transpose();
      MatrixX<Scalar> wider = MatrixX<Scalar>::Zero(nuisance_[k].rows(), old + more * batches);
      wider.leftCols(old) = nuisance_[k];
      wider.middleCols(at, more) = one.by_batch[k];
      nuisance_[k] = std::move(wider);
    }
    information_ = std::move(larger);
    factor_ = information_.llt();
  }

  /// The likelihood as a function of the disturbance's variance v, with everything in the nuisance integrated out:
  /// sum over eigenvalues l of G = V'M^-1 V of u^2 / (1/v + l) - log(1 + v l), halved; u = V'M^-1 r in that basis.
  Best gain_of(const PlaceTraces<Scalar>& one) const {
    const Index q = one.by_batch[0].cols(), batches = static_cast<Index>(one.by_batch.size());
    MatrixX<Scalar> across(information_.rows(), q * batches), own = MatrixX<Scalar>::Zero(q * batches, q * batches);
    VectorX<Scalar> score = VectorX<Scalar>::Zero(information_.rows()), along(q * batches);
    for (Index b = 0; b < batches; ++b) {
      const std::size_t k = static_cast<std::size_t>(b);
      across.middleCols(b * q, q).noalias() = nuisance_[k].transpose() * one.by_batch[k];
      own.block(b * q, b * q, q, q).noalias() = one.by_batch[k].transpose() * one.by_batch[k];
      along.segment(b * q, q).noalias() = one.by_batch[k].transpose() * residual_[k];
      score.noalias() += nuisance_[k].transpose() * residual_[k];
    }
    score.head(fit_.coordinates.size()) -= fit_.coordinates;
    const MatrixX<Scalar> solved = factor_.solve(across);
    const Eigen::SelfAdjointEigenSolver<MatrixX<Scalar>> eigen(own - across.transpose() * solved);
    const VectorX<Scalar> u = eigen.eigenvectors().transpose() * (along - solved.transpose() * score);
    const VectorX<Scalar> values = eigen.eigenvalues().cwiseMax(0);
    Best best;
    const double largest = values.maxCoeff();
    if (largest <= 0) return best;
    for (double scaled = 1e-2; scaled < 1e7; scaled *= 2) {
      const double variance = scaled / largest;
      double gain = 0;
      for (Index k = 0; k < u.size(); ++k)
        gain += .5 * (u(k) * u(k) / (1 / variance + values(k)) - std::log1p(variance * values(k)));
      if (gain > best.gain) best = {gain, variance};
    }
    return best;
  }

  const MachineRecord& seen_;
  const MapFit& fit_;
  const EffectLibrary& library_;
  Disturbances<Scalar> disturbances_;
  std::vector<MatrixX<Scalar>>
      nuisance_;  ///< by batch: what calibration (and places picked) does to the whitened outputs
  std::vector<VectorX<Scalar>> residual_;
  MatrixX<Scalar> information_;
  Eigen::LLT<MatrixX<Scalar>> factor_;
  std::vector<PlaceTraces<Scalar>> traces_;
};

}  // namespace detail

/// Effect-free places of a calibrated machine, picked ones first.
///
/// Each place gets a course of unknown disturbance (heat: six pieces a batch; readings: a broken line of six corners;
/// independent, of one variance), integrated out together with all calibration parameters: the batch form of an
/// unknown-input smoother with diffusion by maximum likelihood. The best is kept and the others judged anew beside it,
/// up to three. Under no deficiency a place gains rarely more than 3 nats (half chi-square mixture on the boundary); 5
/// are asked for.
template <typename Scalar = double>
std::vector<DisturbedPlace> disturbed_places(const MachineRecord& seen, const MapFit& calibrated,
                                             const EffectLibrary& library) {
  return detail::PlaceSearch<Scalar>(seen, calibrated, library).run();
}

THERMFIT_COMPILED_TEMPLATE(std::vector<DisturbedPlace> disturbed_places<double>(const MachineRecord&, const MapFit&,
                                                                                const EffectLibrary&));

}  // namespace thermfit
