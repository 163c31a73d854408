#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "thermfit/calibration/machine_record.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/network/parameters.hpp"
#include "thermfit/network/simulate.hpp"
#include "thermfit/statistics/residual_noise.hpp"

namespace thermfit {

/// Measured minus simulated, by channel and batch; NaN where nothing was measured.
using ChannelResiduals = std::vector<SeriesByBatch>;

/// The residuals of a campaign, `simulated` by batch. Allocates.
template <typename Scalar = double>
ChannelResiduals residuals_of(const Lazy<MachineRecord, Scalar>& seen,
                              const Lazy<std::vector<Simulation>, Scalar>& simulated) {
  ChannelResiduals result(seen.channels.size());
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    for (std::size_t b = 0; b < simulated.size(); ++b)
      result[c].push_back(seen.channels[c].measured[b] - simulated[b].channels.col(seen.channels[c].column));
  return result;
}

/// A model at a point, whitened: the residual and its derivatives with respect to the working coordinates t, of which a
/// channel keeps only the columns that touch it (an offset touches one sensor).
struct Linearized {
  /// One channel in one batch.
  struct Block {
    Matrix jacobian;  ///< samples x active columns of d(simulated)/dt
    Vector residual;  ///< measured minus simulated
  };
  /// One channel in all batches.
  struct Channel {
    std::vector<Index> active;   ///< parameters that touch it, increasing
    std::vector<Block> batches;  ///< in the order of the campaign
  };
  std::vector<Channel> channels;  ///< in the order of the record
  Index parameters = 0;           ///< how many there are in all
};

/// One whitener for every channel and batch.
inline std::vector<std::vector<Whitener>> whiteners_of(const MachineRecord& seen,
                                                       const std::vector<ResidualNoise>& noise) {
  std::vector<std::vector<Whitener>> result(seen.channels.size());
  for (std::size_t c = 0; c < seen.channels.size(); ++c)
    for (std::size_t b = 0; b < seen.batches(); ++b)
      result[c].emplace_back(noise[c], seen.time_s[b], seen.channels[c].present[b]);
  return result;
}

/// Whitens simulations that carry sensitivities, by batch. `slopes` is d(value)/dt of each parameter, `whiteners` by
/// channel and batch. Allocates.
template <typename Scalar = double>
Linearized linearized(const Lazy<MachineRecord, Scalar>& seen, const Lazy<std::vector<Simulation>, Scalar>& simulated,
                      const Lazy<VectorX<Scalar>>& slopes, const std::vector<std::vector<Whitener>>& whiteners) {
  Lazy<Linearized, Scalar> result;
  result.parameters = slopes.size();
  result.channels.resize(seen.channels.size());
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    Lazy<Linearized::Channel, Scalar>& channel = result.channels[c];
    const Index column = seen.channels[c].column;
    VectorX<Scalar> largest = VectorX<Scalar>::Zero(slopes.size());
    for (const Lazy<Simulation, Scalar>& one : simulated) {
      const Index n = one.channels.rows();
      largest = largest.cwiseMax(one.jacobian.middleRows(column * n, n).cwiseAbs().colwise().maxCoeff().transpose());
    }
    for (Index j = 0; j < slopes.size(); ++j)
      if (largest(j) > 0) channel.active.push_back(j);
    for (std::size_t b = 0; b < simulated.size(); ++b) {
      const Lazy<Simulation, Scalar>& one = simulated[b];
      const Index n = one.channels.rows();
      Lazy<Linearized::Block, Scalar> block;
      block.jacobian = MatrixX<Scalar>::Zero(n, static_cast<Index>(channel.active.size()));
      const VectorX<Scalar> own = one.jacobian.middleRows(column * n, n).cwiseAbs().colwise().maxCoeff().transpose();
      std::vector<Index> places;
      for (std::size_t a = 0; a < channel.active.size(); ++a)
        if (own(channel.active[a]) > 0) places.push_back(static_cast<Index>(a));
      MatrixX<Scalar> columns(n, static_cast<Index>(places.size()));
      for (std::size_t i = 0; i < places.size(); ++i) {
        const Index j = channel.active[static_cast<std::size_t>(places[i])];
        columns.col(static_cast<Index>(i)) = slopes(j) * one.jacobian.col(j).segment(column * n, n);
      }
      block.residual = seen.channels[c].measured[b] - one.channels.col(column);
      whiteners[c][b].apply(columns);
      for (std::size_t i = 0; i < places.size(); ++i)
        block.jacobian.col(places[i]) = columns.col(static_cast<Index>(i));
      whiteners[c][b].apply(block.residual);
      channel.batches.push_back(std::move(block));
    }
  }
  return result;
}

THERMFIT_COMPILED_TEMPLATE(Linearized linearized<double>(const MachineRecord&, const std::vector<Simulation>&,
                                                         const Vector&, const std::vector<std::vector<Whitener>>&));

/// Gauss-Newton normal equations: information J'J, score J'r, squares r'r.
struct NormalEquations {
  Matrix information;  ///< J'J, parameters x parameters
  Vector score;        ///< J'r
  double squares = 0;  ///< r'r

  /// Of nothing.
  explicit NormalEquations(Index parameters = 0)
      : information(Matrix::Zero(parameters, parameters)), score(Vector::Zero(parameters)) {}

  /// Adds equations that know only some of the parameters.
  void add(const NormalEquations& part, const std::vector<Index>& active, double weight = 1) {
    const Index n = static_cast<Index>(active.size());
    for (Index j = 0; j < n; ++j) {
      const Index to = active[static_cast<std::size_t>(j)];
      score(to) += weight * part.score(j);
      for (Index i = 0; i < n; ++i)
        information(active[static_cast<std::size_t>(i)], to) += weight * part.information(i, j);
    }
    squares += weight * part.squares;
  }
  /// Adds equations in the same parameters.
  template <typename Scalar = double>
  NormalEquations& operator+=(const Lazy<NormalEquations, Scalar>& other) {
    information += other.information;
    score += other.score;
    squares += other.squares;
    return *this;
  }
  /// Takes away equations in the same parameters.
  template <typename Scalar = double>
  NormalEquations& operator-=(const Lazy<NormalEquations, Scalar>& other) {
    information -= other.information;
    score -= other.score;
    squares -= other.squares;
    return *this;
  }
};

/// Of one batch of one channel, in its active parameters. Allocates.
template <typename Scalar = double>
NormalEquations normal_equations(const Lazy<Linearized::Block, Scalar>& block) {
  Lazy<NormalEquations, Scalar> result(block.jacobian.cols());
  result.squares = block.residual.squaredNorm();
  if (block.jacobian.cols() == 0) return result;
  result.information.template selfadjointView<Eigen::Lower>().rankUpdate(block.jacobian.transpose());
  result.information.template triangularView<Eigen::StrictlyUpper>() = result.information.transpose();
  result.score.noalias() = block.jacobian.transpose() * block.residual;
  return result;
}

/// The equations of a campaign, summed over channels for each batch and over batches for each channel.
struct SummedEquations {
  std::vector<NormalEquations> by_batch;    ///< in all parameters
  std::vector<NormalEquations> by_channel;  ///< in the channel's active parameters
};

/// The normal equations of all batches and channels. Allocates.
template <typename Scalar = double>
SummedEquations summed_equations(const Linearized& model) {
  SummedEquations result;
  for (const Linearized::Channel& channel : model.channels) {
    NormalEquations sum(static_cast<Index>(channel.active.size()));
    for (std::size_t b = 0; b < channel.batches.size(); ++b) {
      const NormalEquations part = normal_equations<Scalar>(channel.batches[b]);
      if (result.by_batch.size() <= b) result.by_batch.emplace_back(model.parameters);
      result.by_batch[b].add(part, channel.active);
      sum.operator+=<Scalar>(part);
    }
    result.by_channel.push_back(std::move(sum));
  }
  return result;
}

THERMFIT_COMPILED_TEMPLATE(SummedEquations summed_equations<double>(const Linearized&));

}  // namespace thermfit
