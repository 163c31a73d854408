#include "thermfit/network/room_shape.hpp"

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("the shapes of a room are a level, a drift of 2 K, and what neither of them can be") {
  for (const double share : {0., .25, 1.}) {
    CHECK(room_shape(0, share) == 1);
    CHECK(room_shape(1, share) == Approx(2 * share - 1));
    const double x = 2 * share - 1;
    CHECK(room_shape(3, share) == Approx((5 * x * x * x - 3 * x) / 2));
  }
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < a; ++b) {
      double sum = 0;
      for (int k = 0; k < 10000; ++k) sum += room_shape(a, (k + .5) / 10000) * room_shape(b, (k + .5) / 10000) / 10000;
      CHECK(sum == Approx(0).margin(1e-6));
    }
}
