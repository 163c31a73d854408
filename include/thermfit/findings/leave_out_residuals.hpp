#pragma once

/// How well each channel of a batch is predicted by the others, with regressions from other batches.

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit {

/// Products of the channels of one batch, about their means in the batch: what is the same in every season.
template <typename Scalar = double>
struct CentredProducts {
  MatrixX<Scalar> products;  ///< channels x channels, sum over the rows that count
  Scalar rows = 0;           ///< how many those are
};

/// Residuals of one batch. With the precision matrix Omega of other batches, channel c is predicted by the others with
/// weights -Omega_jc / Omega_cc (Whittaker 1990, section 5.8), so that one inverse serves all channels, with any one of
/// them left out as well.
template <typename Scalar = double>
struct LeaveOutResiduals {
  VectorX<Scalar> log_sd;          ///< logarithm of the rms residual of each channel
  MatrixX<Scalar> log_sd_without;  ///< (c, k): of channel k where c is not used; NaN for k = c
  MatrixX<Scalar> weights;         ///< column c: the residual of c is weights^T (x - mean), in the unit of c
};

/// Residuals of `batch` by the sum of `training`, channels `kept`; `floor` is the rms below which nothing is told from
/// the noise of a reading, `ridge` a share of each channel's variance. Allocates.
template <typename Scalar = double>
LeaveOutResiduals<Scalar> leave_out_residuals(const CentredProducts<Scalar>& batch,
                                              const CentredProducts<Scalar>& training, const std::vector<Index>& kept,
                                              const VectorX<Scalar>& floor, Scalar ridge) {
  const auto count = static_cast<Index>(kept.size());
  VectorX<Scalar> scale(count), least(count);
  for (Index i = 0; i < count; ++i) {
    const Index c = kept[static_cast<std::size_t>(i)];
    least(i) = floor(c) * floor(c);
    scale(i) = std::sqrt(training.products(c, c) / training.rows + least(i));
  }
  MatrixX<Scalar> correlation(count, count), own(count, count);
  for (Index j = 0; j < count; ++j)
    for (Index i = 0; i < count; ++i) {
      const Index a = kept[static_cast<std::size_t>(i)], b = kept[static_cast<std::size_t>(j)];
      const Scalar both = scale(i) * scale(j);
      correlation(i, j) = training.products(a, b) / training.rows / both;
      own(i, j) = batch.products(a, b) / batch.rows / both;
    }
  correlation.diagonal().array() += ridge;
  const MatrixX<Scalar> omega = correlation.llt().solve(MatrixX<Scalar>::Identity(count, count));
  const MatrixX<Scalar> half = own * omega;
  const MatrixX<Scalar> spread = omega * half;
  const auto log_sd = [&](Index c, Scalar variance, Scalar precision) {
    const Scalar square = variance / (precision * precision) * scale(c) * scale(c);
    return std::log(std::max(square, Scalar(0)) + least(c) + Scalar(1e-300)) / 2;
  };
  LeaveOutResiduals<Scalar> result{VectorX<Scalar>(count), MatrixX<Scalar>(count, count),
                                   MatrixX<Scalar>(count, count)};
  for (Index c = 0; c < count; ++c) {
    result.log_sd(c) = log_sd(c, spread(c, c), omega(c, c));
    for (Index j = 0; j < count; ++j) result.weights(j, c) = omega(j, c) / omega(c, c) * scale(c) / scale(j);
    for (Index k = 0; k < count; ++k) {
      const Scalar share = omega(c, k) / omega(c, c);
      const Scalar variance = spread(k, k) - 2 * share * spread(c, k) + share * share * spread(c, c);
      result.log_sd_without(c, k) =
          k == c ? Scalar(NAN) : log_sd(k, variance, std::max(omega(k, k) - share * omega(c, k), Scalar(1e-12)));
    }
  }
  return result;
}

}  // namespace thermfit
