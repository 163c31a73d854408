// Fits and moments of rows in memory. Eigen's X'X on the same rows in the same run is the yardstick: the counter
// `of_XtX` is the time relative to it.
#include "thermfit/fit/fit.hpp"

#include <benchmark/benchmark.h>

#include <chrono>

#include "support/thermal_rows.hpp"

using namespace thermfit;

namespace {

const ThermalRows& rows(Index count, Index points) {
  static std::vector<std::pair<std::pair<Index, Index>, ThermalRows>> made;
  for (const auto& [size, data] : made) {
    if (size == std::pair(count, points)) return data;
  }
  made.reserve(16);
  made.push_back({{count, points}, ThermalRows(count, points, 1, 1)});
  return made.back().second;
}

/// Seconds of one product X'X over all channels, the fastest of five.
double product_time(const ThermalRows& data) {
  Matrix all(data.temperatures.rows(), data.temperatures.cols() + data.errors.cols());
  all << data.temperatures, data.errors;
  double least = 1e300;
  for (int i = 0; i < 5; ++i) {
    const auto start = std::chrono::steady_clock::now();
    Matrix product = all.transpose() * all;
    benchmark::DoNotOptimize(product.data());
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return least;
}

template <class Work>
void timed_against_product(benchmark::State& state, Work&& work) {
  const ThermalRows& data = rows(state.range(0), state.range(1));
  const double product = product_time(data);
  double least = 1e300;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    auto result = work(data);
    benchmark::DoNotOptimize(&result);
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  state.counters["of_XtX"] = least / product;
  state.counters["rows_per_s"] = benchmark::Counter(static_cast<double>(state.range(0)) / least);
}

void moments(benchmark::State& state) {
  timed_against_product(state, [](const ThermalRows& d) { return Moments(d.temperatures, d.errors); });
}

void pls_from_moments(benchmark::State& state) {
  timed_against_product(state, [](const ThermalRows& d) { return fit_pls(Moments(d.temperatures, d.errors)); });
}

void mlr_from_moments(benchmark::State& state) {
  timed_against_product(state, [](const ThermalRows& d) { return fit_mlr(Moments(d.temperatures, d.errors)); });
}

void pls_from_rows(benchmark::State& state) {
  timed_against_product(state, [](const ThermalRows& d) { return fit_pls(d.temperatures, d.errors); });
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({80, 10})->Args({1'000'000, 10})->Args({200'000, 30})->Unit(benchmark::kMicrosecond);
}

BENCHMARK(moments)->Apply(sizes);
BENCHMARK(pls_from_moments)->Apply(sizes);
BENCHMARK(mlr_from_moments)->Apply(sizes);
BENCHMARK(pls_from_rows)->Apply(sizes);

}  // namespace
