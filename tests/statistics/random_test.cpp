#include "thermfit/statistics/random.hpp"

#include <cmath>

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("a stream of uniform numbers fills -1 to 1 evenly and is the same on every machine") {
  std::uint64_t state = 0;
  const std::uint64_t published = 0xe220a8397b1dcdaf;  // first number of splitmix64 from 0
  CHECK(std::abs(symmetric_uniform(state) - (static_cast<double>(published >> 11) * 0x1p-52 - 1)) < 1e-9);
  double sum = 0, squares = 0;
  for (int k = 0; k < 100000; ++k) {
    const double number = symmetric_uniform(state);
    REQUIRE(std::abs(number) <= 1);
    sum += number;
    squares += number * number;
  }
  CHECK(std::abs(sum / 100000) < 0.01);
  CHECK(squares / 100000 == Approx(1. / 3).epsilon(0.01));
}
