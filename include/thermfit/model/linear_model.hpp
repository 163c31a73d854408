#pragma once

#include "thermfit/types.hpp"

namespace thermfit {

/// Thermal errors from temperatures: `error_j = intercept_j + sum_i coefficient_ij * temperature_i`.
///
/// Bare arithmetic, no names: with fixed sizes it neither allocates nor throws and is what runs on the controller.
/// `coefficients` is Sensors x Errors in um/K, `intercept` is Errors long in um.
template <class Scalar = double, int Sensors = Eigen::Dynamic, int Errors = Eigen::Dynamic>
struct LinearModel {
  Eigen::Matrix<Scalar, Sensors, Errors> coefficients;  ///< Sensors x Errors, um/K
  Eigen::Matrix<Scalar, Errors, 1> intercept;           ///< Errors long, um

  /// How many temperatures it reads.
  Index sensors() const noexcept { return coefficients.rows(); }
  /// How many errors it predicts.
  Index errors() const noexcept { return coefficients.cols(); }

  /// One sample: temperatures (Sensors long; K of rise or degC, as the model was fitted) to errors in um.
  template <class Temperatures>
  Eigen::Matrix<Scalar, Errors, 1> predict(const Eigen::MatrixBase<Temperatures>& temperatures) const noexcept {
    Eigen::Matrix<Scalar, Errors, 1> result = intercept;
    result.noalias() += coefficients.transpose().lazyProduct(temperatures);
    return result;
  }

  /// Many samples at once: rows x Sensors to rows x Errors. Host side; allocates the result.
  template <class Rows>
  MatrixX<Scalar> predict_rows(const Eigen::MatrixBase<Rows>& temperatures) const {
    return (temperatures * coefficients).rowwise() + intercept.transpose();
  }

  /// The same model, its numbers rounded to Other.
  template <typename Other>
  LinearModel<Other, Sensors, Errors> cast() const {
    return {coefficients.template cast<Other>(), intercept.template cast<Other>()};
  }
};

}  // namespace thermfit
