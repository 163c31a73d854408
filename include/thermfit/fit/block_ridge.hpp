#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit {

/// Columns that are penalised together.
template <typename Scalar = double>
struct PenalisedBlock {
  Index first = 0;            ///< column
  Index count = 0;            ///< of columns
  Scalar penalty = 0;         ///< lambda, without unit; infinite: the block is left out
  bool units_differ = false;  ///< of its columns, which then are measured each by itself whatever the scale
};

/// What the squares of coefficients are measured in when they are penalised.
enum class PenaltyScale {
  column,  ///< each column by its own mean square: it counts nothing in which unit it is
  block    ///< all of a block by their mean: what hardly moves does not gain by being scaled up
};

/// Ridge regression with a penalty of its own for each block of columns: the b that minimises
/// `|y - A b|^2 + sum_j lambda_j s_j^2 b_j^2` (generalised ridge: Hoerl and Kennard, Technometrics 12, 1970) from the
/// products `A'A` and `A'y`; s_j^2 is the diagonal of A'A, under PenaltyScale::block its mean over the block. Columns
/// in no block are not penalised and must be independent. A block penalised infinitely, or zero throughout, gets
/// coefficients 0. Allocates.
template <typename Products, typename Cross, typename Scalar = typename Products::Scalar>
VectorX<Scalar> block_ridge(const Eigen::MatrixBase<Products>& products, const Eigen::MatrixBase<Cross>& cross,
                            const std::vector<PenalisedBlock<Scalar>>& blocks,
                            PenaltyScale scale = PenaltyScale::block) {
  VectorX<Scalar> added = VectorX<Scalar>::Zero(products.rows());
  for (const PenalisedBlock<Scalar>& block : blocks) {
    if (block.count == 0) continue;
    VectorX<Scalar> squares = products.diagonal().segment(block.first, block.count);
    const Scalar mean = squares.mean();
    const bool gone = !(mean > 0) || !std::isfinite(block.penalty);
    for (Index j = 0; j < block.count; ++j) {
      const bool by_block = scale == PenaltyScale::block && !block.units_differ;
      const Scalar square = by_block || !(squares(j) > 0) ? mean : squares(j);
      added(block.first + j) = gone ? std::numeric_limits<Scalar>::infinity() : block.penalty * square;
    }
  }
  std::vector<Index> kept;
  for (Index c = 0; c < added.size(); ++c)
    if (std::isfinite(added(c))) kept.push_back(c);
  VectorX<Scalar> result = VectorX<Scalar>::Zero(products.rows());
  if (kept.empty()) return result;
  MatrixX<Scalar> system = products(kept, kept);
  system.diagonal() += added(kept);
  const VectorX<Scalar> right = cross(kept);
  const VectorX<Scalar> solved = system.llt().solve(right);
  result(kept) = solved;
  return result;
}

}  // namespace thermfit
