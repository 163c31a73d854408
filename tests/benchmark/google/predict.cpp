// One prediction from ten sensors next to the dot product it is made of; the aim is half more than that at most.
#include <benchmark/benchmark.h>

#include <random>

#include "thermfit/controller/compensator.hpp"
#include "thermfit/model/linear_model.hpp"

using namespace thermfit;

namespace {

constexpr std::size_t sensors = 10, samples = 1024;
using Readings = std::array<double, sensors>;
using Device = Compensator<double, sensors, 1, 2>;

std::vector<Readings> readings() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> degrees(20, 20.5);
  std::vector<Readings> all(samples);
  for (Readings& sample : all)
    for (double& degC : sample) degC = degrees(random);
  return all;
}

Device::Model model() {
  Device::Model model;
  model.equation.intercept_um[0] = 3;
  for (std::size_t i = 0; i < sensors; ++i) {
    model.equation.coefficients[0][i] = .1 * static_cast<double>(i) - .4;
    model.domain.inverse_scale[i] = 1;
    model.domain.rotations[i % 2][i] = model.domain.loadings[i % 2][i] = .4;
  }
  model.domain.inverse_score_variance = {1, 1};
  model.domain.t2_limit = model.domain.spe_limit = 1e6;
  return model;
}

/// `predict(sample)` for one sample an iteration.
template <class Sample, class Predict>
void timed(benchmark::State& state, const std::vector<Sample>& all, Predict&& predict) {
  std::size_t n = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(predict(all[n]));
    n = (n + 1) % samples;
  }
}

void bare_dot_product(benchmark::State& state) {
  const Readings coefficients = model().equation.coefficients[0];
  timed(state, readings(), [&](const Readings& sample) {
    double sum = 0;
    for (std::size_t i = 0; i < sensors; ++i) sum += coefficients[i] * sample[i];
    return sum;
  });
}

void controller_equation(benchmark::State& state) {
  const Device::Model made = model();
  timed(state, readings(), [&](const Readings& sample) { return made.equation.predict(0, sample); });
}

/// Sensors, training domain, clamp and slew limit included.
void guarded_step(benchmark::State& state) {
  Device::Settings settings;
  for (std::size_t i = 0; i < sensors; ++i) settings.sensors[i] = {0, 60, 1, 100, 1000};
  settings.patience.all_frozen_steps = 1000;
  settings.outputs[0] = {100, 1};
  settings.zero.policy = ZeroPolicy::first;
  const Device::Model made = model();
  Device device(made, settings);
  if (!device.start()) return state.SkipWithError("the compensator does not start");
  for (const Readings& sample : readings()) device.step(sample);  // takes its zero
  timed(state, readings(), [&](const Readings& sample) {
    device.step(sample);
    return device.offset_um()[0];
  });
  if (device.state() != CompensatorState::tracking) state.SkipWithError("the compensator does not track");
}

using FixedModel = LinearModel<double, static_cast<int>(sensors), 1>;
using FixedReadings = Eigen::Matrix<double, static_cast<int>(sensors), 1>;

FixedModel linear_model() {
  FixedModel linear;
  linear.intercept(0) = 3;
  for (std::size_t i = 0; i < sensors; ++i)
    linear.coefficients(static_cast<Index>(i), 0) = model().equation.coefficients[0][i];
  return linear;
}

std::vector<FixedReadings> fixed_readings() {
  std::vector<FixedReadings> all;
  for (const Readings& sample : readings()) all.emplace_back(sample.data());
  return all;
}

void bare_dot_product_eigen(benchmark::State& state) {
  const FixedModel linear = linear_model();
  timed(state, fixed_readings(), [&](const FixedReadings& sample) { return linear.coefficients.col(0).dot(sample); });
}

void linear_model_predict(benchmark::State& state) {
  const FixedModel linear = linear_model();
  timed(state, fixed_readings(), [&](const FixedReadings& sample) { return linear.predict(sample)(0); });
}

BENCHMARK(bare_dot_product);
BENCHMARK(controller_equation);
BENCHMARK(guarded_step);
BENCHMARK(bare_dot_product_eigen);
BENCHMARK(linear_model_predict);

}  // namespace
