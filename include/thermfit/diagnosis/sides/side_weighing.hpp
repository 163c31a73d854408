#pragma once

/// How probable one side makes what the other says, as given and written down otherwise.
///
/// Each fault of writing is a hypothesis about how a column was written down. It is weighed against the column as given
/// by how probable the other side makes it, with everything that calibration may move free within belief.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/sides/channel_belief.hpp"
#include "thermfit/diagnosis/sides/reading.hpp"
#include "thermfit/diagnosis/sides/side_channel.hpp"
#include "thermfit/diagnosis/sides/side_limits.hpp"
#include "thermfit/statistics/rms.hpp"

namespace thermfit::detail {

/// Which batches of a campaign.
using BatchNumbers = std::vector<std::size_t>;

/// Weighs channels of both sides; remembers what belief leaves of each. `sides` must outlive it.
template <typename Scalar = double>
class SideWeighing {
 public:
  SideWeighing(const Sides& sides, const SideLimits& limits) : sides_(sides), limits_(limits) {
    all_.resize(sides.batches.size());
    std::iota(all_.begin(), all_.end(), std::size_t{0});
  }

  const Sides& sides() const { return sides_; }
  const SideLimits& limits() const { return limits_; }
  const BatchNumbers& all() const { return all_; }
  const SideChannel& channel(std::size_t c) const { return sides_.channels[c]; }

  /// Every batch about its own mean: the zero of a probe is nobody's business here.
  void centre(Eigen::Ref<MatrixX<Scalar>> values, const BatchNumbers& batches) const {
    Index row = 0;
    for (const std::size_t b : batches) {
      const Index rows = sides_.time_s[b].size();
      auto part = values.middleRows(row, rows);
      for (Index j = 0; j < part.cols(); ++j) part.col(j).array() -= part.col(j).mean();
      row += rows;
    }
  }

  /// Simulated and measured samples of a channel, gaps in the measurement (and what is not simulated) 0 in both.
  std::pair<VectorX<Scalar>, VectorX<Scalar>> courses(std::size_t measured, std::size_t simulated,
                                                      const BatchNumbers& batches) const {
    VectorX<Scalar> y = stacked<Scalar>(channel(measured).measured, batches),
                    x = stacked<Scalar>(channel(simulated).simulated, batches);
    for (Index k = 0; k < y.size(); ++k)
      if (!std::isfinite(y(k) + x(k))) y(k) = x(k) = 0;
    return {std::move(y), std::move(x)};
  }

  /// The measured channel under a reading, as what `simulated` should show; per unit of what was measured.
  WeighedGap weigh(std::size_t measured, std::size_t simulated, const BatchNumbers& batches, const Reading& reading,
                   const MatrixX<Scalar>& beside = MatrixX<Scalar>()) {
    auto [y, x] = courses(measured, simulated, batches);
    const double scale = reading.turned ? -reading.scale : reading.scale, size = std::abs(scale);
    VectorX<Scalar> gap = (scale * y - x).array() + reading.shift;
    VectorX<Scalar> moves = x, moved = y;
    centre(moves, batches), centre(moved, batches);
    if (channel(simulated).displacement) centre(gap, batches);
    const double swing = std::max(rms_of<Scalar>(moves), size * rms_of<Scalar>(moved));
    const double floor = std::max({size * channel(measured).noise, .01 * swing, 1e-9});
    WeighedGap result = belief(simulated, batches, beside).weigh(gap, floor);
    const double looks =
        std::min(looks_per_batch * static_cast<double>(batches.size()), static_cast<double>(gap.size()));
    result.nats += looks * std::log(size);
    result.left /= size;
    return result;
  }
  /// The same of one channel on both sides.
  WeighedGap weigh(std::size_t c, const BatchNumbers& batches, const Reading& reading,
                   const MatrixX<Scalar>& beside = MatrixX<Scalar>()) {
    return weigh(c, c, batches, reading, beside);
  }

  /// Directions of belief in some batches, about their means where the zero is free.
  MatrixX<Scalar> directions_of(std::size_t c, const BatchNumbers& batches) const {
    MatrixX<Scalar> directions = uncentred_directions_of(c, batches);
    if (channel(c).displacement) centre(directions, batches);
    return directions;
  }

  /// The same with the zero as it is.
  MatrixX<Scalar> uncentred_directions_of(std::size_t c, const BatchNumbers& batches) const {
    const MatrixX<Scalar> whole = sides_.belief(c);
    std::vector<Index> first{0};
    for (const Vector& time_s : sides_.time_s) first.push_back(first.back() + time_s.size());
    Index rows = 0;
    for (const std::size_t b : batches) rows += sides_.time_s[b].size();
    MatrixX<Scalar> directions(rows, whole.cols());
    rows = 0;
    for (const std::size_t b : batches) {
      directions.middleRows(rows, sides_.time_s[b].size()) = whole.middleRows(first[b], sides_.time_s[b].size());
      rows += sides_.time_s[b].size();
    }
    return directions;
  }

  /// Names of batches; none where they are all.
  std::vector<std::string> names_of(const BatchNumbers& batches) const {
    std::vector<std::string> names;
    if (batches.size() == sides_.batches.size()) return names;
    for (const std::size_t b : batches) names.push_back(sides_.batches[b]);
    return names;
  }

  /// A problem as certain as `nats` make it.
  DataProblem problem(DataProblem::Kind kind, std::vector<std::string> names, double nats) const {
    DataProblem result;
    result.kind = kind;
    result.names = std::move(names);
    result.certain = nats >= limits_.certain_nats;
    result.nats = nats;
    return result;
  }

  /// What a ratio of misfits before any calibration says of two channels: one look a batch, for what the simulator
  /// lacks is the same in all samples.
  double plain_nats(double ratio) const { return -2 * static_cast<double>(all_.size()) * std::log(ratio); }

  /// What belief leaves of the channels as given, as a share of how they move: the median.
  double share_left() {
    std::vector<double> shares;
    for (std::size_t c = 0; c < sides_.channels.size(); ++c) {
      VectorX<Scalar> moved = courses(c, c, all_).first;
      centre(moved, all_);
      const double swing = rms_of<Scalar>(moved);
      if (swing > 3 * channel(c).noise) shares.push_back(weigh(c, all_, {}).left / swing);
    }
    if (shares.empty()) return 1;
    std::nth_element(shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2), shares.end());
    return shares[shares.size() / 2];
  }

  /// log probability of all channels as given.
  double nats_as_given() {
    double sum = 0;
    for (std::size_t c = 0; c < sides_.channels.size(); ++c) sum += weigh(c, all_, {}).nats;
    return sum;
  }

 private:
  const ChannelBelief<Scalar>& belief(std::size_t c, const BatchNumbers& batches, const MatrixX<Scalar>& beside) {
    const auto key = std::make_pair(c, batches);
    const bool plain = beside.cols() == 0;
    if (plain)
      if (const auto known = beliefs_.find(key); known != beliefs_.end()) return known->second;
    const MatrixX<Scalar> directions = directions_of(c, batches);
    MatrixX<Scalar> with(directions.rows(), directions.cols() + beside.cols());
    with.leftCols(directions.cols()) = directions;
    if (!plain) with.rightCols(beside.cols()) = beside;
    ChannelBelief<Scalar> made(std::move(with), looks_per_batch * static_cast<double>(batches.size()));
    if (!plain) return beside_ = std::move(made);
    return beliefs_.emplace(key, std::move(made)).first->second;
  }

  const Sides& sides_;
  const SideLimits limits_;
  BatchNumbers all_;
  std::map<std::pair<std::size_t, BatchNumbers>, ChannelBelief<Scalar>> beliefs_;
  ChannelBelief<Scalar> beside_{MatrixX<Scalar>::Zero(1, 1), 1};
};

}  // namespace thermfit::detail
