#pragma once

/// How probable a channel is under what is believed of a simulator before any effect.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "thermfit/compiled.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Looks that a batch gives at a slow misfit: samples closer than that repeat each other, however often was sampled.
constexpr double looks_per_batch = 12;

/// A gap weighed by belief.
struct WeighedGap {
  double nats = 0;  ///< log density at the most probable size of what belief leaves, without the constant of 2 pi
  double left = 0;  ///< that size: rms, in the unit of the gap
};

/// Directions in which calibration may move a channel, each as far as a prior standard deviation.
template <typename Scalar = double>
class ChannelBelief {
 public:
  /// `directions`: samples x directions, of `looks` independent samples in all.
  ChannelBelief(MatrixX<Scalar> directions, double looks)
      : directions_(std::move(directions)),
        looks_(std::min(looks, static_cast<double>(directions_.rows()))),
        solver_(directions_.transpose() * directions_) {}

  /// log density of a gap N(0, level^2 I + D D'), maximised over levels from `floor` on; samples count as `looks`.
  WeighedGap weigh(const VectorX<Scalar>& gap, double floor) const {
    const VectorX<Scalar> along = solver_.eigenvectors().transpose() * (directions_.transpose() * gap);
    const VectorX<Scalar> spread = solver_.eigenvalues().cwiseMax(0);
    const double squares = gap.squaredNorm(), repeats = static_cast<double>(gap.size()) / looks_;
    const double rms = std::sqrt(squares / static_cast<double>(gap.size()));
    WeighedGap best{-1e300, rms};
    for (double level = std::max(rms, floor);; level /= 1.3) {
      const double at = std::max(level, floor), variance = at * at * repeats;
      const double explained = (along.array().square() / (spread.array() + variance)).sum();
      const double log_determinant = (spread.array() / variance).log1p().sum();
      const double nats =
          -.5 * (std::max(0., squares - explained) / variance + log_determinant) - looks_ * std::log(at);
      if (nats > best.nats) best = {nats, at};
      if (level <= floor) return best;
    }
  }

 private:
  MatrixX<Scalar> directions_;
  double looks_;
  Eigen::SelfAdjointEigenSolver<MatrixX<Scalar>> solver_;
};

}  // namespace thermfit
