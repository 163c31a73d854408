#include "thermfit/diagnosis/where/periods.hpp"

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("cosine coefficients keep the sum of squares", "[gap]") {
  Vector series(9);
  series << 1, -2, 4, .5, 0, 3, 3, -1, 7;
  CHECK(cosine_coefficients(series).squaredNorm() == Approx(series.squaredNorm()));
}

TEST_CASE("a sine of one hour lies in the band from 30 to 100 min, an offset at infinity", "[gap]") {
  const Vector time_s = Vector::LinSpaced(481, 0, 8 * 3600.);
  const Vector sine = (time_s.array() * 2 * 3.141592653589793 / 3600).sin();
  const auto shares = period_shares({time_s, time_s}, {sine, Vector::Constant(481, std::sqrt(.5))});
  double hour = 0, offset = 0;
  for (const PeriodShare& share : shares) {
    if (share.period_min.low == 30) hour = share.share;
    if (std::isinf(share.period_min.low)) offset = share.share;
  }
  CHECK(hour == Approx(.5).margin(.05));
  CHECK(offset == Approx(.5).margin(.01));
}
