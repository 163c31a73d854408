#pragma once

#include <cmath>

#include "thermfit/types.hpp"

namespace thermfit {

/// First-order lag of one channel, at any sampling: `x <- x + (1 - exp(-dt / tau)) (input - x)`, exact for an input
/// held over the step that ends with it. Starts at 0, where rises start. Neither allocates nor throws.
template <typename Scalar = double>
struct Lag {
  Scalar state = 0;  ///< of the last step

  /// One step of `dt` (0 or more) with time constant `tau` (above 0), both in the same unit.
  Scalar step(Scalar input, Scalar dt, Scalar tau) noexcept {
    using std::expm1;
    return state += -expm1(-dt / tau) * (input - state);
  }
};

/// Every column of `inputs` (rows x channels) through a lag of `tau_s`, from 0 at the first row; `time_s` is rows long
/// and does not decrease. One pass. Allocates the result.
template <typename Inputs, typename Scalar = typename Inputs::Scalar>
MatrixX<Scalar> lagged(const Eigen::MatrixBase<Inputs>& inputs, const VectorX<Scalar>& time_s, Scalar tau_s) {
  MatrixX<Scalar> result(inputs.rows(), inputs.cols());
  if (inputs.rows() == 0) return result;
  result.row(0).setZero();
  for (Index row = 1; row < inputs.rows(); ++row) {
    const Scalar share = -std::expm1(-(time_s(row) - time_s(row - 1)) / tau_s);
    result.row(row) = result.row(row - 1) + share * (inputs.row(row) - result.row(row - 1));
  }
  return result;
}

}  // namespace thermfit
