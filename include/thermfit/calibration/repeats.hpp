#pragma once

/// Experiments done twice: what differs between them is no model's fault (the pure error of a lack-of-fit test).

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/lazy.hpp"
#include "thermfit/network/excitation.hpp"
#include "thermfit/statistics/residual_noise.hpp"
#include "thermfit/statistics/rms.hpp"

namespace thermfit {

/// Whether two batches repeat each other: as many samples, clocks within a tenth of a step, inputs within 2 % of their
/// range, rooms that move alike and starts as far off them within `tolerance_K`. The level of the room may differ.
template <typename Scalar = double>
bool repeat_each_other(const Lazy<Excitation, Scalar>& a, const Lazy<Excitation, Scalar>& b, double tolerance_K = 0.5) {
  if (a.samples() != b.samples() || a.inputs.cols() != b.inputs.cols()) return false;
  const double step_s = a.time_s(a.samples() - 1) / static_cast<double>(a.samples() - 1);
  if ((a.time_s - b.time_s).cwiseAbs().maxCoeff() > 0.1 * step_s) return false;
  for (Index i = 0; i < a.inputs.cols(); ++i) {
    const double range = std::max(a.inputs.col(i).maxCoeff(), b.inputs.col(i).maxCoeff()) -
                         std::min(a.inputs.col(i).minCoeff(), b.inputs.col(i).minCoeff());
    const double off = (a.inputs.col(i) - b.inputs.col(i)).norm() / std::sqrt(static_cast<double>(a.samples()));
    if (off > 0.02 * range) return false;
  }
  const auto moves = [](const auto& one) { return VectorX<Scalar>(one.ambient_degC.array() - one.ambient_degC(0)); };
  const auto starts = [](const auto& one) { return VectorX<Scalar>(one.start_degC.array() - one.ambient_degC(0)); };
  return (moves(a) - moves(b)).cwiseAbs().maxCoeff() <= tolerance_K &&
         (starts(a) - starts(b)).cwiseAbs().maxCoeff() <= tolerance_K;
}

/// Differences of the rises of one channel between batches that repeat each other, over the square root of 2. Empty
/// where nothing was repeated.
template <typename Scalar = double>
SeriesByBatch repeat_differences(const std::vector<Excitation>& excitations, const SeriesByBatch& measured) {
  SeriesByBatch result;
  for (std::size_t a = 0; a < excitations.size(); ++a)
    for (std::size_t b = a + 1; b < excitations.size(); ++b)
      if (repeat_each_other<Scalar>(excitations[a], excitations[b])) {
        VectorX<Scalar> difference = measured[a];
        difference -= measured[b];
        result.push_back((difference.array() - difference(0)) / std::sqrt(2.0));
      }
  return result;
}

/// Their rms; 0 where nothing was repeated.
template <typename Scalar = double>
double repeat_sd(const std::vector<Excitation>& excitations, const SeriesByBatch& measured) {
  return rms_of(repeat_differences<Scalar>(excitations, measured));
}

}  // namespace thermfit
