#include "thermfit/select/fcgr.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <random>

#include "support/catch.hpp"
#include "support/thermal_rows.hpp"
#include "thermfit/select/rule.hpp"

using namespace thermfit;

namespace {

/// Two groups of points on independent sources, and a dead one in column 2.
Observations<> two_groups() {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Matrix t(60, 6), e(60, 1);
  for (Index r = 0; r < 60; ++r) {
    const double a = normal(generator), b = normal(generator);
    t.row(r) << a + .1 * normal(generator), b + .1 * normal(generator), 21, a + .3 * normal(generator),
        b + .3 * normal(generator), a + .02 * normal(generator);
    e(r, 0) = a + b;
  }
  return {"K1", t, e, Moments(t, e)};
}

}  // namespace

TEST_CASE("fuzzy classes follow the sources and leave a dead point out", "[select]") {
  const Moments moments = two_groups().moments;
  CHECK(fuzzy_classes(moments, 1) == PointClasses{{0, 1, 3, 4, 5}});
  CHECK(fuzzy_classes(moments, 2) == PointClasses{{0, 3, 5}, {1, 4}});
  CHECK(fuzzy_classes(moments, 5).size() == 5);
  CHECK(fuzzy_classes(moments, 9).size() == 5);  // there are no more
}

TEST_CASE("the closure joins points through a chain of similar ones", "[select]") {
  // 0–1 and 1–2 correlate at .9, 0–2 less: the weakest link of the chain decides, so they part together or not at all.
  Matrix t(200, 4), e = Matrix::Zero(200, 1);
  const ThermalRows noise(200, 4, 1, 2, 10);
  const Matrix centred = noise.temperatures.rowwise() - noise.temperatures.colwise().mean();
  Matrix r(4, 4);
  r << 1, .9, .7, .3, .9, 1, .9, .3, .7, .9, 1, .3, .3, .3, .3, 1;
  const Matrix root = r.llt().matrixL();
  Eigen::HouseholderQR<Matrix> qr(centred);
  t = Matrix(qr.householderQ() * Matrix::Identity(200, 4)) * root.transpose();
  CHECK(fuzzy_classes(Moments(t, e), 2) == PointClasses{{0, 1, 2}, {3}});
}

TEST_CASE("duplicates never part by rounding", "[select]") {
  const ThermalRows data(40, 2, 1, 3, 1);
  Matrix t(40, 4);
  t << data.temperatures, data.temperatures;
  CHECK(fuzzy_classes(Moments(t, data.errors), 2) == PointClasses{{0, 2}, {1, 3}});
}

TEST_CASE("grey relational grades equal a hand calculation", "[select]") {
  Matrix t(3, 2), e(3, 1);
  e << 0, 5, 10;        // centred and scaled: -.5 0 .5
  t.col(0) << 0, 1, 2;  // -.5 0 .5: no difference at all
  t.col(1) << 2, 1, 0;  // .5 0 -.5: differences 1 0 1
  const Vector grades = grey_relational_grades(t, e);
  CHECK(grades(0) == Approx(1));
  CHECK(grades(1) == Approx((.5 / 1.5 + 1 + .5 / 1.5) / 3));
  CHECK(grey_relational_grades(t, e, 0, .1)(1) == Approx((.1 / 1.1 + 1 + .1 / 1.1) / 3));
}

TEST_CASE("FCGR takes the best point of each class and needs the rows", "[select]") {
  Observations<> batch = two_groups();
  const Vector grades = grey_relational_grades(batch.temperatures, batch.errors);
  const std::vector<Index> points = select_points(ByFcgr{}, batch, 2);
  REQUIRE(points.size() == 2);
  for (const Index other : {0, 3, 5}) CHECK(grades(points[0]) >= grades(other));
  for (const Index other : {1, 4}) CHECK(grades(points[1]) >= grades(other));
  batch.temperatures.resize(0, 0);
  CHECK_THROWS_AS(select_points(ByFcgr{}, batch, 2), Error);
}
