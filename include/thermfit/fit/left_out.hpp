#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/fit/residuals.hpp"

namespace thermfit {

/// Error of candidate models on batches they have not seen: every batch is left out once, `path(others)` gives the
/// candidates fitted to the rest (simplest first; std::vector<LinearModel<Scalar>>), and their squared errors on the
/// batch are summed (PRESS). Returns, per candidate, the root of PRESS over rows in units of the errors' overall
/// deviation, averaged in square over the errors. A batch on which fewer candidates exist counts its last for the
/// missing ones. Fewer than two batches: Error. Allocates.
template <typename Scalar, class Path>
VectorX<Scalar> left_out_error(const std::vector<Moments<Scalar>>& batches, Path&& path) {
  if (batches.size() < 2) {
    throw Error("batches", std::to_string(batches.size()), "2 or more to choose by leaving one out",
                "give the number of components (or the penalty), or more batches");
  }
  const Moments<Scalar> all = merged(batches);
  const std::vector<Moments<Scalar>> others = leave_one_out(batches);
  std::vector<VectorX<Scalar>> square;  // per batch, per candidate
  Index candidates = 0;
  for (std::size_t i = 0; i < batches.size(); ++i) {
    const std::vector<LinearModel<Scalar>> models = path(others[i]);
    VectorX<Scalar> sum(static_cast<Index>(models.size()));
    for (Index c = 0; c < sum.size(); ++c) {
      const auto per_error = residuals(models[static_cast<std::size_t>(c)], batches[i]);
      sum(c) = 0;
      for (Index e = 0; e < all.errors(); ++e) {
        const Scalar total = all.error_products()(e, e);
        if (total > 0) sum(c) += per_error[static_cast<std::size_t>(e)].sum_of_squares() / total;
      }
    }
    candidates = std::max(candidates, sum.size());
    square.push_back(std::move(sum));
  }
  VectorX<Scalar> press = VectorX<Scalar>::Zero(candidates);
  for (const VectorX<Scalar>& sum : square) {
    for (Index c = 0; sum.size() > 0 && c < candidates; ++c) press(c) += sum(std::min(c, sum.size() - 1));
  }
  return (press / static_cast<Scalar>(all.errors())).cwiseSqrt();
}

}  // namespace thermfit
