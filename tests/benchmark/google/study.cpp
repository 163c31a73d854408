// The paper's comparison on data/vcenter55 without files: what is left of `thermfit study` when reading is done.
#include <benchmark/benchmark.h>

#include "support/thermal_rows.hpp"
#include "thermfit/fit/fit.hpp"
#include "thermfit/robustness/cross_batch.hpp"
#include "thermfit/robustness/leave_one_batch_out.hpp"
#include "thermfit/select/correlation.hpp"
#include "thermfit/select/fcgr.hpp"

using namespace thermfit;

namespace {

/// Twelve batches of 79 rows and ten points, as in the paper.
Campaign campaign() {
  Campaign batches;
  for (unsigned b = 0; b < 12; ++b) {
    const ThermalRows rows(79, 10, 1, b);
    Batch batch;
    batch.temperatures.values = rows.temperatures;
    batch.errors.values = rows.errors;
    batches.push_back(batch);
  }
  return batches;
}

/// Moments of twelve batches, the sweep over ten numbers of points with PLS, and MLR on two FCGR points.
void study(benchmark::State& state) {
  const Campaign batches = campaign();
  FitOptions options;
  options.components = ComponentRule::fixed(1);
  for (auto _ : state) {
    const std::vector<Observations<>> seen = observe(batches);
    auto steps = sweep_points(seen, ByCorrelation{}, [&](const Moments<>& m) { return fit_pls(m, options); });
    auto baseline = cross_batch(seen, ByFcgr{}, 2, [](const Moments<>& m) { return fit_mlr(m); });
    benchmark::DoNotOptimize(&steps);
    benchmark::DoNotOptimize(&baseline);
  }
}
BENCHMARK(study)->Unit(benchmark::kMillisecond);

void leave_one_batch_out_ten_components(benchmark::State& state) {
  const std::vector<Moments<>> batches = moments_of(observe(campaign()));
  for (auto _ : state) {
    auto error = left_out_error(batches, [](const Moments<>& m) { return pls_path(m); });
    benchmark::DoNotOptimize(&error);
  }
}
BENCHMARK(leave_one_batch_out_ten_components)->Unit(benchmark::kMillisecond);

}  // namespace
