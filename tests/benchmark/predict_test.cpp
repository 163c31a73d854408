/// What one prediction costs, next to the bare dot product it is made of, in the same run.

#include <algorithm>
#include <chrono>
#include <iostream>
#include <random>

#include "support/catch.hpp"
#include "thermfit/controller/compensator.hpp"
#include "thermfit/model/linear_model.hpp"
#include "thermfit/number.hpp"

using namespace thermfit;

namespace {

constexpr int sensors = 10, samples = 1024;

/// Nanoseconds of `work(sample)`, the best of many passes over the samples: the least disturbed one.
template <class Work>
double nanoseconds(Work work) {
  using Clock = std::chrono::steady_clock;
  double best = 1e9;
  for (int pass = 0; pass < 400; ++pass) {
    const auto start = Clock::now();
    for (std::size_t n = 0; n < samples; ++n) {
      double result = work(n);
      asm volatile("" : "+x"(result) : : "memory");  // neither kept across samples nor left out
    }
    best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - start).count() / samples);
  }
  return best;
}

void print(const char* what, double time_ns, double bare_ns) {
  std::cout << what << fixed_text(time_ns, 2) << " ns, " << fixed_text(time_ns / bare_ns, 2) << " of the bare one\n";
}

}  // namespace

TEST_CASE("one prediction from ten sensors costs at most half more than the bare dot product", "[benchmark]") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> degrees(20, 20.5);
  std::vector<std::array<double, sensors>> readings(samples);
  std::vector<Eigen::Matrix<double, sensors, 1>> vectors(samples);
  for (std::size_t n = 0; n < samples; ++n)
    for (std::size_t i = 0; i < sensors; ++i) vectors[n](static_cast<Index>(i)) = readings[n][i] = degrees(random);

  using Device = Compensator<double, sensors, 1, 2>;
  Device::Model model;
  Device::Settings settings;
  LinearModel<double, sensors, 1> linear;
  linear.intercept(0) = model.equation.intercept_um[0] = 3;
  for (std::size_t i = 0; i < sensors; ++i) {
    linear.coefficients(static_cast<Index>(i), 0) = model.equation.coefficients[0][i] =
        .1 * static_cast<double>(i) - .4;
    model.domain.inverse_scale[i] = 1;
    model.domain.rotations[i % 2][i] = model.domain.loadings[i % 2][i] = .4;
    settings.sensors[i] = {0, 60, 1, 100};
  }
  model.domain.inverse_score_variance = {1, 1};
  model.domain.t2_limit = model.domain.spe_limit = 1e6;
  settings.outputs[0] = {100, 1};
  Device device(model, settings);
  REQUIRE(device.start());

  const auto& coefficients = model.equation.coefficients[0];
  const double bare_ns = nanoseconds([&](std::size_t n) {
    double sum = 0;
    for (std::size_t i = 0; i < sensors; ++i) sum += coefficients[i] * readings[n][i];
    return sum;
  });
  const double eigen_ns = nanoseconds([&](std::size_t n) { return linear.coefficients.col(0).dot(vectors[n]); });
  const double equation_ns = nanoseconds([&](std::size_t n) { return model.equation.predict(0, readings[n]); });
  const double linear_ns = nanoseconds([&](std::size_t n) { return linear.predict(vectors[n])(0); });
  const double step_ns = nanoseconds([&](std::size_t n) {
    device.step(readings[n]);
    return device.offset_um()[0];
  });
  CHECK(device.state() == CompensatorState::tracking);

  std::cout << "bare dot product, 10 sensors: loop " << fixed_text(bare_ns, 2) << " ns, Eigen "
            << fixed_text(eigen_ns, 2) << " ns\n";
  print("prediction on the controller (loop):  ", equation_ns, bare_ns);
  print("prediction of LinearModel (Eigen):    ", linear_ns, eigen_ns);
  print("guarded step (sensors, domain, slew): ", step_ns, bare_ns);
  CHECK(equation_ns <= 1.5 * bare_ns);
  CHECK(linear_ns <= 1.5 * eigen_ns);
}
