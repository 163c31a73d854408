#pragma once

/// Aliases used everywhere. One convention holds throughout: a row is a sample, a column is a channel.

#include <Eigen/Core>

namespace thermfit {

using Index = Eigen::Index;

template <typename Scalar>
using VectorX = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
template <typename Scalar>
using MatrixX = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <typename Scalar>
using RowMatrixX = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

using Vector = VectorX<double>;
using Matrix = MatrixX<double>;
using RowMatrix = RowMatrixX<double>;

}  // namespace thermfit
