#pragma once

/// What a compensator must answer on a course of events, so that an export can test itself where it runs.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "thermfit/controller/compensator.hpp"
#include "thermfit/controller/narrow_model.hpp"

namespace thermfit::cli {

template <class Scalar>
using HostCompensator = Compensator<Scalar, dynamic_size, dynamic_size, dynamic_size>;

/// The same readings `repeat` times, after a command; then the offset and status that must have come out.
template <class Scalar>
struct TestVector {
  enum Command : std::uint32_t { none, start, stop, datum };
  std::uint32_t repeat;
  Command command;
  std::vector<Scalar> readings_degC;
  std::vector<Scalar> offset_um;
  std::uint32_t status;
};

/// A course through every state: warm-up, a spike, each sensor lost and recovered, bad numbers, a jump, a sample far
/// outside, a stuck sensor, all sensors gone, and a stop. Long waits are one vector with a repeat.
template <class Scalar>
class TestCourse {
 public:
  using Device = HostCompensator<Scalar>;

  /// `no_reading` stands for a reading that is missing; give a finite one where NaN cannot be written down. Then there
  /// are no infinities either.
  TestCourse(const typename Device::Model& model, const typename Device::Settings& settings,
             Scalar no_reading = std::numeric_limits<Scalar>::quiet_NaN())
      : model_(model), settings_(settings), device_(model, settings), readings_(model.sensors()), gone_(no_reading) {}

  std::vector<TestVector<Scalar>> run() {
    using Limits = std::numeric_limits<Scalar>;
    const std::vector<Scalar> cold = sample(model_.rise ? 0 : -1), warm = sample(1);
    readings_ = cold;
    add(1, TestVector<Scalar>::none);
    add(2, TestVector<Scalar>::start);
    add(settings_.zero.samples + 2, TestVector<Scalar>::datum);
    move_to(warm, 24);
    add(40);
    for (std::size_t i = 0; i < readings_.size(); ++i) lose(i, gone_);
    const Scalar bad[] = {Limits::infinity(), -Limits::infinity(), Limits::max(), Limits::denorm_min(),
                          settings_.sensors[0].highest_degC + 1};
    for (const Scalar reading : bad) {
      if (is_finite(gone_) && !within(magnitude(reading), Scalar(1e-3), gone_)) continue;
      with(0, reading, 1);
      add(1);
    }
    if (settings_.sensors[0].largest_step_K < 1000) with(0, readings_[0] - 2 * settings_.sensors[0].largest_step_K, 2);
    add(2);
    readings_ = sample(7);
    add(200);
    readings_ = warm;
    add(200);
    stick();
    std::fill(readings_.begin(), readings_.end(), gone_);
    add(settings_.hold_steps);
    add(1);
    add(100);
    readings_ = warm;
    add(settings_.patience.recover_after_steps + 20);
    add(30, TestVector<Scalar>::stop);
    add(10000);
    readings_ = cold;
    readings_.back() = gone_;
    add(settings_.patience.lost_after_steps + 3, TestVector<Scalar>::start);
    return std::move(vectors_);
  }

 private:
  using Vector = TestVector<Scalar>;

  /// `spread` standard deviations of training beyond the domain's mean, or that far from a cold start, within range.
  std::vector<Scalar> sample(Scalar spread) const {
    std::vector<Scalar> readings(model_.sensors());
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const Scalar low = settings_.sensors[i].lowest_degC, high = settings_.sensors[i].highest_degC;
      const Scalar mean = model_.domain.mean[i], scale = 1 / model_.domain.inverse_scale[i];
      const Scalar cold = model_.rise ? low + (high - low) / 4 : mean - scale;
      const Scalar way = model_.rise ? mean + std::max(Scalar(0), spread - 1) * scale : (spread + 1) * scale;
      readings[i] = std::round(std::min(high, std::max(low, spread == 0 ? cold : cold + way)) * 64) / 64;
      if (!within(readings[i], low, high)) readings[i] = (low + high) / 2;
    }
    return readings;
  }

  void add(std::uint32_t repeat, typename Vector::Command command = Vector::none) {
    if (repeat == 0) return;
    if (command == Vector::start) device_.start();
    if (command == Vector::stop) device_.stop();
    if (command == Vector::datum) device_.take_datum();
    for (std::uint32_t n = 0; n < repeat; ++n) device_.step(readings_);
    vectors_.push_back({repeat, command, readings_, device_.offset_um(), device_.status().word});
  }

  void with(std::size_t sensor, Scalar reading, std::uint32_t repeat) {
    const Scalar kept = readings_[sensor];
    readings_[sensor] = reading;
    add(repeat);
    readings_[sensor] = kept;
  }

  void move_to(const std::vector<Scalar>& goal, std::uint32_t steps) {
    const std::vector<Scalar> from = readings_;
    for (std::uint32_t n = 1; n <= steps; ++n) {
      for (std::size_t i = 0; i < goal.size(); ++i)
        readings_[i] = from[i] + (goal[i] - from[i]) * (static_cast<Scalar>(n) / static_cast<Scalar>(steps));
      add(1);
    }
  }

  void lose(std::size_t sensor, Scalar reading) {
    with(sensor, reading, 1);
    add(1);
    with(sensor, reading, settings_.patience.lost_after_steps);
    with(sensor, reading, 10);
    add(settings_.patience.recover_after_steps);
    add(10);
  }

  /// The first sensor rests for as long as is suspicious while the others move on.
  void stick() {
    const std::uint32_t steps = settings_.sensors[0].stuck_steps;
    if (steps == 0 || steps > 100000 || readings_.size() < 2) return;
    const std::vector<Scalar> kept = readings_;
    for (std::size_t i = 1; i < readings_.size(); ++i)
      readings_[i] -= std::round(settings_.patience.others_moved_K * 96) / 64;
    add(steps);
    add(settings_.patience.lost_after_steps + 5);
    readings_ = kept;
    readings_[0] += Scalar(.25);
    add(settings_.patience.recover_after_steps + 20);
  }

  const typename Device::Model& model_;
  const typename Device::Settings& settings_;
  Device device_;
  std::vector<Scalar> readings_;
  Scalar gone_;
  std::vector<Vector> vectors_;
};

}  // namespace thermfit::cli
