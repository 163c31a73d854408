#include "thermfit/findings/leave_out_residuals.hpp"

#include <Eigen/QR>
#include <random>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

Matrix centred(Matrix values) {
  values.rowwise() -= values.colwise().mean().eval();
  return values;
}

CentredProducts<> products(const Matrix& values) {
  return {values.transpose() * values, static_cast<double>(values.rows())};
}

/// Log rms residual of column `own` of `batch` by least squares of `training` on the columns `others`.
double direct(const Matrix& batch, const Matrix& training, Index own, const std::vector<Index>& others) {
  const auto count = static_cast<Index>(others.size());
  Matrix x(training.rows(), count), y(batch.rows(), count);
  for (Index i = 0; i < count; ++i) {
    x.col(i) = training.col(others[static_cast<std::size_t>(i)]);
    y.col(i) = batch.col(others[static_cast<std::size_t>(i)]);
  }
  const Vector weights = x.householderQr().solve(training.col(own));
  return std::log((batch.col(own) - y * weights).norm() / std::sqrt(static_cast<double>(batch.rows())));
}

}  // namespace

TEST_CASE("one inverse gives the residual of every channel, and of every channel without another", "[findings]") {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const auto draw = [&](Index rows) {
    Matrix values(rows, 5);
    for (Index row = 0; row < rows; ++row) {
      const double heat = normal(random);
      for (Index c = 0; c < 5; ++c) values(row, c) = double(c + 1) * heat + 0.3 * normal(random);
    }
    return centred(values);
  };
  const Matrix training = draw(80), batch = draw(40);
  const std::vector<Index> kept{0, 1, 3, 4};
  const auto result = leave_out_residuals<double>(products(batch), products(training), kept, Vector::Zero(5), 0.);
  for (Index i = 0; i < 4; ++i) {
    std::vector<Index> others;
    for (const Index c : kept)
      if (c != kept[std::size_t(i)]) others.push_back(c);
    CHECK(result.log_sd(i) == Approx(direct(batch, training, kept[std::size_t(i)], others)).margin(1e-9));
    Vector residual = Vector::Zero(batch.rows());
    for (Index j = 0; j < 4; ++j) residual += result.weights(j, i) * batch.col(kept[std::size_t(j)]);
    CHECK(std::log(residual.norm() / std::sqrt(40.)) == Approx(result.log_sd(i)).margin(1e-9));
    for (Index left = 0; left < 4; ++left) {
      if (left == i) {
        CHECK(std::isnan(result.log_sd_without(left, i)));
        continue;
      }
      std::vector<Index> fewer;
      for (const Index c : others)
        if (c != kept[std::size_t(left)]) fewer.push_back(c);
      CHECK(result.log_sd_without(left, i) ==
            Approx(direct(batch, training, kept[std::size_t(i)], fewer)).margin(1e-9));
    }
  }
}
