#pragma once

/// A Newton step that stays within bounds.

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// The step s with `information` s = `gradient` from `at` for which low <= at + s <= high, all n long: coordinates that
/// would leave the box are stopped at its wall and the others solved for anew, up to four times. `information` n x n,
/// positive definite. Allocates.
template <typename Scalar = double>
VectorX<Scalar> step_in_box(const Lazy<MatrixX<Scalar>>& information, const Lazy<VectorX<Scalar>>& gradient,
                            const Lazy<VectorX<Scalar>>& at, const Lazy<VectorX<Scalar>>& low,
                            const Lazy<VectorX<Scalar>>& high) {
  const Index n = at.size();
  std::vector<char> fixed(static_cast<std::size_t>(n), 0);
  VectorX<Scalar> step = VectorX<Scalar>::Zero(n);
  for (int pass = 0; pass < 4; ++pass) {
    std::vector<Index> free;
    VectorX<Scalar> pushed = gradient;
    for (Index j = 0; j < n; ++j)
      if (fixed[static_cast<std::size_t>(j)])
        pushed -= step(j) * information.col(j);
      else
        free.push_back(j);
    const Index m = static_cast<Index>(free.size());
    if (m == 0) return step;
    VectorX<Scalar> solution;
    if (m == n) {
      solution = information.llt().solve(pushed);
    } else {
      MatrixX<Scalar> part(m, m);
      VectorX<Scalar> right(m);
      for (Index i = 0; i < m; ++i) {
        right(i) = pushed(free[static_cast<std::size_t>(i)]);
        for (Index j = 0; j < m; ++j)
          part(i, j) = information(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
      }
      solution = part.llt().solve(right);
    }
    bool left = false;
    for (Index i = 0; i < m; ++i) {
      const Index j = free[static_cast<std::size_t>(i)];
      step(j) = solution(i);
      const Scalar to = at(j) + step(j);
      if (to >= low(j) && to <= high(j)) continue;
      step(j) = std::clamp(to, low(j), high(j)) - at(j);
      fixed[static_cast<std::size_t>(j)] = 1;
      left = true;
    }
    if (!left) return step;
  }
  return step;
}

THERMFIT_COMPILED_TEMPLATE(Vector step_in_box<double>(const Matrix&, const Vector&, const Vector&, const Vector&,
                                                      const Vector&));

}  // namespace thermfit
