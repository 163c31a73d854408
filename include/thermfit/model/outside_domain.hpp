#pragma once

#include "thermfit/model/training_domain.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// How a row lies to a model's training domain.
struct OutsideDomain {
  bool range = false;  ///< a point below its lowest or above its highest training value
  bool t2 = false;     ///< familiar relations between the points, but further out
  bool spe = false;    ///< relations between the points that training did not show
  /// Outside in any way.
  bool any() const { return range || t2 || spe; }
};

/// Judges a distance at the 95 % or 99 % limits, its range apart. A limit of 0 means that there is nothing to judge; a
/// distance that is not a number lies outside.
template <typename Scalar, int Sensors, int Components>
OutsideDomain outside_limits(const TrainingDomain<Scalar, Sensors, Components>& domain,
                             const DomainDistance<Scalar>& distance, int percent) {
  const auto beyond = [](Scalar value, Scalar limit) { return limit > 0 && !(value <= limit); };
  OutsideDomain outside;
  outside.t2 = beyond(distance.t2, percent == 95 ? domain.t2_limit_95 : domain.t2_limit_99);
  outside.spe = beyond(distance.spe, percent == 95 ? domain.spe_limit_95 : domain.spe_limit_99);
  return outside;
}

/// Judges one sample of the model's temperatures (sensors long) at the 99 % limits and by range.
template <typename Scalar, int Sensors, int Components, typename Temperatures>
OutsideDomain outside_domain(const TrainingDomain<Scalar, Sensors, Components>& domain,
                             const Eigen::MatrixBase<Temperatures>& temperatures) {
  OutsideDomain outside = outside_limits(domain, domain.distance(temperatures), 99);
  outside.range =
      (temperatures.array() < domain.lowest.array()).any() || (temperatures.array() > domain.highest.array()).any();
  return outside;
}

/// Shares of rows outside the training domain, 0…1.
struct OutsideShares {
  double range = 0;  ///< beyond the range of a point
  double t2 = 0;     ///< beyond the limit of T2
  double spe = 0;    ///< beyond the limit of SPE
  double any = 0;    ///< beyond any of them
};

/// Over rows x sensors of the model's temperatures; all 0 without rows.
template <typename Scalar, int Sensors, int Components, typename Temperatures>
OutsideShares outside_shares(const TrainingDomain<Scalar, Sensors, Components>& domain,
                             const Eigen::MatrixBase<Temperatures>& temperatures) {
  const MatrixView<Scalar> rows = temperatures;
  OutsideShares shares;
  if (rows.rows() == 0) return shares;
  const double row = 1 / static_cast<double>(rows.rows());
  for (Index r = 0; r < rows.rows(); ++r) {
    const OutsideDomain outside = outside_domain(domain, rows.row(r).transpose());
    shares.range += outside.range * row;
    shares.t2 += outside.t2 * row;
    shares.spe += outside.spe * row;
    shares.any += outside.any() * row;
  }
  return shares;
}

}  // namespace thermfit
