#pragma once

/// What a compensator must answer on a course of events, so that an export can test itself where it runs.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "thermfit/controller/compensator.hpp"
#include "thermfit/controller/narrow_model.hpp"

namespace thermfit::cli {

template <class Scalar>
using HostCompensator = Compensator<Scalar, dynamic_size, dynamic_size, dynamic_size>;

/// The same readings `repeat` times, after a command; then the offset and status that must have come out. A power cycle
/// starts with the zero that was retained before it, or with a torn copy of that.
template <class Scalar>
struct TestVector {
  enum Command : std::uint32_t { none, start, stop, datum, power_cycle, torn_power_cycle };
  std::uint32_t repeat;
  Command command;
  std::vector<Scalar> readings_degC;
  std::vector<Scalar> offset_um;
  std::uint32_t status;
  std::uint32_t periods = 1;  ///< from each step to the next
  std::uint32_t beat = 0;     ///< the heartbeat, 0 before the first vector, grows by this before each step
};

/// A course through every state: warm-up, a spike, each sensor lost and recovered, bad numbers, a jump, a sample far
/// outside, a stuck sensor, a frozen one, one that comes back elsewhere, all sensors gone, and a stop. Long waits are
/// one vector with a repeat.
template <class Scalar>
class TestCourse {
 public:
  using Device = HostCompensator<Scalar>;
  static constexpr std::uint32_t off_periods = 7;  ///< of each power cycle

  /// `no_reading` stands for a reading that is missing; give a finite one where NaN cannot be written down. Then there
  /// are no infinities either.
  TestCourse(const typename Device::Model& model, const typename Device::Settings& settings,
             Scalar no_reading = std::numeric_limits<Scalar>::quiet_NaN())
      : model_(model),
        settings_(settings),
        device_(std::in_place, model, settings),
        readings_(model.sensors()),
        gone_(no_reading) {}

  /// What needs readings, start, stop and datum only.
  std::vector<TestVector<Scalar>> run() {
    follow_readings();
    return std::move(vectors_);
  }

  /// That and the rest: power cycles, periods other than one, a heartbeat that stops.
  std::vector<TestVector<Scalar>> run_all() {
    follow_readings();
    cycle_power();
    lose_periods();
    stop_heart();
    return std::move(vectors_);
  }

 private:
  using Vector = TestVector<Scalar>;

  void follow_readings() {
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
    if (settings_.sensors[0].largest_step_K < 1000)
      for (int k = 0; k < 2; ++k) with(0, readings_[0] - 2 * settings_.sensors[0].largest_step_K, 1);
    add(2);
    readings_ = sample(7);
    add(200);
    readings_ = warm;
    add(200);
    stick();
    freeze();
    come_back_elsewhere();
    leave_domain_without(0, warm);
    std::fill(readings_.begin(), readings_.end(), gone_);
    add(settings_.hold_steps);
    add(1);
    add(100);
    readings_ = warm;
    add(settings_.patience.recover_after_steps + 20);
    add(2, TestVector<Scalar>::stop);
    add(10000);
    readings_ = cold;
    readings_.back() = gone_;
    add(settings_.patience.lost_after_steps + 3, TestVector<Scalar>::start);
  }

  /// A zero of all sensors, a torn copy, and a zero that one sensor is missing from.
  void cycle_power() {
    const std::vector<Scalar> warm = sample(1);
    const std::uint32_t all_good = settings_.patience.recover_after_steps + 20;
    readings_ = warm;
    add(all_good);
    add(settings_.zero.samples + 2, Vector::datum);
    move_to(sample(Scalar(1.5)), 3, 8);
    add(20, Vector::power_cycle);
    add(20, Vector::torn_power_cycle);
    readings_[0] = gone_;
    add(settings_.patience.lost_after_steps + settings_.hold_steps + settings_.zero.samples + 2, Vector::datum);
    readings_ = warm;
    add(all_good);
    add(20, Vector::power_cycle);
    add(settings_.zero.samples + 2, Vector::datum);
    move_to(sample(Scalar(1.5)), 3, 8);
  }

  void lose_periods() {
    const std::uint32_t nearly_all = 4000000000u;  // twice that is more than a counter holds
    const std::vector<Scalar> kept = readings_;
    readings_ = sample(1);
    add(1, Vector::none, 0);
    add(1, Vector::none, 7);
    add(10);
    with(0, gone_, 1, settings_.patience.lost_after_steps);
    add(1, Vector::none, settings_.patience.recover_after_steps);
    add(3);
    std::fill(readings_.begin(), readings_.end(), gone_);
    add(2, Vector::none, nearly_all);
    readings_ = kept;
    add(2, Vector::none, settings_.patience.recover_after_steps);
    add(2, Vector::none, nearly_all);
    for (Scalar& reading : readings_) reading += Scalar(.25);
    add(2, Vector::none, settings_.patience.recover_after_steps);
    add(20);
  }

  void stop_heart() {
    add(3, Vector::none, 1, 1);
    add(settings_.stale_steps - 1);
    add(1, Vector::none, 1, 1);
    add(settings_.stale_steps);
    add(settings_.patience.lost_after_steps);
    add(settings_.patience.recover_after_steps + 20, Vector::none, 1, 1);
    add(30, Vector::stop, 1, 1);
  }

  /// `spread` standard deviations of training beyond the domain's mean, or that far from a cold start, within range.
  std::vector<Scalar> sample(Scalar spread) const {
    std::vector<Scalar> readings(model_.sensors());
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const Scalar low = settings_.sensors[i].lowest_degC, high = settings_.sensors[i].highest_degC;
      const std::size_t input = input_of(i);
      const Scalar mean = model_.domain.mean[input], scale = 1 / model_.domain.inverse_scale[input];
      const Scalar cold = model_.rise ? low + (high - low) / 4 : mean - scale;
      const Scalar way = model_.rise ? mean + std::max(Scalar(0), spread - 1) * scale : (spread + 1) * scale;
      readings[i] = std::round(std::min(high, std::max(low, spread == 0 ? cold : cold + way)) * 64) / 64;
      if (!within(readings[i], low, high)) readings[i] = (low + high) / 2;
    }
    return readings;
  }

  /// The input that is the temperature of sensor i, or its rise.
  std::size_t input_of(std::size_t i) const {
    const auto& channels = model_.features.channels;
    for (std::size_t f = 0; f < channels.size(); ++f)
      if (channels[f].kind == ControllerFeatureKind::rise && channels[f].sensor == i) return f;
    return channels.empty() ? i : 0;
  }

  void add(std::uint32_t repeat, typename Vector::Command command = Vector::none, std::uint32_t periods = 1,
           std::uint32_t beat = 0) {
    if (repeat == 0) return;
    if (command == Vector::start) device_->start();
    if (command == Vector::stop) device_->stop();
    if (command == Vector::datum) device_->take_datum();
    if (command == Vector::power_cycle || command == Vector::torn_power_cycle) {
      auto kept = device_->retained();
      if (command == Vector::torn_power_cycle) kept.digest ^= 1;
      device_.emplace(model_, settings_);
      device_->resume(kept, off_periods);
    }
    for (std::uint32_t n = 0; n < repeat; ++n) device_->step(readings_, {periods, heartbeat_ += beat});
    vectors_.push_back({repeat, command, readings_, device_->offset_um(), device_->status().word, periods, beat});
  }

  void with(std::size_t sensor, Scalar reading, std::uint32_t repeat, std::uint32_t periods = 1) {
    const Scalar kept = readings_[sensor];
    readings_[sensor] = reading;
    add(repeat, Vector::none, periods);
    readings_[sensor] = kept;
  }

  /// In that many steps, each `repeat` times; all but the reading of `resting`.
  void move_to(const std::vector<Scalar>& goal, std::uint32_t steps, std::uint32_t repeat = 1,
               std::size_t resting = std::numeric_limits<std::size_t>::max()) {
    const std::vector<Scalar> from = readings_;
    for (std::uint32_t n = 1; n <= steps; ++n) {
      for (std::size_t i = 0; i < goal.size(); ++i)
        if (i != resting)
          readings_[i] = from[i] + (goal[i] - from[i]) * (static_cast<Scalar>(n) / static_cast<Scalar>(steps));
      add(repeat);
    }
  }

  void lose(std::size_t sensor, Scalar reading) {
    with(sensor, reading, 1);
    add(1);
    with(sensor, reading, settings_.patience.lost_after_steps);
    with(sensor, reading, 10);
    add(settings_.patience.recover_after_steps - 1);
    add(11);
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

  /// The first sensor does not change at all while another still does; then none does.
  void freeze() {
    const std::uint32_t steps = settings_.sensors[0].frozen_steps, all_steps = settings_.patience.all_frozen_steps;
    if (steps == 0 || std::max(steps, all_steps) > 100000 || readings_.size() < 2) return;
    readings_[0] -= Scalar(.25);
    add(steps - steps / 2);
    readings_[1] += Scalar(.25);
    add(steps / 2 + 1);
    add(settings_.patience.lost_after_steps + 5);
    add(all_steps);
    for (Scalar& reading : readings_) reading += Scalar(.25);
    add(settings_.patience.recover_after_steps + 20);
  }

  /// One sensor, then all, are elsewhere when they read again, and later where they were.
  void come_back_elsewhere() {
    const std::uint32_t away = settings_.patience.lost_after_steps + 10, back = settings_.patience.recover_after_steps;
    const std::vector<Scalar> kept = readings_;
    const auto read_again_at = [&](const std::vector<Scalar>& readings) {
      readings_ = readings;
      add(back);
      add(10);
    };
    std::vector<Scalar> elsewhere = kept;
    elsewhere[0] -= 8;
    readings_[0] = gone_;
    add(away);
    read_again_at(elsewhere);
    readings_[0] = gone_;
    add(away);
    read_again_at(kept);
    for (Scalar& reading : elsewhere) reading -= 8;
    std::fill(readings_.begin(), readings_.end(), gone_);
    add(away);
    read_again_at(elsewhere);
    std::fill(readings_.begin(), readings_.end(), gone_);
    add(away);
    read_again_at(kept);
  }

  /// The others leave the training domain while a substitute stands in.
  void leave_domain_without(std::size_t sensor, const std::vector<Scalar>& home) {
    readings_[sensor] = gone_;
    add(settings_.patience.lost_after_steps + 10);
    move_to(sample(7), 12, 4, sensor);
    add(20);
    move_to(home, 12, 4, sensor);
    readings_ = home;
    add(settings_.patience.recover_after_steps + 20);
  }

  const typename Device::Model& model_;
  const typename Device::Settings& settings_;
  std::optional<Device> device_;
  std::uint32_t heartbeat_ = 0;
  std::vector<Scalar> readings_;
  Scalar gone_;
  std::vector<Vector> vectors_;
};

}  // namespace thermfit::cli
