#pragma once

/// What the best explanation leaves: is it noise, how large, and what does it look like.

#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/number.hpp"
#include "thermfit/statistics/even_series.hpp"
#include "thermfit/statistics/follows.hpp"
#include "thermfit/statistics/whiteness.hpp"

namespace thermfit {

namespace detail {

/// The courses a residual may follow: every input that changes, every temperature, and the mean heating rate.
inline std::vector<Course> recorded_courses(const Campaign& batches, Index length) {
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
  for (Index i = 0; i < batches[0].inputs.count(); ++i)
    add(batches[0].inputs.names[static_cast<std::size_t>(i)],
        [i](const Batch& batch) -> Vector { return batch.inputs.values.col(i); });
  for (Index i = 0; i < batches[0].temperatures.count(); ++i)
    add(batches[0].temperatures.names[static_cast<std::size_t>(i)],
        [i](const Batch& batch) -> Vector { return batch.temperatures.values.col(i); });
  return courses;
}

struct ShapeShares {
  double offset = 0, trend = 0;  ///< of the square, 0…1; the trend beside the offset
};

/// How much of a residual is one value per batch, and how much a straight line in time.
inline ShapeShares shape_shares(const std::vector<Vector>& series) {
  double total = 0, offset = 0, trend = 0;
  for (const Vector& values : series) {
    const Index count = values.size();
    const Vector time = Vector::LinSpaced(count, -1, 1);
    total += values.squaredNorm();
    offset += static_cast<double>(count) * values.mean() * values.mean();
    trend += std::pow(time.dot(values), 2) / time.squaredNorm();
  }
  return total > 0 ? ShapeShares{offset / total, trend / total} : ShapeShares{};
}

/// Means of equally many consecutive samples, at most `most` of them: white stays white, which interpolation would not
/// do.
inline Vector block_means(const Vector& values, Index most) {
  const Index block = (values.size() + most - 1) / most;
  if (block <= 1) return values;
  Vector means(values.size() / block);
  for (Index k = 0; k < means.size(); ++k) means(k) = values.segment(k * block, block).mean();
  return means;
}

}  // namespace detail

/// Looks at `residuals[b]` (measured minus the best explanation, one value a row of `batches[b]`).
///
/// `rms` and `noise` in um (or K) give the size: unexplained = sqrt(rms^2 - noise^2). The words name, in this order,
/// what holds more than a third of the square: an offset per batch, a straight drift, a recorded course it follows;
/// otherwise slow or fast changes without a recorded driver.
inline Remaining remaining_gap(const Campaign& batches, const std::vector<Vector>& residuals, double rms, double noise,
                               const std::string& unit = "um", unsigned seed = 1) {
  Remaining result;
  result.unexplained_um = std::sqrt(std::max(0., rms * rms - noise * noise));
  std::vector<Vector> series;
  Index length = 128;
  for (const Batch& batch : batches) length = std::min(length, batch.rows());
  if (batches.empty() || length < 8 || !batches[0].has_time()) {
    result.looks_like = "too few samples to say";
    return result;
  }
  std::vector<Vector> samples;
  for (std::size_t b = 0; b < batches.size(); ++b) {
    samples.push_back(detail::block_means(residuals[b], 1024));
    series.push_back(interval_means(batches[b].time_s, residuals[b], length));
  }
  result.white = whiteness(samples).white;
  if (rms <= 1.1 * noise) {
    result.looks_like = "noise";
    return result;
  }
  const detail::ShapeShares shape = detail::shape_shares(series);
  const Follows driver = follows(series, detail::recorded_courses(batches, length), seed);
  std::vector<std::string> parts;
  if (shape.offset > 1. / 3) parts.push_back("an offset per batch (" + fixed_text(100 * shape.offset, 0) + " % of it)");
  if (shape.trend > 1. / 3) parts.push_back("a slow drift (" + fixed_text(100 * shape.trend, 0) + " %)");
  if (!driver.course.empty()) {
    const double minutes = driver.lag_share * (batches[0].time_s(batches[0].rows() - 1) - batches[0].time_s(0)) / 60;
    parts.push_back("it follows " + driver.course + " (correlation " + fixed_text(driver.correlation, 2) +
                    (minutes > 0 ? ", " + fixed_text(minutes, 0) + " min later)" : ")"));
  }
  for (const std::string& part : parts) result.looks_like += (result.looks_like.empty() ? "" : "; ") + part;
  if (parts.empty())
    result.looks_like = result.white ? "noise larger than the noise estimate of " + fixed_text(noise, 2) + " " + unit
                                     : "slow changes that follow nothing recorded";
  return result;
}

}  // namespace thermfit
