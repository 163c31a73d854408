#include "thermfit/statistics/whiteness.hpp"

#include <random>

#include "support/catch.hpp"

using namespace thermfit;

namespace {
/// x_k = memory x_(k-1) + normal
Vector autoregressive(int rows, double memory, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vector series(rows);
  double last = 0;
  for (int i = 0; i < rows; ++i) series(i) = last = memory * last + normal(random);
  return series;
}
}  // namespace

TEST_CASE("white noise is rejected in about one case of twenty, slow noise nearly always", "[gap]") {
  std::mt19937 random(7);
  int white = 0, slow = 0;
  for (int trial = 0; trial < 200; ++trial) {
    white += !whiteness({autoregressive(121, 0, random), autoregressive(121, 0, random)}).white;
    slow += !whiteness({autoregressive(121, .5, random), autoregressive(121, .5, random)}).white;
  }
  CHECK(white <= 20);
  CHECK(slow >= 195);
}

TEST_CASE("series without content or too short say nothing", "[gap]") {
  CHECK(whiteness({Vector::Constant(50, 3.)}).ordinates == 0);
  CHECK(whiteness({}).white);
}
