#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "thermfit/fit/impl/singular_values.hpp"
#include "thermfit/fit/impl/standardised.hpp"
#include "thermfit/fit/linear_fit.hpp"

namespace thermfit::detail {

/// Principal directions of the standardised temperatures and the regression of the errors on each: MLR, PCR and ridge
/// are this with all, the first few, and shrunken directions.
template <typename Scalar>
struct Spectrum {
  VectorX<Scalar> variance;    ///< per direction, decreasing, only those that stand out from rounding
  MatrixX<Scalar> directions;  ///< points x directions, orthonormal
  MatrixX<Scalar> slopes;      ///< directions x responses: regression of the standardised errors on each score
  bool squared = false;        ///< from moments, so that the condition number is squared

  Index rank() const { return variance.size(); }

  Scalar condition_number() const { return rank() == 0 ? 1 : std::sqrt(variance(0) / variance(rank() - 1)); }

  /// Throws Error when direction `last` (its penalised variance) cannot be told safely from rounding.
  void require_resolved(Index last, Scalar penalty = 0) const {
    if (!squared || last < 0 || last >= rank()) return;
    const Scalar condition = std::sqrt((variance(0) + penalty) / (variance(last) + penalty));
    if (condition > moments_condition_limit<Scalar>) refuse(condition);
  }

  [[noreturn]] static void refuse(Scalar condition) {
    throw Error("temperatures", "a condition number of 1e" + std::to_string(std::lround(std::log10(condition))),
                "1e" + std::to_string(moments_condition_digits<Scalar>) + " or less for a fit from moments",
                "fit from rows (TrainingPlan::row_wise), take fewer components or points, or use ridge regression");
  }
};

/// Share of the largest eigenvalue (from moments) or singular value (from rows) up to which a direction is rounding
/// and does not count: 32 machine epsilons per channel.
template <typename Scalar>
Scalar rank_tolerance(Index channels) {
  return 32 * static_cast<Scalar>(channels) * std::numeric_limits<Scalar>::epsilon();
}

template <typename Scalar>
Index above(const VectorX<Scalar>& decreasing, Scalar tolerance) {
  Index rank = 0;
  while (rank < decreasing.size() && decreasing(rank) > tolerance * decreasing(0)) ++rank;
  return rank;
}

/// By eigenvalues of the temperatures' correlation matrix.
template <typename Scalar>
Spectrum<Scalar> spectrum(const StandardisedMoments<Scalar>& moments) {
  const Eigen::SelfAdjointEigenSolver<MatrixX<Scalar>> eigen(moments.xx);
  Spectrum<Scalar> result;
  result.squared = true;
  const VectorX<Scalar> decreasing = eigen.eigenvalues().reverse();
  const Index rank = above(decreasing, rank_tolerance<Scalar>(decreasing.size()));
  result.variance = decreasing.head(rank);
  result.directions = eigen.eigenvectors().rowwise().reverse().leftCols(rank);
  result.slopes = result.variance.cwiseInverse().asDiagonal() * (result.directions.transpose() * moments.xy);
  return result;
}

/// By singular values of the rows; resolves condition numbers up to about 1e13 in double.
template <typename Scalar>
Spectrum<Scalar> spectrum(const StandardisedRows<Scalar>& rows) {
  const SingularValues<Scalar> svd(rows.x);
  Spectrum<Scalar> result;
  const Index rank = above(svd.values, rank_tolerance<Scalar>(rows.x.cols()));
  const VectorX<Scalar> singular = svd.values.head(rank);
  result.variance = singular.cwiseAbs2();
  result.directions = svd.v.leftCols(rank);
  result.slopes = singular.cwiseInverse().asDiagonal() * (svd.u.leftCols(rank).transpose() * rows.y);
  return result;
}

/// The part of a result that all methods share. `parameters` besides the intercept.
template <template <typename> class Standardised, typename Scalar>
LinearFit<Scalar> linear_fit(const Standardised<Scalar>& data, MatrixX<Scalar> coefficients,
                             const Spectrum<Scalar>& temperatures, Scalar parameters) {
  LinearFit<Scalar> fit;
  fit.model = data.channels.undo(coefficients);
  fit.standardised_coefficients = std::move(coefficients);
  fit.channels = data.channels;
  fit.rows = data.rows;
  fit.rank = temperatures.rank();
  fit.condition_number = temperatures.condition_number();
  fit.degrees_of_freedom = static_cast<Scalar>(data.rows - 1) - parameters;
  fit.residual_deviation_um = data.residual_deviation(fit.standardised_coefficients);
  return fit;
}

THERMFIT_COMPILED_TEMPLATE(Spectrum<double> spectrum<double>(const StandardisedMoments<double>&));
THERMFIT_COMPILED_TEMPLATE(Spectrum<double> spectrum<double>(const StandardisedRows<double>&));

}  // namespace thermfit::detail
