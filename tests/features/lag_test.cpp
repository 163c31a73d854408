#include "thermfit/features/lag.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "thermfit/features/feature.hpp"

using namespace thermfit;

TEST_CASE("a lag follows a step as an exponential does, however unevenly it is sampled", "[features]") {
  VectorX<long double> time_s(8);
  time_s << 0, 1, 7, 7.5L, 60, 61, 600, 4000;
  MatrixX<long double> step = MatrixX<long double>::Ones(8, 1);
  step(0, 0) = 0;
  const MatrixX<long double> x = lagged(step, time_s, 300.L);
  for (Index row = 0; row < 8; ++row) CHECK(std::abs(x(row, 0) - (1 - std::exp(-time_s(row) / 300))) < 1e-17L);
}

TEST_CASE("an input that is held may be sampled once or often", "[features]") {
  const double tau_s = 1200;
  Lag<> once, often;
  for (const double input : {3., -1., 4.}) {
    once.step(input, 600, tau_s);
    for (int part = 0; part < 100; ++part) often.step(input, 6, tau_s);
    CHECK(often.state == Approx(once.state).epsilon(1e-12));
  }
}

TEST_CASE("a lag's step and the lag of a series are the same numbers", "[features]") {
  const Matrix inputs = (Matrix(5, 2) << 0, 0, .5, 2, 1.5, -1, 4, 0, 4, 8).finished();
  const Vector time_s = (Vector(5) << 0, 60, 90, 400, 401).finished();
  const Matrix x = lagged(inputs, time_s, 150.);
  Lag<> lags[2];
  for (Index row = 1; row < 5; ++row)
    for (Index c = 0; c < 2; ++c) CHECK(lags[c].step(inputs(row, c), time_s(row) - time_s(row - 1), 150.) == x(row, c));
}

TEST_CASE("time that stands still moves no lag, and a lag of no rows has none", "[features]") {
  Lag<> lag{2.5};
  CHECK(lag.step(7, 0, 60) == 2.5);
  CHECK(lagged(Matrix(0, 3), Vector(0), 60.).rows() == 0);
}

TEST_CASE("a derived channel is called by what it is made of", "[features]") {
  const std::vector<std::string> points{"T1", "Spindle Front"};
  CHECK(name(Feature{FeatureKind::rise, 1}, points) == "Spindle Front");
  CHECK(name(Feature{FeatureKind::lag, 0, -1, 20}, points) == "T1 lag 20 min");
  CHECK(name(Feature{FeatureKind::lag, 0, -1, 2.5}, points) == "T1 lag 2.5 min");
  CHECK(name(Feature{FeatureKind::climate, 1}, points) == "Spindle Front x climate");
  CHECK(name(Feature{FeatureKind::difference, 0, 1}, points) == "T1 - Spindle Front");
}
