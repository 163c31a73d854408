#pragma once

/// At which periods the gap lies: its square, split exactly by a cosine transform.

#include <cmath>
#include <limits>
#include <vector>

#include "thermfit/constants.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/statistics/even_series.hpp"

namespace thermfit {

/// Orthonormal DCT-II coefficients of `series`: their squares add up to its square. Coefficient k has the period
/// 2 duration / k; coefficient 0 is the offset. The even extension keeps a trend from leaking into short periods.
template <typename Scalar = double>
VectorX<Scalar> cosine_coefficients(const VectorX<Scalar>& series) {
  const Index count = series.size();
  VectorX<Scalar> result(count);
  for (Index k = 0; k < count; ++k) {
    double sum = 0;
    for (Index i = 0; i < count; ++i)
      sum += series(i) *
             std::cos(pi * (static_cast<double>(i) + .5) * static_cast<double>(k) / static_cast<double>(count));
    result(k) = sum * std::sqrt((k ? 2. : 1.) / static_cast<double>(count));
  }
  return result;
}

/// Shares of the square of the gap by period, longest last; an offset that lasts the whole batch has the period
/// infinity. Bands without content are left out. `times_s[b]` and `residuals[b]` belong together.
template <typename Scalar = double>
std::vector<PeriodShare> period_shares(const std::vector<Vector>& times_s, const std::vector<Vector>& residuals) {
  constexpr double forever = std::numeric_limits<double>::infinity();
  const std::vector<double> edges_min{0, 1, 3, 10, 30, 100, 300, 1000, 3000, forever};
  std::vector<double> squares(edges_min.size(), 0);
  double total = 0;
  for (std::size_t b = 0; b < residuals.size(); ++b) {
    const Index rows = residuals[b].size();
    if (rows < 2) continue;
    const double minutes = (times_s[b](rows - 1) - times_s[b](0)) / 60;
    const Index count = series_length(rows, 512);
    const VectorX<Scalar> means = interval_means(times_s[b], residuals[b], count);
    const VectorX<Scalar> coefficients = cosine_coefficients<Scalar>(means);
    const VectorX<Scalar>& residual = residuals[b];
    const double rows_per_mean = static_cast<double>(rows) / static_cast<double>(count);
    total += residual.squaredNorm();
    squares.back() += coefficients(0) * coefficients(0) * rows_per_mean;
    for (Index k = 1; k < count; ++k) {
      const double period_min = 2 * minutes / static_cast<double>(k);
      std::size_t band = 0;
      while (band + 2 < edges_min.size() && period_min >= edges_min[band + 1]) ++band;
      squares[band] += coefficients(k) * coefficients(k) * rows_per_mean;
    }
  }
  std::vector<PeriodShare> shares;
  for (std::size_t band = 0; band < squares.size(); ++band) {
    if (squares[band] <= 1e-4 * total) continue;
    const bool offset = band + 1 == squares.size();
    shares.push_back(
        {{offset ? forever : edges_min[band], offset ? forever : edges_min[band + 1]}, squares[band] / total});
  }
  return shares;
}

}  // namespace thermfit
