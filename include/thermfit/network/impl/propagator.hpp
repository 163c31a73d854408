#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <vector>

#include "thermfit/network/impl/phi.hpp"
#include "thermfit/types.hpp"

namespace thermfit::detail {

/// Weights of one step of length h for C dx/dt = -K x + F(t), F linear over the step, in modal coordinates.
template <typename Scalar>
struct StepWeights {
  VectorX<Scalar> decay, held, ramp;                 ///< exp(-rate h), h phi_1, h phi_2
  MatrixX<Scalar> from_state, from_held, from_ramp;  ///< divided differences for sensitivities; empty until asked for
};

/// Eigenbasis of a network while its conductances stay the same.
///
/// K = K' and C diagonal, so C^-1/2 K C^-1/2 = V diag(rates) V' and with `modes` = V' C^-1/2:
/// modal state xi = modes C x, temperatures x = modes' xi, modal force = modes F (F in W).
template <typename Scalar>
class Propagator {
 public:
  Propagator(const VectorX<Scalar>& capacities, const MatrixX<Scalar>& conductances) {
    const VectorX<Scalar> root = capacities.cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<MatrixX<Scalar>> solver(root.asDiagonal() * conductances * root.asDiagonal());
    rates_ = solver.eigenvalues();
    modes_ = solver.eigenvectors().transpose() * root.asDiagonal();
  }

  const VectorX<Scalar>& rates() const { return rates_; }
  const MatrixX<Scalar>& modes() const { return modes_; }

  /// Weights for a step of `h_s`, kept for the next call. Steps that differ by less than 1e-9 of their length share
  /// weights, so that rounding in a clock does not multiply them.
  const StepWeights<Scalar>& step(double h_s, bool with_differences) {
    auto it = steps_.lower_bound(h_s * (1 - 1e-9));
    if (it == steps_.end() || it->first > h_s * (1 + 1e-9)) {
      StepWeights<Scalar> weights;
      const Index n = rates_.size();
      weights.decay.resize(n);
      weights.held.resize(n);
      weights.ramp.resize(n);
      for (Index m = 0; m < n; ++m) {
        const Phi phi(-rates_(m) * h_s);
        weights.decay(m) = phi.phi0;
        weights.held(m) = h_s * phi.phi1;
        weights.ramp(m) = h_s * phi.phi2;
      }
      it = steps_.emplace(h_s, std::move(weights)).first;
    }
    if (with_differences && it->second.from_state.size() == 0) add_differences(it->first, it->second);
    return it->second;
  }

 private:
  void add_differences(double h, StepWeights<Scalar>& weights) const {
    const Index n = rates_.size();
    weights.from_state.resize(n, n);
    weights.from_held.resize(n, n);
    weights.from_ramp.resize(n, n);
    std::vector<Phi> phi;
    for (Index m = 0; m < n; ++m) phi.emplace_back(-rates_(m) * h);
    for (Index m = 0; m < n; ++m)
      for (Index l = 0; l <= m; ++l) {
        const PhiDifference d(-rates_(m) * h, -rates_(l) * h, phi[static_cast<std::size_t>(m)],
                              phi[static_cast<std::size_t>(l)]);
        weights.from_state(m, l) = weights.from_state(l, m) = h * d.phi0;
        weights.from_held(m, l) = weights.from_held(l, m) = h * h * d.phi1;
        weights.from_ramp(m, l) = weights.from_ramp(l, m) = h * h * d.phi2;
      }
  }

  VectorX<Scalar> rates_;
  MatrixX<Scalar> modes_;
  std::map<double, StepWeights<Scalar>> steps_;
};

}  // namespace thermfit::detail
