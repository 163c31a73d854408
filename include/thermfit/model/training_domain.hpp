#pragma once

#include "thermfit/types.hpp"

namespace thermfit {

/// How far a sample lies from the rows a model was trained on. Small is familiar.
template <class Scalar = double>
struct DomainDistance {
  Scalar t2;   ///< Hotelling's T2: distance inside the plane of the latent variables
  Scalar spe;  ///< squared prediction error (Q): distance to that plane, in standardised units squared
};

/// The region of temperatures a model knows, and the limits beyond which a new sample counts as foreign.
///
/// With z = (x - mean) / scale, scores t = rotations' z and residual e = z - loadings t:
/// T2 = sum_a t_a^2 / score_variance_a, SPE = e'e. (Jackson, A User's Guide to Principal Components, 1991, ch. 2.)
/// `mean`, `scale`, `lowest`, `highest`: one per sensor, in the model's temperatures. `rotations`, `loadings`:
/// Sensors x Components. Fixed sizes neither allocate nor throw: this is controller code.
template <class Scalar = double, int Sensors = Eigen::Dynamic, int Components = Eigen::Dynamic>
struct TrainingDomain {
  /// One number per sensor.
  using PerSensor = Eigen::Matrix<Scalar, Sensors, 1>;
  PerSensor lowest;                                      ///< of the range seen in training
  PerSensor highest;                                     ///< of the range seen in training
  PerSensor mean;                                        ///< of the training rows
  PerSensor scale;                                       ///< that temperatures are divided by
  Eigen::Matrix<Scalar, Sensors, Components> rotations;  ///< standardised temperatures to scores
  Eigen::Matrix<Scalar, Sensors, Components> loadings;   ///< scores to standardised temperatures
  Eigen::Matrix<Scalar, Components, 1> score_variance;   ///< per component, divisor rows - 1
  Scalar t2_limit_95 = 0;                                ///< for a new observation
  Scalar t2_limit_99 = 0;                                ///< for a new observation
  Scalar spe_limit_95 = 0;                               ///< 0 where the components span all sensors: then SPE is 0 too
  Scalar spe_limit_99 = 0;                               ///< 0 where the components span all sensors: then SPE is 0 too

  /// T2 and SPE of one sample of the model's temperatures (Sensors long).
  template <class Temperatures>
  DomainDistance<Scalar> distance(const Eigen::MatrixBase<Temperatures>& temperatures) const noexcept {
    PerSensor z = (temperatures - mean).cwiseQuotient(scale);
    const Eigen::Matrix<Scalar, Components, 1> t = rotations.transpose().lazyProduct(z);
    z.noalias() -= loadings.lazyProduct(t);
    return {t.cwiseProduct(t).cwiseQuotient(score_variance).sum(), z.squaredNorm()};
  }

  /// The same domain, its numbers rounded to Other.
  template <typename Other>
  TrainingDomain<Other, Sensors, Components> cast() const {
    const auto to = [](const auto& numbers) { return numbers.template cast<Other>(); };
    return {to(lowest),
            to(highest),
            to(mean),
            to(scale),
            to(rotations),
            to(loadings),
            to(score_variance),
            static_cast<Other>(t2_limit_95),
            static_cast<Other>(t2_limit_99),
            static_cast<Other>(spe_limit_95),
            static_cast<Other>(spe_limit_99)};
  }
};

}  // namespace thermfit
