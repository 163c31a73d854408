#pragma once

#include <limits>
#include <optional>

#include "thermfit/types.hpp"

namespace thermfit {

/// What is done to the channels before a fit, besides centring them. Scales are standard deviations, divisor n - 1.
enum class Scaling {
  centre,        ///< nothing more
  temperatures,  ///< temperatures to unit deviation (the convention of R)
  both           ///< temperatures and errors to unit deviation (the paper's, and scikit-learn's)
};

/// When to stop taking latent variables.
struct ComponentRule {
  /// What decides.
  enum class Kind {
    explained,           ///< the share of temperature variance that the components explain
    fixed,               ///< the number asked for
    leave_one_batch_out  ///< the error on batches left out
  };
  Kind kind = Kind::explained;  ///< which of them
  Index count = 0;              ///< fixed: how many; leave_one_batch_out: at most how many, 0 for no bound
  double enough = .90;          ///< explained: share of temperature variance beyond which to stop
  double least_gain = .05;      ///< explained: gain of one more below which it is not taken
  /// The paper's: until 90 % are explained, or one more would add less than 5 %.
  static ComponentRule paper() { return {}; }
  /// Exactly `count`, or as many as the rank allows.
  static ComponentRule fixed(Index count) { return {Kind::fixed, count}; }
  /// As many as predict left-out batches best, at most `at_most` (0: no bound).
  static ComponentRule leave_one_batch_out(Index at_most = 0) { return {Kind::leave_one_batch_out, at_most}; }
};

/// Settings of a fit; every method reads those that concern it.
struct FitOptions {
  Scaling scaling = Scaling::both;                    ///< PLS, PCR and ridge; MLR is the same under any
  ComponentRule components = ComponentRule::paper();  ///< PLS and PCR
  std::optional<double> ridge_lambda;                 ///< ridge; none: chosen by leaving one batch out
};

/// Decimal places of moments_condition_limit: two less than the digits of Scalar, halved.
template <typename Scalar = double>
inline constexpr int moments_condition_digits = (std::numeric_limits<Scalar>::digits10 - 2) / 2;

namespace detail {

template <typename Scalar>
constexpr Scalar power_of_ten(int exponent) {
  return exponent == 0 ? Scalar(1) : 10 * power_of_ten<Scalar>(exponent - 1);
}

}  // namespace detail

/// Largest condition number of standardised temperatures at which coefficients are computed from moments: 1e6 for
/// double, 1e2 for float, 1e8 for an 80-bit long double. Moments square it: at the limit a coefficient of double may be
/// off by 1e6^2 times its 1e-16, that is one part in ten thousand (float and long double: in a thousand). Past it a fit
/// from moments throws; a fit from rows does not.
template <typename Scalar = double>
inline constexpr Scalar moments_condition_limit = detail::power_of_ten<Scalar>(moments_condition_digits<Scalar>);

}  // namespace thermfit
