#pragma once

/// Batches of which everything comes later or earlier on one of the sides.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/sides/side_weighing.hpp"

namespace thermfit::detail {

/// Looks for a delay between the sides of each batch.
template <typename Scalar = double>
class Delays {
 public:
  explicit Delays(SideWeighing<Scalar>& of) : of_(of) {}

  /// Everything of a batch comes later or earlier than simulated.
  std::vector<DataProblem> run() {
    std::vector<double> late_s(of_.all().size(), 0);
    BatchNumbers off;
    for (const std::size_t b : of_.all()) {
      const VectorX<Scalar>& time_s = of_.sides().time_s[b];
      const double span = time_s(time_s.size() - 1) - time_s(0), step = span / static_cast<double>(time_s.size() - 1);
      double best = std::log(of_.limits().late), better = 0;
      for (int k = -60; k <= 60; ++k) {
        const double d = (std::abs(k) <= 30 ? k : (k > 0 ? 1 : -1) * 30 * std::pow(1.07, std::abs(k) - 30)) * step;
        if (k == 0 || std::abs(d) > span / 2) continue;
        const double gain = later_gain(b, d, better);
        if (gain < best && better > .75) best = gain, late_s[b] = d;
      }
      if (late_s[b] != 0) off.push_back(b);
    }
    if (off.empty()) return {};
    const double nats = late_nats(off, late_s);
    if (nats < of_.limits().suspected_nats) return {};
    std::vector<double> delays;
    for (const std::size_t b : off) delays.push_back(late_s[b]);
    std::sort(delays.begin(), delays.end());
    DataProblem told = of_.problem(Kind::clock_offset, {}, nats);
    told.side = Side::either;
    told.figure = delays[delays.size() / 2];
    told.batches = of_.names_of(off);
    return {std::move(told)};
  }

 private:
  using Kind = DataProblem::Kind;
  using Side = DataProblem::Side;

  /// A course `late_s` later, NaN where it was not yet known. `time_s` increases.
  static VectorX<Scalar> later(const VectorX<Scalar>& course, const VectorX<Scalar>& time_s, double late_s) {
    VectorX<Scalar> result(course.size());
    Index after = 1;
    for (Index k = 0; k < course.size(); ++k) {
      const double t = time_s(k) - late_s;
      if (t < time_s(0) || t > time_s(time_s.size() - 1)) {
        result(k) = std::nan("");
        continue;
      }
      while (after + 1 < time_s.size() && time_s(after) < t) ++after;
      while (after > 1 && time_s(after - 1) > t) --after;
      const double share = (t - time_s(after - 1)) / (time_s(after) - time_s(after - 1));
      result(k) = course(after - 1) + share * (course(after) - course(after - 1));
    }
    return result;
  }

  /// log ratio of the misfit of the rises of a batch when the simulated ones come later, mean over the channels that
  /// move; `better`: the share of them that it lowers.
  double later_gain(std::size_t b, double late_s, double& better) const {
    double sum = 0, count = 0;
    better = 0;
    const VectorX<Scalar>& time_s = of_.sides().time_s[b];
    for (const SideChannel& one : of_.sides().channels) {
      const VectorX<Scalar>&x = one.simulated[b], &y = one.measured[b];
      const VectorX<Scalar> moved = later(x, time_s, late_s);
      double now = 0, then = 0, n = 0, mean_now = 0, mean_then = 0, low = 1e300, high = -1e300;
      for (Index k = 0; k < x.size(); ++k) {
        if (!std::isfinite(moved(k) + y(k))) continue;
        const double a = y(k) - x(k), c = y(k) - moved(k);
        mean_now += a, mean_then += c, now += a * a, then += c * c, ++n;
        low = std::min<double>(low, x(k)), high = std::max<double>(high, x(k));
      }
      if (n < 8 || high - low < 20 * one.noise) continue;
      now = now / n - mean_now * mean_now / (n * n), then = then / n - mean_then * mean_then / (n * n);
      const double noise = one.noise * one.noise;
      const double gain = .5 * std::log((std::max(then, 0.) + noise) / (std::max(now, 0.) + noise));
      sum += gain, ++count;
      better += gain < 0;
    }
    better = count > 0 ? better / count : 0;
    return count > 0 ? sum / count : 0;
  }

  /// By how much later simulated courses are more probable in these batches, all channels together.
  double late_nats(const BatchNumbers& batches, const std::vector<double>& late_s) {
    double sum = 0;
    const double looks = looks_per_batch * static_cast<double>(batches.size());
    for (std::size_t c = 0; c < of_.sides().channels.size(); ++c) {
      const std::pair<VectorX<Scalar>, VectorX<Scalar>> both = of_.courses(c, c, batches);
      const VectorX<Scalar>&y = both.first, &x = both.second;
      MatrixX<Scalar> directions = of_.directions_of(c, batches), moved = directions;
      VectorX<Scalar> later_x = x, there = VectorX<Scalar>::Ones(x.size());
      Index row = 0;
      for (const std::size_t b : batches) {
        const VectorX<Scalar>& time_s = of_.sides().time_s[b];
        const Index rows = time_s.size();
        const auto shift = [&](auto column) {
          const VectorX<Scalar> shifted = later(VectorX<Scalar>(column.segment(row, rows)), time_s, late_s[b]);
          for (Index k = 0; k < rows; ++k) {
            const bool known = std::isfinite(shifted(k));
            column(row + k) = known ? shifted(k) : 0;
            if (!known) there(row + k) = 0;
          }
        };
        shift(later_x.col(0));
        for (Index j = 0; j < moved.cols(); ++j) shift(moved.col(j));
        row += rows;
      }
      const auto weighed = [&](const VectorX<Scalar>& simulated, const MatrixX<Scalar>& along) {
        VectorX<Scalar> gap = there.cwiseProduct(VectorX<Scalar>(y - simulated));
        VectorX<Scalar> moves = y;
        of_.centre(moves, batches);
        if (of_.channel(c).displacement) of_.centre(gap, batches);
        const double floor = std::max({of_.channel(c).noise, .01 * rms_of<Scalar>(moves), 1e-9});
        return ChannelBelief<Scalar>(there.asDiagonal() * along, looks).weigh(gap, floor).nats;
      };
      sum += weighed(later_x, moved) - weighed(x, directions);
    }
    return sum;
  }

  SideWeighing<Scalar>& of_;
};

}  // namespace thermfit::detail
