#pragma once

/// What an effect could do that looks like a fault of writing: a thermometer off by degrees, a part that expands.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/sides/side_weighing.hpp"

namespace thermfit::detail {

/// What single effects could do to a channel: a thermometer off by ten kelvin, or by its whole swing; a part that
/// expands as each thermometer rises, per kelvin as much as the part that expands most.
template <typename Scalar>
std::vector<VectorX<Scalar>> lookalikes(const SideWeighing<Scalar>& of, std::size_t c, const BatchNumbers& batches) {
  std::vector<VectorX<Scalar>> result;
  const auto [y, x] = of.courses(c, c, batches);
  if (!of.channel(c).displacement) {
    result.push_back(VectorX<Scalar>::Constant(x.size(), 10));
    VectorX<Scalar> rise = x;
    of.centre(rise, batches);
    result.push_back(std::move(rise));
    return result;
  }
  const MatrixX<Scalar> directions = of.directions_of(c, batches);
  const double largest = std::sqrt(directions.colwise().squaredNorm().maxCoeff() / static_cast<double>(x.size()));
  std::vector<std::pair<double, VectorX<Scalar>>> rises;
  for (std::size_t j = 0; j < of.sides().channels.size(); ++j) {
    if (of.channel(j).displacement) continue;
    VectorX<Scalar> rise = of.courses(j, j, batches).second;
    of.centre(rise, batches);
    const double size = rms_of<Scalar>(rise);
    if (size > 0) rises.emplace_back(size, std::move(rise));
  }
  double warmest = 0;
  for (const auto& one : rises) warmest = std::max(warmest, one.first);
  const double um_per_K =
      of.sides().largest_um_per_K > 0 ? of.sides().largest_um_per_K : largest / of.limits().relative_sd / warmest;
  for (const auto& one : rises) result.push_back(um_per_K * one.second);
  return result;
}

/// By how much a reading is more probable than the channel as given, whatever looks alike added to it.
template <typename Scalar>
double margin(SideWeighing<Scalar>& of, std::size_t c, const BatchNumbers& batches, const Reading& reading) {
  const WeighedGap with = of.weigh(c, batches, reading);
  double given = of.weigh(c, batches, {}).nats;
  if (with.nats - given < of.limits().suspected_nats) return with.nats - given;
  for (const VectorX<Scalar>& alike : lookalikes(of, c, batches))
    given = std::max(given, of.weigh(c, batches, {}, alike).nats);
  return with.nats - given;
}

}  // namespace thermfit::detail
