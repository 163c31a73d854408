#pragma once

/// What the best explanation leaves: is it noise, how large, and what does it look like.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/statistics/even_series.hpp"
#include "thermfit/statistics/follows.hpp"
#include "thermfit/statistics/whiteness.hpp"

namespace thermfit {

namespace detail {

/// The courses a residual may follow: every input that changes, every temperature, and the mean heating rate.
template <typename Scalar = double>
std::vector<Course> recorded_courses(const Campaign& batches, Index length) {
  std::vector<Course> courses;
  const auto add = [&](const std::string& name, auto column) {
    Course course{name, {}};
    double change = 0;
    for (const Batch& batch : batches) {
      course.series.push_back(interval_means(batch.time_s, column(batch), length));
      change = std::max(change, course.series.back().maxCoeff() - course.series.back().minCoeff());
    }
    if (change > 0) courses.push_back(std::move(course));
  };
  for (const auto channels : {&Batch::inputs, &Batch::temperatures})
    for (Index i = 0; i < (batches[0].*channels).count(); ++i)
      add((batches[0].*channels).names[static_cast<std::size_t>(i)], [i, channels](const Batch& batch) {
        const MatrixX<Scalar>& values = (batch.*channels).values;
        return VectorX<Scalar>(values.col(i));
      });
  return courses;
}

struct ShapeShares {
  double offset = 0, trend = 0;  ///< of the square, 0…1; the trend beside the offset
};

/// How much of a residual is one value per batch, and how much a straight line in time.
template <typename Scalar = double>
ShapeShares shape_shares(const std::vector<VectorX<Scalar>>& series) {
  double total = 0, offset = 0, trend = 0;
  for (const VectorX<Scalar>& values : series) {
    const Index count = values.size();
    const VectorX<Scalar> time = VectorX<Scalar>::LinSpaced(count, -1, 1);
    total += values.squaredNorm();
    offset += static_cast<double>(count) * values.mean() * values.mean();
    trend += std::pow(time.dot(values), 2) / time.squaredNorm();
  }
  return total > 0 ? ShapeShares{offset / total, trend / total} : ShapeShares{};
}

/// Means of equally many consecutive samples, at most `most` of them: white stays white, which interpolation would not
/// do.
template <typename Scalar = double>
VectorX<Scalar> block_means(const VectorX<Scalar>& values, Index most) {
  const Index block = (values.size() + most - 1) / most;
  if (block <= 1) return values;
  VectorX<Scalar> means(values.size() / block);
  for (Index k = 0; k < means.size(); ++k) means(k) = values.segment(k * block, block).mean();
  return means;
}

}  // namespace detail

/// Numbers behind a look: shares of the square and sizes from which something is worth telling.
struct RemainingRules {
  double told_share = 1. / 3;  ///< of the square that an offset or a drift must hold
  double at_noise = 1.1;       ///< times the noise estimate up to which a residual is noise
  Index longest_series = 128;  ///< points a batch, for shape and drivers
  Index most_samples = 1024;   ///< a batch, for whiteness
};

/// Looks at `residuals[b]` (measured minus the best explanation, one value a row of `batches[b]`), of size `rms` beside
/// a noise estimate of `noise`, both in the unit of the gap; and says whether it is white.
///
/// In this order: an offset per batch, a straight drift, a recorded course it follows, each where it holds enough of
/// the square; otherwise slow or fast changes without a recorded driver. `seed` draws the null of the drivers.
/// Allocates.
template <typename Scalar = double>
std::pair<RemainingLook, bool> remaining_look(const Campaign& batches, const std::vector<Vector>& residuals, double rms,
                                              double noise, unsigned seed = 1, const RemainingRules& rules = {}) {
  RemainingLook look;
  look.noise = noise;
  Index length = rules.longest_series;
  for (const Batch& batch : batches) length = std::min(length, batch.rows());
  if (batches.empty() || length < 8 || !batches[0].has_time()) return {look, false};
  std::vector<VectorX<Scalar>> samples, series;
  for (std::size_t b = 0; b < batches.size(); ++b) {
    samples.push_back(detail::block_means<Scalar>(residuals[b], rules.most_samples));
    series.push_back(interval_means(batches[b].time_s, residuals[b], length));
  }
  const bool white = whiteness(samples).white;
  look.kind = RemainingLook::Kind::noise;
  if (rms <= rules.at_noise * noise) return {look, white};
  const detail::ShapeShares shape = detail::shape_shares<Scalar>(series);
  const Follows driver = follows(series, detail::recorded_courses<Scalar>(batches, length), seed);
  if (shape.offset > rules.told_share) look.offset_share = shape.offset;
  if (shape.trend > rules.told_share) look.trend_share = shape.trend;
  if (!driver.course.empty()) {
    look.follows = driver.course;
    look.correlation = driver.correlation;
    look.lag_min = driver.lag_share * (batches[0].time_s(batches[0].rows() - 1) - batches[0].time_s(0)) / 60;
  }
  const bool shaped = look.offset_share > 0 || look.trend_share > 0 || !look.follows.empty();
  look.kind = shaped  ? RemainingLook::Kind::shaped
              : white ? RemainingLook::Kind::louder_noise
                      : RemainingLook::Kind::slow_unrecorded;
  return {look, white};
}

/// sqrt(rms^2 - noise^2), 0 where the noise is larger.
inline double unexplained(double rms, double noise) { return std::sqrt(std::max(0., rms * rms - noise * noise)); }

}  // namespace thermfit
