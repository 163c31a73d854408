#pragma once

#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit::detail {

/// Thin singular value decomposition A = U diag(values) V' by one-sided Jacobi rotations (Hestenes, Journal of SIAM 6,
/// 1958), which resolves small singular values as well as the columns of A do (Demmel and Veselic, SIAM Journal on
/// Matrix Analysis 13, 1992). The small matrices of a fit compile in a fraction of what Eigen's two-sided one takes.
template <typename Number>
struct SingularValues {
  using Scalar = Number;
  VectorX<Scalar> values;  ///< decreasing
  MatrixX<Scalar> u;       ///< rows x min(rows, columns); a column of zeros where the value is zero
  MatrixX<Scalar> v;       ///< columns x min(rows, columns); likewise

  explicit SingularValues(const MatrixX<Scalar>& a) {
    if (a.rows() < a.cols()) {
      decompose(a.transpose(), v, u);
    } else {
      decompose(a, u, v);
    }
  }

 private:
  /// `a` becomes a V, with orthogonal columns.
  void decompose(MatrixX<Scalar> a, MatrixX<Scalar>& left, MatrixX<Scalar>& right) {
    const Index n = a.cols();
    MatrixX<Scalar> rotations = MatrixX<Scalar>::Identity(n, n);
    for (int sweep = 0; sweep < most_sweeps && rotate_all(a, rotations); ++sweep) continue;
    const VectorX<Scalar> norms = a.colwise().norm().transpose();
    std::vector<Index> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return norms(i) > norms(j); });
    values.resize(n);
    left.resize(a.rows(), n);
    right.resize(n, n);
    for (Index k = 0; k < n; ++k) {
      const Index from = order[static_cast<std::size_t>(k)];
      values(k) = norms(from);
      left.col(k) = a.col(from) / (norms(from) > 0 ? norms(from) : Scalar{1});
      right.col(k) = rotations.col(from);
    }
  }

  /// Each pair of columns once; whether any had to be turned.
  static bool rotate_all(MatrixX<Scalar>& a, MatrixX<Scalar>& rotations) {
    constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    const Scalar nothing = epsilon * epsilon * a.squaredNorm();  // a column below it is rounding
    const Scalar orthogonal = epsilon * std::sqrt(static_cast<Scalar>(a.rows()));
    bool turned = false;
    for (Index p = 0; p + 1 < a.cols(); ++p) {
      for (Index q = p + 1; q < a.cols(); ++q) {
        const Scalar pp = a.col(p).squaredNorm(), qq = a.col(q).squaredNorm(), pq = a.col(p).dot(a.col(q));
        if (std::min(pp, qq) <= nothing || !(std::abs(pq) > orthogonal * std::sqrt(pp * qq))) continue;
        Eigen::JacobiRotation<Scalar> rotation;
        rotation.makeJacobi(pp, pq, qq);
        a.applyOnTheRight(p, q, rotation);
        rotations.applyOnTheRight(p, q, rotation);
        turned = true;
      }
    }
    return turned;
  }

  static constexpr int most_sweeps = 40;  // about eight are needed
};

}  // namespace thermfit::detail
