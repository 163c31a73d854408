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

/// Any matrix expression as one: itself where its columns are contiguous, a copy where they are not (row-major,
/// strided, a difference).
template <typename Scalar>
using MatrixView = Eigen::Ref<const MatrixX<Scalar>>;

using Vector = VectorX<double>;        ///< column of doubles
using Matrix = MatrixX<double>;        ///< matrix of doubles, by columns
using RowMatrix = RowMatrixX<double>;  ///< matrix of doubles, by rows

namespace detail {

/// `value` itself, as an expression that depends on Scalar: what a template computes with a plain double member is
/// then instantiated where it is used, not where it is read.
template <typename Scalar, typename T>
constexpr const T& lazy(const T& value) noexcept {
  return value;
}

}  // namespace detail

}  // namespace thermfit
