#include "thermfit/statistics/held_levels.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

bool is_set(const Vector& course) {
  HeldLevels levels;
  count_held(levels, course);
  return levels.is_set();
}

}  // namespace

TEST_CASE("a speed in steps is set, a temperature that wanders is not") {
  const Vector time = Vector::LinSpaced(60, 0, 59);
  CHECK(is_set((time / 15).array().floor() * 1000));
  CHECK(is_set(Vector::Zero(60)));
  CHECK_FALSE(is_set(20 + (time / 20).array().sin()));
  CHECK(HeldLevels{}.is_set());
}
