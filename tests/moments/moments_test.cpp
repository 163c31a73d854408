#include "thermfit/moments/moments.hpp"

#include <chrono>
#include <limits>
#include <random>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

struct Rows {
  Matrix temperatures, errors;
};

/// Warm temperatures far from zero, so that forgetting to centre would show.
Rows random_rows(Index rows, Index points, Index responses, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Rows data{Matrix(rows, points), Matrix(rows, responses)};
  for (Index r = 0; r < rows; ++r) {
    const double warmth = normal(generator);
    for (Index c = 0; c < points; ++c) data.temperatures(r, c) = 290 + 5 * warmth + normal(generator);
    for (Index c = 0; c < responses; ++c) data.errors(r, c) = -40 + 9 * warmth + normal(generator);
  }
  return data;
}

/// Relative to the diagonal, as a correlation would see it.
double difference(const Moments<>& a, const Moments<>& b) {
  REQUIRE(a.rows() == b.rows());
  const Vector x = a.temperature_products().diagonal().cwiseSqrt();
  const Vector y = a.error_products().diagonal().cwiseSqrt();
  const auto relative = [](const Matrix& u, const Matrix& v, const Vector& left, const Vector& right) {
    return (left.cwiseInverse().asDiagonal() * (u - v) * right.cwiseInverse().asDiagonal()).cwiseAbs().maxCoeff();
  };
  return std::max(
      {relative(a.temperature_products(), b.temperature_products(), x, x),
       relative(a.cross_products(), b.cross_products(), x, y), relative(a.error_products(), b.error_products(), y, y),
       ((a.temperature_mean() - b.temperature_mean()).array() / a.temperature_mean().array()).abs().maxCoeff(),
       ((a.error_mean() - b.error_mean()).array() / a.error_mean().array()).abs().maxCoeff()});
}

}  // namespace

TEST_CASE("moments equal the two-pass sums in long double", "[moments]") {
  const Rows data = random_rows(1000, 4, 2, 1);
  const Moments moments(data.temperatures, data.errors);
  using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  Wide all(1000, 6);
  all << data.temperatures.cast<long double>(), data.errors.cast<long double>();
  const Eigen::Matrix<long double, 1, Eigen::Dynamic> mean = all.colwise().mean();
  all.rowwise() -= mean;
  const Matrix products = (all.transpose() * all).cast<double>();
  CHECK(moments.rows() == 1000);
  CHECK((moments.temperature_products() - products.topLeftCorner(4, 4)).cwiseAbs().maxCoeff() <
        1e-13 * products.maxCoeff());
  CHECK((moments.cross_products() - products.topRightCorner(4, 2)).cwiseAbs().maxCoeff() < 1e-13 * products.maxCoeff());
  CHECK((moments.error_products() - products.bottomRightCorner(2, 2)).cwiseAbs().maxCoeff() <
        1e-13 * products.maxCoeff());
  CHECK((moments.temperature_mean() - mean.head(4).transpose().cast<double>()).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(moments.temperature_lowest()(2) == data.temperatures.col(2).minCoeff());
  CHECK(moments.temperature_highest()(2) == data.temperatures.col(2).maxCoeff());
}

TEST_CASE("any split into batches, merged in any order, gives the same moments to 1e-12", "[moments]") {
  const Rows data = random_rows(5000, 5, 1, 2);
  const Moments whole(data.temperatures, data.errors);
  std::mt19937_64 generator(3);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Index> cuts{0, 5000};
    const int pieces = static_cast<int>(generator() % 60);
    for (int i = 0; i < pieces; ++i) cuts.push_back(static_cast<Index>(generator() % 5001));
    std::sort(cuts.begin(), cuts.end());
    std::vector<Moments<>> parts;
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      const Index count = cuts[i] - cuts[i - 1];
      parts.emplace_back(data.temperatures.middleRows(cuts[i - 1], count), data.errors.middleRows(cuts[i - 1], count));
    }
    std::shuffle(parts.begin(), parts.end(), generator);
    while (parts.size() > 1) {  // a random tree of merges
      const std::size_t into = generator() % (parts.size() - 1);
      parts[into].merge(parts.back());
      parts.pop_back();
    }
    REQUIRE(difference(whole, parts.front()) < 1e-12);
    REQUIRE(parts.front().temperature_lowest() == whole.temperature_lowest());
    REQUIRE(parts.front().temperature_highest() == whole.temperature_highest());
  }
}

TEST_CASE("rows one at a time give the moments of all at once", "[moments]") {
  const Rows data = random_rows(600, 3, 1, 4);
  Moments moments(3, 1);
  for (Index r = 0; r < 600; ++r) moments.add_rows(data.temperatures.row(r), data.errors.row(r));
  CHECK(difference(Moments(data.temperatures, data.errors), moments) < 1e-13);
}

TEST_CASE("leaving one batch out equals adding up the others, ranges included", "[moments]") {
  std::vector<Moments<>> batches;
  for (unsigned b = 0; b < 7; ++b) {
    const Rows data = random_rows(50 + 10 * static_cast<Index>(b), 3, 2, 10 + b);
    batches.emplace_back(data.temperatures, data.errors);
  }
  const std::vector<Moments<>> others = leave_one_out(batches);
  for (std::size_t i = 0; i < batches.size(); ++i) {
    std::vector<Moments<>> rest = batches;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    CHECK(difference(merged(rest), others[i]) < 1e-14);
    CHECK(merged(rest).temperature_lowest() == others[i].temperature_lowest());
  }
}

TEST_CASE("a subset of columns equals the moments of these columns", "[moments]") {
  const Rows data = random_rows(100, 5, 3, 5);
  const Moments subset = Moments(data.temperatures, data.errors).subset({3, 0}, {2});
  const std::vector<Index> points{3, 0};
  CHECK(difference(Moments(data.temperatures(Eigen::all, points), data.errors.col(2)), subset) < 1e-14);
  CHECK_THROWS_AS(subset.subset({2}), Error);
  CHECK_THROWS_AS(subset.subset({-1}), Error);
  CHECK_THROWS_AS(subset.subset({0}, {1}), Error);
}

TEST_CASE("taking an offset off the temperatures moves the mean and nothing else", "[moments]") {
  const Rows data = random_rows(100, 2, 1, 6);
  const Vector first = data.temperatures.row(0);
  const Moments shifted = Moments(data.temperatures, data.errors).minus(first);
  const Moments direct(data.temperatures.rowwise() - first.transpose(), data.errors);
  CHECK((shifted.temperature_products() - direct.temperature_products()).norm() <
        1e-12 * direct.temperature_products().norm());
  CHECK((shifted.temperature_mean() - direct.temperature_mean()).norm() < 1e-12);
  CHECK(shifted.temperature_lowest()(0) == Approx(direct.temperature_lowest()(0)));
}

TEST_CASE("values that are not finite are refused with their place, and nothing is added", "[moments]") {
  Rows data = random_rows(700, 3, 1, 7);
  Moments moments(data.temperatures, data.errors);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    Rows wrong = data;
    wrong.temperatures(513, 2) = bad;
    try {
      moments.add_rows(wrong.temperatures, wrong.errors);
      FAIL("accepted");
    } catch (const Error& error) {
      CHECK(error.place() == "row 513, temperature 2");
    }
    wrong = data;
    wrong.errors(0, 0) = bad;
    CHECK_THROWS_AS(moments.add_rows(wrong.temperatures, wrong.errors), Error);
  }
  CHECK(moments.rows() == 700);
  CHECK(difference(Moments(data.temperatures, data.errors), moments) == 0);
}

TEST_CASE("opposite infinities and sums that overflow are refused as well", "[moments]") {
  Matrix t(2, 1), e(2, 1);
  e << 0, 1;
  t << std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(Moments(t, e), Error);
  t << 1.7e308, 1.7e308;
  CHECK_THROWS_AS(Moments(t, e), Error);
}

TEST_CASE("different widths do not merge, empty moments merge with anything", "[moments]") {
  const Rows data = random_rows(10, 3, 1, 8);
  Moments moments(data.temperatures, data.errors);
  CHECK_THROWS_AS(moments.merge(moments.subset({0, 1})), Error);
  CHECK_THROWS_AS(moments.add_rows(data.temperatures, data.errors.topRows(4)), Error);
  CHECK_THROWS_AS(moments.add_rows(data.temperatures.leftCols(2), data.errors), Error);
  moments.merge(Moments());
  moments.merge(Moments(2, 2));
  CHECK(moments.rows() == 10);
  Moments<> empty;
  empty.merge(moments);
  CHECK(difference(moments, empty) == 0);
}

TEST_CASE("a channel is constant when it moves by no more than its rounding", "[moments]") {
  Matrix t(3, 4), e(3, 1);
  t << 20.1, 20.1, 0, 1,  //
      20.1, 20.1 + 1e-14, 0, 1 + 1e-9, 20.1, 20.1, 0, 1;
  e << 1, 2, 3;
  const Moments moments(t, e);
  CHECK(moments.constant(0));
  CHECK(moments.constant(1));
  CHECK(moments.constant(2));
  CHECK_FALSE(moments.constant(3));
  CHECK_FALSE(moments.constant(4));
}
