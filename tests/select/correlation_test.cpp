#include "thermfit/select/correlation.hpp"

#include "support/catch.hpp"
#include "support/thermal_rows.hpp"
#include "thermfit/select/rule.hpp"

using namespace thermfit;

namespace {

Observations<> observed(Matrix temperatures, Matrix errors) {
  Observations<> result{"K1", temperatures, errors, Moments(temperatures, errors)};
  return result;
}

}  // namespace

TEST_CASE("correlations equal their definition and keep their sign", "[select]") {
  const ThermalRows data(50, 4, 2, 1, 2);
  Matrix t = data.temperatures;
  t.col(2) *= -3;
  const Matrix r = correlations(Moments(t, data.errors));
  for (Index p = 0; p < 4; ++p) {
    for (Index e = 0; e < 2; ++e) {
      const Vector x = t.col(p).array() - t.col(p).mean();
      const Vector y = data.errors.col(e).array() - data.errors.col(e).mean();
      CHECK(r(p, e) == Approx(x.dot(y) / (x.norm() * y.norm())));
    }
  }
  CHECK(r(2, 0) < 0);
}

TEST_CASE("a correlation is never beyond one, whatever the size of the values", "[select]") {
  Matrix t(3, 2), e(3, 1);
  t << 1e-150, 1e150, 2e-150, 2e150, 3e-150, 3e150;
  e << 1, 2, 3;
  const Matrix r = correlations(Moments(t.col(1), e));
  CHECK(std::abs(r(0, 0)) <= 1);
  CHECK(r(0, 0) == Approx(1));
}

TEST_CASE("points rank by the size of correlation, equal ones in column order, constant ones last", "[select]") {
  Matrix t(4, 6), e(4, 1);
  e << 1, 2, 3, 4;
  t.col(0).setConstant(20.3);
  t.col(1) << 1, 2, 3, 5;
  t.col(2) << -1, -2, -3, -4;  // strongest, negative
  t.col(3) = t.col(1);         // equal to column 1
  t.col(4).setConstant(7);
  t.col(5) << 1, -1, 1, -1;
  const std::vector<RankedPoint<>> ranking = correlation_ranking(Moments(t, e));
  std::vector<Index> order;
  for (const RankedPoint<>& point : ranking) order.push_back(point.point);
  CHECK(order == std::vector<Index>{2, 1, 3, 5, 0, 4});
  CHECK(ranking[0].score == Approx(1));
  CHECK_FALSE(ranking[3].constant);
  CHECK(ranking[4].constant);
  CHECK(ranking[5].constant);
  CHECK(ranking[4].score == 0);
}

TEST_CASE("with several errors a ranking looks at one of them, or at all", "[select]") {
  Matrix t(4, 2), e(4, 2);
  t << 1, 1, 2, -1, 3, 1, 4, -1;
  e << 1, 1, 2, -1, 3, 1.5, 4, -1;
  const Moments moments(t, e);
  CHECK(correlation_ranking(moments, 0).front().point == 0);
  CHECK(correlation_ranking(moments, 1).front().point == 1);
  const Matrix r = correlations(moments);
  CHECK(correlation_ranking(moments).front().score ==
        Approx(std::sqrt(r.row(correlation_ranking(moments).front().point).squaredNorm() / 2)));
  CHECK_THROWS_AS(correlation_ranking(moments, 2), Error);
}

TEST_CASE("the ranking of a batch of one row, or of a constant error, is the column order", "[select]") {
  const ThermalRows data(10, 3, 1, 2);
  for (const Moments<>& m : {Moments(data.temperatures.topRows(1), data.errors.topRows(1)),
                             Moments(data.temperatures, Matrix::Constant(10, 1, 3.3))}) {
    const auto ranking = correlation_ranking(m);
    for (Index i = 0; i < 3; ++i) CHECK(ranking[static_cast<std::size_t>(i)].point == i);
  }
}

TEST_CASE("there is no correlation of a constant channel, nor of two rows, which always agree", "[select]") {
  const ThermalRows data(10, 3, 1, 2);
  Matrix t = data.temperatures;
  t.col(1).setConstant(20);
  const Matrix r = correlations(Moments(t, data.errors));
  CHECK(std::isnan(r(1, 0)));
  CHECK(std::abs(r(0, 0)) <= 1);
  for (const Index rows : {1, 2}) {
    const Moments<> few(data.temperatures.topRows(rows), data.errors.topRows(rows));
    CHECK(correlations(few).array().isNaN().all());
    CHECK(correlation_ranking(few).front().score == 0);
  }
}

TEST_CASE("anything that names points is a rule, and what it names is checked", "[select]") {
  const ThermalRows data(20, 3, 1, 3);
  const Observations<> batch = observed(data.temperatures, data.errors);
  static_assert(is_selection_rule<ByCorrelation>, "");
  static_assert(!is_selection_rule<int>, "");
  const auto last_ones = [](const Observations<>& b, Index count) {
    std::vector<Index> points;
    for (Index p = b.moments.temperatures(); p-- > 0 && count-- > 0;) points.push_back(p);
    return points;
  };
  CHECK(select_points(last_ones, batch, 2) == std::vector<Index>{2, 1});
  CHECK(select_points(ByCorrelation{}, batch, 99).size() == 3);
  CHECK_THROWS_AS(select_points([](const Observations<>&, Index) { return std::vector<Index>{3}; }, batch, 1), Error);
  CHECK_THROWS_AS(select_points(
                      [](const Observations<>&, Index) {
                        return std::vector<Index>{1, 1};
                      },
                      batch, 2),
                  Error);
}
