#include "thermfit/statistics/rms.hpp"

#include <limits>

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("the rms of several series weighs every sample that is there alike") {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  CHECK(rms_of(Vector{{3., -4., 0., 0.}}) == 2.5);
  CHECK(rms_of(std::vector<Vector>{Vector{{3., missing, -4.}}, Vector{{0., 0., missing}}}) == 2.5);
}

TEST_CASE("the rms of nothing is 0") {
  CHECK(rms_of(Vector(0)) == 0);
  CHECK(rms_of(std::vector<Vector>{Vector{{std::numeric_limits<double>::quiet_NaN()}}}) == 0);
}
