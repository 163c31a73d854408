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

/// float, double and long double on the campaign of data/vcenter55: each agrees with long double to its own digits.

using namespace thermfit;

namespace {

/// Distance from the reference relative to its largest entry, in units of Scalar's epsilon.
template <typename Scalar, typename A, typename B>
double ulps(const Eigen::DenseBase<A>& ours, const Eigen::DenseBase<B>& reference) {
  const auto difference = (ours.derived().template cast<long double>() - reference.derived()).eval();
  return static_cast<double>(difference.cwiseAbs().maxCoeff() / reference.derived().cwiseAbs().maxCoeff() /
                             static_cast<long double>(std::numeric_limits<Scalar>::epsilon()));
}
template <typename Scalar>
double ulps(Scalar ours, long double reference) {
  return static_cast<double>(std::abs(static_cast<long double>(ours) - reference) / std::abs(reference) /
                             static_cast<long double>(std::numeric_limits<Scalar>::epsilon()));
}

const Campaign& campaign() {
  static const Campaign read = vcenter55();
  return read;
}

template <typename Scalar>
std::vector<Observations<Scalar>> seen() {
  return observe<Scalar>(campaign());
}

FitOptions one_component() {
  FitOptions options;
  options.components = ComponentRule::fixed(1);
  return options;
}

}  // namespace

TEMPLATE_TEST_CASE("correlations, rankings and grey relational grades keep the digits of their scalar", "[robustness]",
                   float, double) {
  const auto ours = seen<TestType>();
  const auto reference = seen<long double>();
  for (std::size_t b = 0; b < ours.size(); ++b) {
    CAPTURE(b);
    CHECK(ulps<TestType>(correlations(ours[b].moments), correlations(reference[b].moments)) < 50);
    const VectorX<TestType> grades = grey_relational_grades(ours[b].temperatures, ours[b].errors);
    CHECK(ulps<TestType>(grades, grey_relational_grades(reference[b].temperatures, reference[b].errors)) < 50);
    for (Index k = 1; k <= 3; ++k) {
      CHECK(ByCorrelation{}(ours[b], k) == ByCorrelation{}(reference[b], k));
      CHECK(ByFcgr{}(ours[b], k) == ByFcgr{}(reference[b], k));
    }
  }
}

TEMPLATE_TEST_CASE("S, S_mean and S_std across batches keep the digits of their scalar", "[robustness]", float,
                   double) {
  const FitOptions options = one_component();
  const auto fitter = [&](const auto& moments) { return fit_pls(moments, options); };
  const auto ours = cross_batch(seen<TestType>(), ByCorrelation{}, 2, fitter);
  const auto reference = cross_batch(seen<long double>(), ByCorrelation{}, 2, fitter);
  CHECK(ulps<TestType>(ours.S[0], reference.S[0]) < 200);
  CHECK(ulps(ours.robustness[0].per_model.S_mean, reference.robustness[0].per_model.S_mean) < 100);
  CHECK(ulps(ours.robustness[0].per_model.S_std, reference.robustness[0].per_model.S_std) < 1000);
  CHECK(ulps(ours.robustness[0].pooled.S_std, reference.robustness[0].pooled.S_std) < 1000);
  CHECK(ours.robustness[0].worst_model == reference.robustness[0].worst_model);
  CHECK(ours.robustness[0].worst_batch == reference.robustness[0].worst_batch);
}

TEMPLATE_TEST_CASE("batches left out and the jackknife keep the digits of their scalar", "[robustness]", float,
                   double) {
  const FitOptions options = one_component();
  const auto fitter = [&](const auto& moments) { return fit_pls(moments, options); };
  const auto ours = moments_of(seen<TestType>());
  const auto reference = moments_of(seen<long double>());
  const auto left_out = leave_one_batch_out(ours, fitter);
  const auto exact = leave_one_batch_out(reference, fitter);
  CHECK(ulps(left_out.mean(0, &Residuals<TestType>::rmse), exact.mean(0, &Residuals<long double>::rmse)) < 100);
  CHECK(left_out.worst(0, &Residuals<TestType>::rmse) == exact.worst(0, &Residuals<long double>::rmse));
  const auto spread = jackknife(ours, fitter);
  const auto exact_spread = jackknife(reference, fitter);
  CHECK(ulps<TestType>(spread.deviation, exact_spread.deviation) < 2000);
  CHECK(ulps<TestType>(spread.half_width(.95), exact_spread.half_width(.95)) < 2000);
}
