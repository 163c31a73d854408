#pragma once

/// Aliases used everywhere. One convention holds throughout: a row is a sample, a column is a channel.

#include <Eigen/Core>

namespace thermfit {

/// Signed count of rows, columns and positions: Eigen's own.
using Index = Eigen::Index;

/// Column of any length.
template <typename Scalar>
using VectorX = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
/// Matrix of any size, column after column in memory.
template <typename Scalar>
using MatrixX = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
/// Matrix of any size, row after row in memory: samples as they arrive.
template <typename Scalar>
using RowMatrixX = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

using Vector = VectorX<double>;        ///< column of doubles
using Matrix = MatrixX<double>;        ///< matrix of doubles, by columns
using RowMatrix = RowMatrixX<double>;  ///< matrix of doubles, by rows

}  // namespace thermfit
