#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "thermfit/moments/observations.hpp"

namespace thermfit {

/// Classes of temperature points, each in column order, classes in the order of their first member.
using PointClasses = std::vector<std::vector<Index>>;

namespace detail {

/// Size of the correlations of `points` made transitive: r_ij = max over paths of the least similarity on the path.
template <typename Scalar>
MatrixX<Scalar> similarity_closure(const Moments<Scalar>& moments, const std::vector<Index>& points) {
  const Index count = static_cast<Index>(points.size());
  const MatrixX<Scalar> products = moments.temperature_products()(points, points);
  const VectorX<Scalar> size = products.diagonal().cwiseSqrt();
  MatrixX<Scalar> closure = (size.cwiseInverse().asDiagonal() * products * size.cwiseInverse().asDiagonal()).cwiseAbs();
  for (Index via = 0; via < count; ++via) {  // widest paths: r_ij = max_k min(r_ik, r_kj)
    for (Index i = 0; i < count; ++i) {
      for (Index j = 0; j < count; ++j) {
        closure(i, j) = std::max(closure(i, j), std::min(closure(i, via), closure(via, j)));
      }
    }
  }
  closure.diagonal().setOnes();
  return closure;
}

/// Classes of `points` whose closure reaches `level`.
template <typename Scalar>
PointClasses classes_at(Scalar level, const MatrixX<Scalar>& closure, const std::vector<Index>& points) {
  PointClasses result;
  std::vector<bool> taken(points.size(), false);
  for (Index i = 0; i < closure.rows(); ++i) {
    if (taken[static_cast<std::size_t>(i)]) continue;
    result.emplace_back();
    for (Index j = i; j < closure.rows(); ++j) {
      if (taken[static_cast<std::size_t>(j)] || (j != i && closure(i, j) < level)) continue;
      taken[static_cast<std::size_t>(j)] = true;
      result.back().push_back(points[static_cast<std::size_t>(j)]);
    }
  }
  return result;
}

}  // namespace detail

/// Fuzzy clustering (Zadeh's similarity relation, Information Sciences 3, 1971): similarity of two points is the size
/// of their correlation; its max–min transitive closure is cut at the lowest level that gives at least `classes`
/// classes (points whose closure reaches the level share one). Ties may give more. Constant points belong to none.
/// Allocates.
template <typename Scalar>
PointClasses fuzzy_classes(const Moments<Scalar>& moments, Index classes) {
  std::vector<Index> points;
  for (Index p = 0; p < moments.temperatures(); ++p) {
    if (!moments.constant(p)) points.push_back(p);
  }
  const MatrixX<Scalar> closure = detail::similarity_closure(moments, points);
  std::vector<Scalar> levels(closure.data(), closure.data() + closure.size());
  std::sort(levels.begin(), levels.end());
  PointClasses result;
  for (auto level = levels.begin(); level != levels.end(); level = std::upper_bound(level, levels.end(), *level)) {
    result = detail::classes_at(*level, closure, points);
    if (static_cast<Index>(result.size()) >= classes) return result;
  }
  // Points equal to the last digit: each its own class.
  if (!points.empty()) result = detail::classes_at(Scalar(2), closure, points);
  return result;
}

/// Grey relational grade (Deng, 1982) of every temperature point with error `response`, or the mean over all errors if
/// that is negative: with series centred on their mean and divided by their range, and differences D_p(t) = |point -
/// error|, `mean over t of (min D + c max D) / (D_p(t) + c max D)`, extremes over all points and rows, c the
/// distinguishing coefficient. Temperatures rows x points, errors rows x responses; a constant series counts as zero.
/// One grade per point, 0…1. Allocates.
template <typename Temperatures, typename Errors, typename Scalar = typename Temperatures::Scalar>
VectorX<Scalar> grey_relational_grades(const Eigen::MatrixBase<Temperatures>& temperatures,
                                       const Eigen::MatrixBase<Errors>& errors, Index response = -1,
                                       double coefficient = .5) {
  const MatrixView<Scalar> points = temperatures, responses = errors;
  const auto scaled = [](const auto& column) -> VectorX<Scalar> {
    const Scalar range = column.maxCoeff() - column.minCoeff();
    return (column.array() - column.mean()) * (range > 0 ? 1 / range : 0);
  };
  VectorX<Scalar> grades = VectorX<Scalar>::Zero(points.cols());
  if (points.rows() == 0 || points.cols() == 0) return grades;
  const Index from = response < 0 ? 0 : response, to = response < 0 ? responses.cols() : response + 1;
  for (Index e = from; e < to; ++e) {
    const VectorX<Scalar> error = scaled(responses.col(e));
    MatrixX<Scalar> difference(points.rows(), points.cols());
    for (Index p = 0; p < points.cols(); ++p) difference.col(p) = (scaled(points.col(p)) - error).cwiseAbs();
    const Scalar least = difference.minCoeff(), most = static_cast<Scalar>(coefficient) * difference.maxCoeff();
    if (!(most > 0)) return VectorX<Scalar>::Ones(points.cols());
    grades += ((least + most) / (difference.array() + most)).colwise().mean().matrix().transpose() /
              static_cast<Scalar>(to - from);
  }
  return grades;
}

/// The baseline of the paper: fuzzy clustering, then in each class the point with the largest grey relational grade
/// to the error; the first `count` classes. A selection rule (select/rule.hpp) that needs the rows: Error without.
struct ByFcgr {
  Index response = -1;      ///< error it looks at; negative: all
  double coefficient = .5;  ///< distinguishing coefficient of the grey relational grade

  /// The best `count` points of `batch`, or fewer where there are no more. Allocates.
  template <typename Scalar>
  std::vector<Index> operator()(const Observations<Scalar>& batch, Index count) const {
    if (!batch.has_rows()) {
      throw Error("fcgr", "moments only", "a batch with its rows", "grey relational grades need the series");
    }
    const VectorX<Scalar> grades = grey_relational_grades(batch.temperatures, batch.errors, response, coefficient);
    std::vector<Index> points;
    for (const std::vector<Index>& members : fuzzy_classes(batch.moments, count)) {
      if (static_cast<Index>(points.size()) == count) break;
      points.push_back(
          *std::max_element(members.begin(), members.end(), [&](Index a, Index b) { return grades(a) < grades(b); }));
    }
    return points;
  }
};

THERMFIT_COMPILED_TEMPLATE(std::vector<Index> ByFcgr::operator()<double>(const Observations<double>&, Index) const);

}  // namespace thermfit
