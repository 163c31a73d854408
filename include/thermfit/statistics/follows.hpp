#pragma once

/// Which recorded course a residual follows, judged against the same course from other batches.

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// A recorded course, one evenly spaced series per batch.
struct Course {
  std::string name;            ///< of the column
  std::vector<Vector> series;  ///< by batch, all of equal length
};

/// What a residual follows.
struct Follows {
  std::string course;      ///< empty: none beats chance
  double correlation = 0;  ///< signed, pooled over batches, each batch's mean removed
  double lag_share = 0;    ///< the lag at which it is largest, as a share of the batch
  double p_value = 1;      ///< share of mismatched batches that do as well; the largest of all courses and lags counts
};

namespace detail {

/// The largest correlation over lags 0 … a quarter of the series, and its lag; `order[b]` says whose course stands in
/// for batch b's own.
struct BestLag {
  double correlation = 0;
  Index lag = 0;
};

template <typename Scalar>
BestLag best_lag(const std::vector<VectorX<Scalar>>& residual, const std::vector<VectorX<Scalar>>& course,
                 const std::vector<std::size_t>& order) {
  const Index count = residual.front().size();
  BestLag best;
  for (Index lag = 0; lag <= count / 4; lag += std::max<Index>(1, count / 64)) {
    double xy = 0, xx = 0, yy = 0;
    for (std::size_t b = 0; b < residual.size(); ++b) {
      const auto y = residual[b].tail(count - lag);
      const auto x = course[order[b]].head(count - lag);
      xy += x.dot(y) - x.sum() * y.mean();
      xx += x.squaredNorm() - x.sum() * x.mean();
      yy += y.squaredNorm() - y.sum() * y.mean();
    }
    if (xx < 1e-12 || yy < 1e-12) continue;
    const double correlation = xy / std::sqrt(xx * yy);
    if (std::abs(correlation) > std::abs(best.correlation)) best = {correlation, lag};
  }
  return best;
}

}  // namespace detail

/// Which of `courses` the residual follows. All series have equal length. The null pairs each batch's residual with the
/// course of another batch, which keeps both autocorrelations and needs no count of independent samples; the maximum
/// over courses and lags is compared, so many courses are not an advantage. Under three batches nothing is claimed.
/// `seed` is of the pairings. Allocates.
template <typename Scalar = double>
Follows follows(const std::vector<Vector>& residual, const std::vector<Course>& courses, unsigned seed = 1) {
  Follows result;
  const std::size_t batches = residual.size();
  if (batches < 3) return result;
  std::vector<std::size_t> own(batches);
  for (std::size_t b = 0; b < batches; ++b) own[b] = b;
  for (const Course& course : courses) {
    const detail::BestLag best = detail::best_lag<Scalar>(residual, course.series, own);
    if (std::abs(best.correlation) <= std::abs(result.correlation)) continue;
    result = {course.name, best.correlation, static_cast<double>(best.lag) / static_cast<double>(residual[0].size()),
              1};
  }
  std::minstd_rand random(seed);
  int as_good = 0, draws = 0;
  for (int draw = 0; draw < 39; ++draw) {
    std::vector<std::size_t> order = own;
    for (std::size_t b = batches - 1; b > 0; --b) std::swap(order[b], order[random() % b]);  // Sattolo: nobody stays
    double largest = 0;
    for (const Course& course : courses)
      largest = std::max(largest, std::abs(detail::best_lag<Scalar>(residual, course.series, order).correlation));
    as_good += largest >= std::abs(result.correlation);
    ++draws;
  }
  result.p_value = (1. + as_good) / (1. + draws);
  if (result.p_value > .05 || std::abs(result.correlation) < .3) result.course.clear();
  return result;
}

THERMFIT_COMPILED_TEMPLATE(Follows follows<double>(const std::vector<Vector>&, const std::vector<Course>&, unsigned));

}  // namespace thermfit
