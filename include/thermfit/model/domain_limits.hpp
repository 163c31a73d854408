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
/// 0 where no direction is left. The quantiles it is made of are those of double. Allocates one matrix.
template <typename Covariance, typename Scalar = typename Covariance::Scalar>
Scalar spe_limit(double probability, const Eigen::MatrixBase<Covariance>& residual_covariance, Index directions,
                 Index components, Index rows) {
  const MatrixView<Scalar> covariance = residual_covariance;
  const Scalar theta_1 = covariance.trace();
  if (directions <= 0 || !(theta_1 > 0)) return 0;
  const Scalar n = static_cast<Scalar>(rows), a = static_cast<Scalar>(components), d = static_cast<Scalar>(directions);
  const Scalar freedom = std::max(Scalar(1), n - 1 - a);
  const Scalar lost_to_fit = (n - 1) / freedom * (1 + (a + 1) / n);
  const MatrixX<Scalar> square = covariance * covariance;
  const Scalar tr_2 = square.trace(), tr_3 = square.cwiseProduct(covariance.transpose()).sum();
  const Scalar theta_2 = std::max(theta_1 * theta_1 / d, freedom * freedom / ((freedom - 1) * (freedom + 2)) *
                                                             (tr_2 - theta_1 * theta_1 / freedom));
  const Scalar equal_directions = std::min(d, theta_1 * theta_1 / theta_2);
  if (directions == 1 || freedom <= 6) {
    return lost_to_fit * theta_1 *
           static_cast<Scalar>(f_quantile(probability, static_cast<double>(equal_directions),
                                          static_cast<double>(equal_directions * freedom)));
  }
  const Scalar theta_3 =
      (tr_3 - 3 * (1 + 1 / freedom) / freedom * theta_1 * theta_2 - theta_1 * theta_1 * theta_1 / (freedom * freedom)) /
      (1 + 3 / freedom + 4 / (freedom * freedom));
  const Scalar skew_directions =
      theta_3 > 0 ? std::clamp(theta_2 * theta_2 * theta_2 / (theta_3 * theta_3), Scalar(1), d) : equal_directions;
  // Cumulants of F(1, freedom), then of the weighted sum.
  const Scalar f_mean = freedom / (freedom - 2);
  const Scalar f_variance = 2 * f_mean * f_mean * (freedom - 1) / (freedom - 4);
  const Scalar f_skewness = freedom * std::sqrt(8 * (freedom - 4)) / ((freedom - 6) * std::sqrt(freedom - 1));
  const Scalar mean = f_mean * theta_1;
  const Scalar variance = f_variance * theta_2;
  const Scalar skewness = f_skewness / std::sqrt(skew_directions);
  const Scalar degrees = 8 / (skewness * skewness);
  return lost_to_fit *
         (mean + std::sqrt(variance / (2 * degrees)) *
                     (static_cast<Scalar>(chi2_quantile(probability, static_cast<double>(degrees))) - degrees));
}

}  // namespace thermfit
