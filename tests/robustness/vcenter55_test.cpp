#include "support/vcenter55.hpp"

#include "support/catch.hpp"
#include "thermfit/fit/fit.hpp"
#include "thermfit/number.hpp"
#include "thermfit/robustness/cross_batch.hpp"
#include "thermfit/select/correlation.hpp"
#include "thermfit/select/fcgr.hpp"

using namespace thermfit;

TEST_CASE("the sweep over points of vcenter55 gives the reference row to the printed digits", "[robustness]") {
  const std::vector<Observations<>> batches = observe(vcenter55());
  FitOptions options;
  options.components = ComponentRule::fixed(1);
  const auto steps = sweep_points(batches, ByCorrelation{}, [&](const Moments<>& m) { return fit_pls(m, options); });
  const std::vector<std::string> mean{"6.38", "5.72", "5.85", "5.99", "5.98", "6.70", "7.13", "7.53", "7.53", "8.40"};
  const std::vector<std::string> deviation{"1.01", "0.61", "0.83", "0.81", "0.80",
                                           "0.95", "0.97", "2.09", "1.23", "2.03"};
  REQUIRE(steps.size() == 10);
  for (std::size_t k = 0; k < 10; ++k) {
    CAPTURE(k + 1);
    CHECK(fixed_text(steps[k].robustness[0].per_model.S_mean, 2) == mean[k]);
    CHECK(fixed_text(steps[k].robustness[0].per_model.S_std, 2) == deviation[k]);
  }
}

TEST_CASE("least squares on two FCGR points of vcenter55 gives the reference row to the printed digits",
          "[robustness]") {
  const SweepStep<> step =
      cross_batch(observe(vcenter55()), ByFcgr{}, 2, [](const Moments<>& m) { return fit_mlr(m); });
  CHECK(fixed_text(step.robustness[0].per_model.S_mean, 2) == "6.91");
  CHECK(fixed_text(step.robustness[0].per_model.S_std, 2) == "1.07");
}
