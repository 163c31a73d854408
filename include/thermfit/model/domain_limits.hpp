#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "thermfit/statistics/quantiles.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Value that T2 of a new observation stays below with `probability`, for `components` scores whose variances come
/// from `rows` training rows: `a (n-1) (n+1) / (n (n-a)) F(a, n-a)` (Tracy, Young, Mason, Journal of Quality
/// Technology 24, 1992). 0 without components, infinite where the rows are too few to say.
inline double t2_limit(double probability, Index components, Index rows) {
  const double a = static_cast<double>(components), n = static_cast<double>(rows);
  if (components == 0) return 0;
  if (rows <= components) return std::numeric_limits<double>::infinity();
  return a * (n - 1) * (n + 1) / (n * (n - a)) * f_quantile(probability, a, n - a);
}

/// Value that SPE of a new observation stays below with `probability`. `residual_covariance` is that of the training
/// residuals (points x points, divisor rows - 1), which lie in `directions` dimensions.
///
/// A new SPE is a sum of lambda_i F_i over residual directions, each F with 1 and n-1-a degrees of freedom because
/// lambda_i is itself estimated, times (n-1)/(n-1-a) (1 + (a+1)/n) for what the training residuals lost to the fit.
/// Its first three cumulants, with the sampling bias of tr(S^2) and tr(S^3) taken out (Wishart moments), give a
/// shifted chi-squared variable (Imhof, Biometrika 48, 1961); one direction is exact. The classic limit of Jackson and
/// Mudholkar (Technometrics 21, 1979) uses the same traces but takes the covariance as known: on 79 rows its 1 % limit
/// is passed by up to 2 % of new observations, and by a fifth of them where eigenvalues are very uneven.
/// 0 where no direction is left.
inline double spe_limit(double probability, const Matrix& residual_covariance, Index directions, Index components,
                        Index rows) {
  const double theta_1 = residual_covariance.trace();
  if (directions <= 0 || !(theta_1 > 0)) return 0;
  const double n = static_cast<double>(rows), a = static_cast<double>(components), d = static_cast<double>(directions);
  const double freedom = std::max(1.0, n - 1 - a);
  const double lost_to_fit = (n - 1) / freedom * (1 + (a + 1) / n);
  const Matrix square = residual_covariance * residual_covariance;
  const double tr_2 = square.trace(), tr_3 = square.cwiseProduct(residual_covariance.transpose()).sum();
  const double theta_2 = std::max(theta_1 * theta_1 / d, freedom * freedom / ((freedom - 1) * (freedom + 2)) *
                                                             (tr_2 - theta_1 * theta_1 / freedom));
  const double equal_directions = std::min(d, theta_1 * theta_1 / theta_2);
  if (directions == 1 || freedom <= 6) {
    return lost_to_fit * theta_1 * f_quantile(probability, equal_directions, equal_directions * freedom);
  }
  const double theta_3 =
      (tr_3 - 3 * (1 + 1 / freedom) / freedom * theta_1 * theta_2 - theta_1 * theta_1 * theta_1 / (freedom * freedom)) /
      (1 + 3 / freedom + 4 / (freedom * freedom));
  const double skew_directions =
      theta_3 > 0 ? std::clamp(theta_2 * theta_2 * theta_2 / (theta_3 * theta_3), 1.0, d) : equal_directions;
  // Cumulants of F(1, freedom), then of the weighted sum.
  const double f_mean = freedom / (freedom - 2);
  const double f_variance = 2 * f_mean * f_mean * (freedom - 1) / (freedom - 4);
  const double f_skewness = freedom * std::sqrt(8 * (freedom - 4)) / ((freedom - 6) * std::sqrt(freedom - 1));
  const double mean = f_mean * theta_1;
  const double variance = f_variance * theta_2;
  const double skewness = f_skewness / std::sqrt(skew_directions);
  const double degrees = 8 / (skewness * skewness);
  return lost_to_fit * (mean + std::sqrt(variance / (2 * degrees)) * (chi2_quantile(probability, degrees) - degrees));
}

}  // namespace thermfit
