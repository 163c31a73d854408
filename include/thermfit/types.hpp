#pragma once

/// Aliases used everywhere. One convention holds throughout: a row is a sample, a column is a channel.

#include <Eigen/Core>

namespace thermfit {

using Index = Eigen::Index;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

}  // namespace thermfit
