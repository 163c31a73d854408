#pragma once

#include <cmath>
#include <limits>

#include "support/catch.hpp"
#include "support/vcenter55.hpp"
#include "thermfit/fit/jackknife.hpp"
#include "thermfit/fit/pls.hpp"
#include "thermfit/robustness/cross_batch.hpp"
#include "thermfit/robustness/leave_one_batch_out.hpp"
#include "thermfit/select/correlation.hpp"
#include "thermfit/select/fcgr.hpp"

/// The campaign of data/vcenter55 in two scalars: the lesser agrees with the greater to its own digits.

namespace scalars {

using namespace thermfit;

/// Distance from the reference relative to its largest entry, in units of Scalar's epsilon.
template <typename Scalar, typename A, typename B>
double ulps(const Eigen::DenseBase<A>& ours, const Eigen::DenseBase<B>& reference) {
  using Reference = typename B::Scalar;
  const auto difference = (ours.derived().template cast<Reference>() - reference.derived()).eval();
  return static_cast<double>(difference.cwiseAbs().maxCoeff() / reference.derived().cwiseAbs().maxCoeff() /
                             static_cast<Reference>(std::numeric_limits<Scalar>::epsilon()));
}
template <typename Scalar, typename Reference>
double ulps(Scalar ours, Reference reference) {
  return static_cast<double>(std::abs(static_cast<Reference>(ours) - reference) / std::abs(reference) /
                             static_cast<Reference>(std::numeric_limits<Scalar>::epsilon()));
}

inline const Campaign& campaign() {
  static const Campaign read = vcenter55();
  return read;
}

template <typename Scalar>
std::vector<Observations<Scalar>> seen() {
  return observe<Scalar>(campaign());
}

inline FitOptions one_component() {
  FitOptions options;
  options.components = ComponentRule::fixed(1);
  return options;
}

template <typename Ours, typename Reference>
void rankings_agree() {
  const auto ours = seen<Ours>();
  const auto reference = seen<Reference>();
  for (std::size_t b = 0; b < ours.size(); ++b) {
    CAPTURE(b);
    CHECK(ulps<Ours>(correlations(ours[b].moments), correlations(reference[b].moments)) < 50);
    const VectorX<Ours> grades = grey_relational_grades(ours[b].temperatures, ours[b].errors);
    CHECK(ulps<Ours>(grades, grey_relational_grades(reference[b].temperatures, reference[b].errors)) < 50);
    for (Index k = 1; k <= 3; ++k) {
      CHECK(ByCorrelation{}(ours[b], k) == ByCorrelation{}(reference[b], k));
      CHECK(ByFcgr{}(ours[b], k) == ByFcgr{}(reference[b], k));
    }
  }
}

template <typename Ours, typename Reference>
void robustness_agrees() {
  const FitOptions options = one_component();
  const auto fitter = [&](const auto& moments) { return fit_pls(moments, options); };
  const auto ours = cross_batch(seen<Ours>(), ByCorrelation{}, 2, fitter);
  const auto reference = cross_batch(seen<Reference>(), ByCorrelation{}, 2, fitter);
  CHECK(ulps<Ours>(ours.S[0], reference.S[0]) < 200);
  CHECK(ulps(ours.robustness[0].per_model.S_mean, reference.robustness[0].per_model.S_mean) < 100);
  CHECK(ulps(ours.robustness[0].per_model.S_std, reference.robustness[0].per_model.S_std) < 1000);
  CHECK(ulps(ours.robustness[0].pooled.S_std, reference.robustness[0].pooled.S_std) < 1000);
  CHECK(ours.robustness[0].worst_model == reference.robustness[0].worst_model);
  CHECK(ours.robustness[0].worst_batch == reference.robustness[0].worst_batch);
}

template <typename Ours, typename Reference>
void left_out_agrees() {
  const FitOptions options = one_component();
  const auto fitter = [&](const auto& moments) { return fit_pls(moments, options); };
  const auto ours = moments_of(seen<Ours>());
  const auto reference = moments_of(seen<Reference>());
  const auto left_out = leave_one_batch_out(ours, fitter);
  const auto exact = leave_one_batch_out(reference, fitter);
  CHECK(ulps(left_out.mean(0, &Residuals<Ours>::rmse), exact.mean(0, &Residuals<Reference>::rmse)) < 100);
  CHECK(left_out.worst(0, &Residuals<Ours>::rmse) == exact.worst(0, &Residuals<Reference>::rmse));
  const auto spread = jackknife(ours, fitter);
  const auto exact_spread = jackknife(reference, fitter);
  CHECK(ulps<Ours>(spread.deviation, exact_spread.deviation) < 2000);
  CHECK(ulps<Ours>(spread.half_width(.95), exact_spread.half_width(.95)) < 2000);
}

}  // namespace scalars
