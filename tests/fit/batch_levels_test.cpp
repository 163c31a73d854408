#include "thermfit/fit/batch_levels.hpp"

#include <random>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

/// Batches of two points and an error that follows them, at a level of its own each.
std::vector<Moments<>> batches(const std::vector<double>& levels_um, double noise, Index rows = 60) {
  std::mt19937_64 generator(8);
  std::normal_distribution<double> normal;
  std::vector<Moments<>> all;
  for (std::size_t b = 0; b < levels_um.size(); ++b) {
    Matrix temperatures(rows, 2), errors(rows, 1);
    for (Index r = 0; r < rows; ++r) {
      temperatures(r, 0) = 9 * (1 - std::exp(-static_cast<double>(r) / 20));
      temperatures(r, 1) = 2 * std::sin(static_cast<double>(r) / 11 + static_cast<double>(b));
      errors(r, 0) = levels_um[b] + 4 * temperatures(r, 0) - temperatures(r, 1) + noise * normal(generator);
    }
    all.emplace_back(temperatures, errors);
  }
  return all;
}

}  // namespace

TEST_CASE("levels of batches that temperatures do not tell are most of the error", "[fit]") {
  const BatchLevels<> levels = batch_levels(batches({0, 450, -1200}, .5));
  CHECK(levels.share(0) > .99);
  CHECK(std::sqrt(levels.own(0)) == Approx(.5).epsilon(.1));
  CHECK(std::sqrt(levels.common(0)) > 600);
}

TEST_CASE("batches at one level share it", "[fit]") {
  const BatchLevels<> levels = batch_levels(batches({0, 0, 0, 0}, .5));
  CHECK(std::abs(levels.share(0)) < .01);
  CHECK(levels.own(0) == Approx(levels.common(0)).epsilon(.05));
}

TEST_CASE("levels that a temperature tells are the temperature's", "[fit]") {
  std::vector<Moments<>> told;
  for (const double level : {0., 20., -35., 50.}) {
    const Vector ramp = Vector::LinSpaced(30, 0, 5), swing = ramp.array().sin();
    Matrix temperatures(30, 2), errors(30, 1);
    temperatures << (ramp.array() + level).matrix(), swing;
    errors = 3 * temperatures.col(0) + swing.array().square().matrix();
    told.emplace_back(temperatures, errors);
  }
  CHECK(batch_levels(told).share(0) < .01);
}

TEST_CASE("dependent temperatures and few rows are no obstacle, and claim nothing", "[fit]") {
  Matrix temperatures(6, 3), errors(6, 1);
  temperatures << 0, 0, 1, 1, 1, 1, 2, 2, 1, 3, 3, 1, 4, 4, 1, 5, 5, 1;
  errors << 0, 2, 3, 7, 8, 9;
  const Moments<> one(temperatures, errors);
  const BatchLevels<> levels = batch_levels<double>({one, one});
  CHECK(levels.share(0) < .5);
  const Moments<> short_one(Matrix(temperatures.topRows(2)), Matrix(errors.topRows(2)));
  CHECK(std::isnan(
      batch_levels<double>({short_one, Moments<>(Matrix(temperatures.topRows(1)), Matrix(errors.topRows(1)))})
          .share(0)));
}
