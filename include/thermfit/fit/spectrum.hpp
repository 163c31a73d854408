#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "thermfit/fit/linear_fit.hpp"

namespace thermfit {

/// Largest condition number of standardised temperatures at which coefficients are computed from moments. Moments
/// square it: at the limit a coefficient may be off by 1e6^2 times the double's 1e-16, that is one part in ten
/// thousand. Past it a fit from moments throws; a fit from rows does not.
inline constexpr double moments_condition_limit = 1e6;

/// Principal directions of the standardised temperatures and the regression of the errors on each: MLR, PCR and ridge
/// are this with all, the first few, and shrunken directions.
struct Spectrum {
  Vector variance;    ///< per direction, decreasing, only those that stand out from rounding
  Matrix directions;  ///< points x directions, orthonormal
  Matrix slopes;      ///< directions x responses: regression of the standardised errors on each score
  bool squared = false;

  Index rank() const { return variance.size(); }

  double condition_number() const { return rank() == 0 ? 1 : std::sqrt(variance(0) / variance(rank() - 1)); }

  /// Throws Error when direction `last` (its penalised variance) cannot be told safely from rounding.
  void require_resolved(Index last, double penalty = 0) const {
    if (!squared || last < 0 || last >= rank()) return;
    const double condition = std::sqrt((variance(0) + penalty) / (variance(last) + penalty));
    if (condition > moments_condition_limit) refuse(condition);
  }

  [[noreturn]] static void refuse(double condition) {
    throw Error("temperatures", "a condition number of 1e" + std::to_string(std::lround(std::log10(condition))),
                "1e6 or less for a fit from moments",
                "fit from rows (TrainingPlan::row_wise), take fewer components or points, or use ridge regression");
  }
};

/// Share of the largest eigenvalue (from moments) or singular value (from rows) up to which a direction is rounding
/// and does not count: 32 machine epsilons per channel.
inline double rank_tolerance(Index channels) {
  return 32 * static_cast<double>(channels) * std::numeric_limits<double>::epsilon();
}

namespace detail {

inline Index above(const Vector& decreasing, double tolerance) {
  Index rank = 0;
  while (rank < decreasing.size() && decreasing(rank) > tolerance * decreasing(0)) ++rank;
  return rank;
}

}  // namespace detail

/// By eigenvalues of the temperatures' correlation matrix.
inline Spectrum spectrum(const StandardisedMoments& moments) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(moments.xx);
  Spectrum result;
  result.squared = true;
  const Vector decreasing = eigen.eigenvalues().reverse();
  const Index rank = detail::above(decreasing, rank_tolerance(decreasing.size()));
  result.variance = decreasing.head(rank);
  result.directions = eigen.eigenvectors().rowwise().reverse().leftCols(rank);
  result.slopes = result.variance.cwiseInverse().asDiagonal() * (result.directions.transpose() * moments.xy);
  return result;
}

/// By singular values of the rows; resolves condition numbers up to about 1e13.
inline Spectrum spectrum(const StandardisedRows& rows) {
  const Eigen::JacobiSVD<Matrix> svd(rows.x, Eigen::ComputeThinU | Eigen::ComputeThinV);
  Spectrum result;
  const Index rank = detail::above(svd.singularValues(), rank_tolerance(rows.x.cols()));
  const Vector singular = svd.singularValues().head(rank);
  result.variance = singular.cwiseAbs2();
  result.directions = svd.matrixV().leftCols(rank);
  result.slopes = singular.cwiseInverse().asDiagonal() * (svd.matrixU().leftCols(rank).transpose() * rows.y);
  return result;
}

namespace detail {

/// The part of a result that all methods share. `parameters` besides the intercept.
template <class Standardised>
LinearFit linear_fit(const Standardised& data, Matrix coefficients, const Spectrum& temperatures, double parameters) {
  LinearFit fit;
  fit.model = data.channels.undo(coefficients);
  fit.standardised_coefficients = std::move(coefficients);
  fit.channels = data.channels;
  fit.rows = data.rows;
  fit.rank = temperatures.rank();
  fit.condition_number = temperatures.condition_number();
  fit.degrees_of_freedom = static_cast<double>(data.rows - 1) - parameters;
  fit.residual_deviation_um = data.residual_deviation(fit.standardised_coefficients);
  return fit;
}

}  // namespace detail

}  // namespace thermfit
