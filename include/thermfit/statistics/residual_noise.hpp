#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/statistics/rms.hpp"
#include "thermfit/types.hpp"

namespace thermfit {

/// Residual of one channel: white noise of the sensor plus a slow part that remembers.
///
/// cov(r_i, r_j) = white^2 [i = j] + slow^2 exp(-|t_i - t_j| / memory_s). Correlated samples thereby count as the few
/// that they are (Kristensen, Madsen and Joergensen 2004 use the same form for the terms a model lacks).
struct ResidualNoise {
  double white = 1;     ///< standard deviation of the white part, in the unit of the channel
  double slow = 0;      ///< of the slow part
  double memory_s = 1;  ///< time after which the slow part has forgotten all but 1/e

  /// Standard deviation of both together.
  double sd() const { return std::hypot(white, slow); }
};

/// A channel over all batches: one series a batch, NaN where a value is missing.
using SeriesByBatch = std::vector<Vector>;

/// Innovations of the Kalman filter of a ResidualNoise: a linear map that makes its series independent with unit
/// variance, in O(samples).
class Whitener {
 public:
  /// `present` may be empty (all are) or tell which samples count.
  Whitener(const ResidualNoise& noise, const Vector& time_s, const std::vector<char>& present = {})
      : forget_(time_s.size()), gain_(time_s.size()), scale_(time_s.size()) {
    const double white = noise.white * noise.white, slow = noise.slow * noise.slow;
    double variance = slow, step = -1, forget = 0;
    for (Index k = 0; k < time_s.size(); ++k) {
      const double total = variance + white;
      const bool counts = present.empty() || present[static_cast<std::size_t>(k)] != 0;
      gain_(k) = counts && total > 0 ? variance / total : 0;
      scale_(k) = counts && total > 0 ? 1 / std::sqrt(total) : 0;
      if (counts && total > 0) {
        log_determinant_ += std::log(total);
        ++count_;
      }
      variance *= 1 - gain_(k);
      if (k + 1 < time_s.size()) {
        const double next = time_s(k + 1) - time_s(k);
        if (next != step) forget = std::exp(-next / noise.memory_s);
        step = next;
        forget_(k) = forget;
        variance = forget * forget * variance + slow * (1 - forget * forget);
      }
    }
    if (forget_.size() > 0) forget_(forget_.size() - 1) = 0;
  }

  /// Of the covariance of the samples that count.
  double log_determinant() const { return log_determinant_; }
  Index count() const { return count_; }  ///< samples that count

  /// Whitens every column of `series` in place; samples that do not count become 0. Does not allocate.
  template <class Derived>
  void apply(Eigen::MatrixBase<Derived>& series) const {
    for (Index column = 0; column < series.cols(); ++column) {
      double slow = 0;
      for (Index k = 0; k < series.rows(); ++k) {
        const bool counts = scale_(k) > 0;
        const double innovation = counts ? series(k, column) - slow : 0;
        series(k, column) = innovation * scale_(k);
        slow = forget_(k) * (slow + gain_(k) * innovation);
      }
    }
  }

 private:
  Vector forget_, gain_, scale_;
  double log_determinant_ = 0;
  Index count_ = 0;
};

/// log density of the series (nats, missing samples left out) under the noise, all batches together, without the
/// constant of 2 pi. Does not allocate.
template <typename Scalar = double>
double log_likelihood(const ResidualNoise& noise, const SeriesByBatch& residual, const std::vector<Vector>& time_s) {
  const double white = noise.white * noise.white, slow = noise.slow * noise.slow;
  double squares = 0, log_determinant = 0;
  for (std::size_t b = 0; b < residual.size(); ++b) {
    const VectorX<Scalar>&r = residual[b], &time = time_s[b];
    double mean = 0, variance = slow, step = -1, forget = 0, product = 1;
    for (Index k = 0; k < r.size(); ++k) {
      if (!std::isnan(r(k))) {
        const double total = variance + white, innovation = r(k) - mean, gain = variance / total;
        squares += innovation * innovation / total;
        product *= total;
        if (product < 1e-100 || product > 1e100) {
          log_determinant += std::log(product);
          product = 1;
        }
        mean += gain * innovation;
        variance *= 1 - gain;
      }
      if (k + 1 < r.size()) {
        const double next = time(k + 1) - time(k);
        if (next != step) forget = std::exp(-next / noise.memory_s);
        step = next;
        mean *= forget;
        variance = forget * forget * variance + slow * (1 - forget * forget);
      }
    }
    log_determinant += std::log(product);
  }
  return -0.5 * (squares + log_determinant);
}

THERMFIT_COMPILED_TEMPLATE(double log_likelihood<double>(const ResidualNoise&, const SeriesByBatch&,
                                                         const std::vector<Vector>&));

/// What is known of a channel's noise before its residual is seen.
struct NoiseBounds {
  double least_white = 0;  ///< resolution and high-frequency noise of the readings
  double least_slow = 0;   ///< what a lumped machine cannot represent
  double shortest_s = 1;   ///< least memory_s
  double longest_s = 1;    ///< most memory_s
};

/// Maximum-likelihood noise of a residual within bounds, by a compass search in the logarithms of the three numbers.
/// `start` shortens the search where a similar residual was estimated before. `time_s` by batch. Allocates.
template <typename Scalar = double>
ResidualNoise estimate_noise(const SeriesByBatch& residual, const std::vector<Vector>& time_s,
                             const NoiseBounds& bounds, const ResidualNoise* start = nullptr) {
  const double rms = rms_of(residual);
  const double tiny = std::max({1e-9, 1e-6 * rms, 1e-3 * bounds.least_white});
  using Point = std::array<double, 3>;  // logarithms of white, slow, memory
  const Point low{std::log(std::max(tiny, bounds.least_white)), std::log(std::max(tiny, bounds.least_slow)),
                  std::log(bounds.shortest_s)};
  const Point high{std::log(std::max(10 * rms, std::exp(low[0]))), std::log(std::max(10 * rms, std::exp(low[1]))),
                   std::log(bounds.longest_s)};
  const auto clamped = [&](Point p) {
    for (std::size_t i = 0; i < 3; ++i) p[i] = std::clamp(p[i], low[i], std::max(low[i], high[i]));
    return p;
  };
  const auto noise_at = [](const Point& p) { return ResidualNoise{std::exp(p[0]), std::exp(p[1]), std::exp(p[2])}; };
  const auto value = [&](const Point& p) { return log_likelihood<Scalar>(noise_at(p), residual, time_s); };

  std::vector<Point> starts;
  if (start != nullptr) {
    starts = {{std::log(std::max(tiny, start->white)), std::log(std::max(tiny, start->slow)),
               std::log(std::max(1e-9, start->memory_s))}};
  } else {
    const double white = std::max({bounds.least_white, tiny, 0.1 * rms}), middle = 0.5 * (low[2] + high[2]);
    starts = {{std::log(white), std::log(std::max(rms, tiny)), middle},
              {std::log(std::max(rms, tiny)), std::log(std::max(0.3 * rms, tiny)), middle}};
  }
  Point best{};
  double best_value = -std::numeric_limits<double>::infinity();
  for (const Point& begin : starts) {
    Point at = clamped(begin);
    double here = value(at);
    for (double step = start != nullptr ? 0.35 : 1.2; step > 0.05;) {
      bool moved = false;
      for (std::size_t i = 0; i < 3; ++i)
        for (const double direction : {step, -step}) {
          Point trial = at;
          trial[i] += direction;
          trial = clamped(trial);
          if (trial == at) continue;
          const double there = value(trial);
          if (there > here + 1e-9) {
            at = trial;
            here = there;
            moved = true;
            break;
          }
        }
      if (!moved) step *= 0.4;
    }
    if (here > best_value) best_value = here, best = at;
  }
  return noise_at(best);
}

THERMFIT_COMPILED_TEMPLATE(ResidualNoise estimate_noise<double>(const SeriesByBatch&, const std::vector<Vector>&,
                                                                const NoiseBounds&, const ResidualNoise*));

}  // namespace thermfit
