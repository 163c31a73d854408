#include "thermfit/statistics/residual_noise.hpp"

#include <Eigen/Cholesky>
#include <random>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

Matrix covariance(const ResidualNoise& noise, const Vector& time_s) {
  Matrix result(time_s.size(), time_s.size());
  for (Index i = 0; i < time_s.size(); ++i)
    for (Index j = 0; j < time_s.size(); ++j)
      result(i, j) = noise.slow * noise.slow * std::exp(-std::abs(time_s(i) - time_s(j)) / noise.memory_s) +
                     (i == j ? noise.white * noise.white : 0);
  return result;
}

Vector uneven_clock(Index samples) {
  Vector time(samples);
  for (Index k = 0; k < samples; ++k) time(k) = 60.0 * static_cast<double>(k) + (k % 3 == 0 ? 17.0 : 0.0);
  return time;
}

SeriesByBatch drawn(const ResidualNoise& noise, const std::vector<Vector>& clocks, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  SeriesByBatch result;
  for (const Vector& clock : clocks) {
    Vector z(clock.size());
    for (Index k = 0; k < z.size(); ++k) z(k) = normal(random);
    const Matrix lower = covariance(noise, clock).llt().matrixL();
    result.push_back(lower * z);
  }
  return result;
}

}  // namespace

TEST_CASE("whitening equals the inverse Cholesky factor of the dense covariance, also with uneven sampling") {
  const ResidualNoise noise{0.3, 1.1, 400};
  const Vector time = uneven_clock(40);
  Matrix series = Matrix::Random(40, 3), expected = series;
  const Eigen::LLT<Matrix> dense(covariance(noise, time));
  dense.matrixL().solveInPlace(expected);
  const Whitener whitener(noise, time);
  whitener.apply(series);
  CHECK((series - expected).cwiseAbs().maxCoeff() < 1e-10);
  const double log_determinant = 2 * Matrix(dense.matrixL()).diagonal().array().log().sum();
  CHECK(whitener.log_determinant() == Approx(log_determinant).epsilon(1e-12));
  CHECK(whitener.count() == 40);
}

TEST_CASE("missing samples count as if they had not been recorded") {
  const ResidualNoise noise{0.3, 1.1, 400};
  const Vector time = uneven_clock(40);
  Vector r = Vector::Random(40);
  std::vector<char> present(40, 1);
  std::vector<Index> kept;
  for (Index k = 0; k < 40; ++k)
    if (k == 0 || k == 7 || k == 8 || k == 39)
      present[static_cast<std::size_t>(k)] = 0, r(k) = std::nan("");
    else
      kept.push_back(k);
  const Matrix all = covariance(noise, time);
  Matrix dense(kept.size(), kept.size());
  Vector seen(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    seen(static_cast<Index>(i)) = r(kept[i]);
    for (std::size_t j = 0; j < kept.size(); ++j)
      dense(static_cast<Index>(i), static_cast<Index>(j)) = all(kept[i], kept[j]);
  }
  const Eigen::LLT<Matrix> factor(dense);
  const double expected =
      -0.5 * (seen.dot(factor.solve(seen)) + 2 * Matrix(factor.matrixL()).diagonal().array().log().sum());
  CHECK(log_likelihood(noise, {r}, {time}) == Approx(expected).epsilon(1e-10));
  Matrix white = r;
  const Whitener whitener(noise, time, present);
  whitener.apply(white);
  CHECK(white.squaredNorm() == Approx(seen.dot(factor.solve(seen))).epsilon(1e-10));
  CHECK(whitener.count() == 36);
}

TEST_CASE("the noise that made a series is estimated from it, and bounds hold") {
  const ResidualNoise truth{0.2, 0.6, 3600};
  const std::vector<Vector> clocks(9, Vector::LinSpaced(121, 0, 21600));
  const SeriesByBatch residual = drawn(truth, clocks, 3);
  const NoiseBounds open{0, 0, 360, 40000};
  const ResidualNoise found = estimate_noise(residual, clocks, open);
  CHECK(found.white == Approx(truth.white).epsilon(0.1));
  CHECK(found.slow == Approx(truth.slow).epsilon(0.3));
  CHECK(found.memory_s == Approx(truth.memory_s).epsilon(0.6));
  CHECK(log_likelihood(found, residual, clocks) > log_likelihood(truth, residual, clocks));
  const ResidualNoise again = estimate_noise(residual, clocks, open, &truth);
  CHECK(log_likelihood(again, residual, clocks) == Approx(log_likelihood(found, residual, clocks)).margin(1));
  const ResidualNoise bounded = estimate_noise(residual, clocks, {0.5, 2, 360, 40000});
  CHECK(bounded.white >= 0.5 * (1 - 1e-12));
  CHECK(bounded.slow >= 2 * (1 - 1e-12));
}

TEST_CASE("an exactly zero residual has the least noise allowed and a finite likelihood") {
  const std::vector<Vector> clocks(2, Vector::LinSpaced(30, 0, 300));
  const SeriesByBatch residual(2, Vector::Zero(30));
  const ResidualNoise found = estimate_noise(residual, clocks, {0.01, 0, 20, 300});
  CHECK(found.white == Approx(0.01));
  CHECK(std::isfinite(log_likelihood(found, residual, clocks)));
}
