#include "thermfit/statistics/held_levels.hpp"

#include <cmath>
#include <utility>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

bool is_set(const Vector& course) {
  HeldLevels levels;
  count_held(levels, course);
  return thermfit::is_set(std::move(levels));
}

}  // namespace

TEST_CASE("a speed in steps is set, and so is a switch, however often it is thrown") {
  const Vector time = Vector::LinSpaced(400, 0, 399);
  CHECK(is_set((time / 40).array().floor() * 1000));
  CHECK(is_set(Vector::Zero(400)));
  CHECK(is_set(time.unaryExpr([](double t) { return std::fmod(t, 2); })));
  CHECK(is_set((time / 20).array().floor().unaryExpr([](double block) { return std::fmod(block * 7919, 6000); })));
  CHECK(is_set(Vector()));
}

TEST_CASE("a temperature is measured, also where its reading has coarse steps") {
  const Vector time = Vector::LinSpaced(4000, 0, 3999), degC = 20 + 15 * (time / 700).array().sin();
  CHECK_FALSE(is_set(degC));
  CHECK_FALSE(is_set((degC * 2).array().round() / 2));
}
