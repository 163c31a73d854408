#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "thermfit/types.hpp"

namespace thermfit {

/// The course of a temperature of the room over a batch, as something that follows it with a first-order lag feels it.
///
/// x' = (room - x) / lag, x = room at the first sample, the room linear between samples: solved exactly. Keeps the
/// courses of the lags asked for last, since laws are asked at every sample; not to be shared between threads.
class RoomHistory {
 public:
  RoomHistory() = default;
  /// Both must outlive the history.
  RoomHistory(const Vector& time_s, const Vector& room_degC) : time_s_(&time_s), room_degC_(&room_degC) {}

  /// K above the first sample, felt at a time (s) through a lag (s) above 0.
  double felt_rise(double lag_s, double time_s) const {
    const double* const first = time_s_->data();
    const double* const last = first + time_s_->size();
    const Index k = std::max<Index>(0, std::upper_bound(first, last, time_s) - first - 1);
    return onward(course(lag_s)(k), k, lag_s, time_s - (*time_s_)(k)) - (*room_degC_)(0);
  }

 private:
  /// From `felt` at sample k on by dt.
  double onward(double felt, Index k, double lag_s, double dt) const {
    if (dt <= 0) return felt;
    const Vector& room = *room_degC_;
    const bool end = k + 1 >= room.size();
    const double rate = end ? 0 : (room(k + 1) - room(k)) / ((*time_s_)(k + 1) - (*time_s_)(k));
    const double behind = rate * lag_s;  // once it has settled
    return room(k) + rate * dt - behind + (felt - room(k) + behind) * std::exp(-dt / lag_s);
  }

  const Vector& course(double lag_s) const {
    for (const auto& [lag, felt] : kept_)
      if (lag == lag_s) return felt;
    Vector felt(room_degC_->size());
    felt(0) = (*room_degC_)(0);
    for (Index k = 0; k + 1 < felt.size(); ++k)
      felt(k + 1) = onward(felt(k), k, lag_s, (*time_s_)(k + 1) - (*time_s_)(k));
    if (kept_.size() == 4) kept_.erase(kept_.begin());
    kept_.emplace_back(lag_s, std::move(felt));
    return kept_.back().second;
  }

  const Vector* time_s_ = nullptr;
  const Vector* room_degC_ = nullptr;
  mutable std::vector<std::pair<double, Vector>> kept_;
};

}  // namespace thermfit
