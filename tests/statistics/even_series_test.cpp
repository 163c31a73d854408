#include "thermfit/statistics/even_series.hpp"

#include "support/catch.hpp"

using thermfit::interval_means;
using thermfit::Vector;

TEST_CASE("means over equal intervals integrate a broken line exactly, whatever the sampling", "[gap]") {
  Vector time_s(4), values(4);
  time_s << 0, 1, 4, 10;
  values << 0, 2, 2, 8;
  const Vector means = interval_means(time_s, values, 2);  // [0,5]: 1 + 6 + (2+3)/2; [5,10]: (3+8)/2*5
  CHECK(means(0) == Approx((1 + 6 + 2.5) / 5));
  CHECK(means(1) == Approx(27.5 / 5));
  CHECK(interval_means(time_s, values, 1)(0) == Approx((1 + 6 + 30) / 10.));
}

TEST_CASE("a straight line keeps its value at the middle of every interval", "[gap]") {
  const Vector time_s = Vector::LinSpaced(121, 0, 21600);
  const Vector means = interval_means(time_s, 3 + 2e-3 * time_s.array(), 7);
  for (int k = 0; k < 7; ++k) CHECK(means(k) == Approx(3 + 2e-3 * 21600 * (k + .5) / 7));
}
