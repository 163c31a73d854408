#pragma once

/// Aliases used everywhere. One convention holds throughout: a row is a sample, a column is a channel.

#include <Eigen/Core>

namespace thermfit {

using Index = Eigen::Index;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace thermfit
