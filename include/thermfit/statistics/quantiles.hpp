#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/SpecialFunctions>

#include "thermfit/error.hpp"

namespace thermfit {

namespace detail {

/// Regularised incomplete beta function I_x(a, b).
inline double incomplete_beta(double a, double b, double x) {
  using One = Eigen::Array<double, 1, 1>;
  return Eigen::betainc(One(a), One(b), One(x))(0);
}

/// Regularised lower incomplete gamma function P(a, x).
inline double incomplete_gamma(double a, double x) { return Eigen::numext::igamma(a, x); }

inline void require_probability(double probability) {
  if (!(probability > 0 && probability < 1)) throw Error("probability", "a value outside (0, 1)", "between 0 and 1");
}

inline void require_freedom(double degrees) {
  if (!(degrees > 0)) throw Error("degrees of freedom", "none", "more than 0");
}

/// The x >= 0 at which `distribution`, rising from 0 to 1, reaches `probability`: bracketed in the logarithm, then
/// halved to the last bit. Slow (some hundred evaluations) and certain.
template <class Distribution>
double invert(Distribution&& distribution, double probability) {
  double low = 1, high = 1;
  while (low > std::numeric_limits<double>::min() && distribution(low) > probability) low /= 2;
  while (high < std::numeric_limits<double>::max() / 2 && distribution(high) < probability) high *= 2;
  for (int i = 0; i < 200; ++i) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) break;
    (distribution(middle) < probability ? low : high) = middle;
  }
  return high;
}

}  // namespace detail

/// Quantiles: the value that a variable stays below with `probability` (0 to 1, exclusive; Error otherwise).

/// Of the F distribution with `numerator` and `denominator` degrees of freedom (not necessarily whole).
inline double f_quantile(double probability, double numerator, double denominator) {
  detail::require_probability(probability);
  detail::require_freedom(numerator);
  detail::require_freedom(denominator);
  return detail::invert(
      [&](double f) {
        return detail::incomplete_beta(numerator / 2, denominator / 2, numerator * f / (numerator * f + denominator));
      },
      probability);
}

/// Of the chi-squared distribution.
inline double chi2_quantile(double probability, double degrees) {
  detail::require_probability(probability);
  detail::require_freedom(degrees);
  return detail::invert([&](double x) { return detail::incomplete_gamma(degrees / 2, x / 2); }, probability);
}

/// Probability that Student's t exceeds `t` in size: the two-sided p-value.
inline double t_two_sided(double t, double degrees) {
  detail::require_freedom(degrees);
  return detail::incomplete_beta(degrees / 2, .5, degrees / (degrees + t * t));
}

/// Of Student's t distribution; from the tail, so that probabilities near 0 and 1 keep their digits.
inline double t_quantile(double probability, double degrees) {
  detail::require_probability(probability);
  if (probability == .5) return 0;
  const double tails = 2 * std::min(probability, 1 - probability);
  const double size = detail::invert([&](double t) { return -t_two_sided(t, degrees); }, -tails);
  return probability > .5 ? size : -size;
}

/// Of the standard normal distribution.
inline double normal_quantile(double probability) {
  detail::require_probability(probability);
  if (probability == .5) return 0;
  const double size = std::sqrt(chi2_quantile(2 * std::max(probability, 1 - probability) - 1, 1));
  return probability > .5 ? size : -size;
}

}  // namespace thermfit
