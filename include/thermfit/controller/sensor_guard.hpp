#pragma once

#include "thermfit/controller/arithmetic.hpp"
#include "thermfit/controller/row.hpp"
#include "thermfit/controller/status.hpp"

namespace thermfit {

/// What a working sensor can do.
template <class Scalar>
struct SensorLimits {
  Scalar lowest_degC = 0;         ///< readings below are no temperatures of this machine
  Scalar highest_degC = 0;        ///< readings above neither
  Scalar largest_step_K = 0;      ///< most it can change from one step to the next; > 0
  std::uint32_t stuck_steps = 0;  ///< so long without any change is suspicious; 0: not checked
};

/// How patient the guard is.
template <class Scalar>
struct GuardPatience {
  std::uint32_t lost_after_steps = 5;      ///< bad readings in a row after which a sensor counts as lost; >= 1
  std::uint32_t recover_after_steps = 30;  ///< good readings in a row after which it is trusted again; >= 1
  Scalar others_moved_K = 1;  ///< how far the others must have moved on average for a sensor to be called stuck
};

/// Judges each reading by itself (finite, range), by its past (rate) and by the others (stuck).
///
/// A rejected reading never touches what is remembered of a sensor. The rate is judged against the last accepted
/// reading with an allowance that grows with the time since: a spike is forgotten at once, and a real change that
/// happened unseen is accepted as soon as it is plausible.
template <class Scalar, int Sensors>
class SensorGuard {
 public:
  /// Forgets everything. `sensors` is the number of sensors; only dynamic rows allocate.
  void reset(std::size_t sensors) {
    detail::set_size(records_, sensors);
    for (Record& record : records_) record = Record{};
  }

  /// Takes one reading of each sensor.
  void check(const Row<Scalar, Sensors>& readings_degC, const Row<SensorLimits<Scalar>, Sensors>& limits,
             const GuardPatience<Scalar>& patience) noexcept {
    Scalar total = 0;
    bool newcomer = false;
    for (std::size_t i = 0; i < records_.size(); ++i) {
      Record& record = records_[i];
      const Scalar reading = readings_degC[i];
      record.fault = judge(reading, record, limits[i]);
      if (record.fault == SensorFault::none) {
        record.still_steps = record.seen && reading == record.reading_degC ? counted(record.still_steps) : 0;
        newcomer = newcomer || !record.seen;
        record.reading_degC = reading;
        record.seen = true;
      }
      total += record.reading_degC;
    }
    const Scalar others_moved = patience.others_moved_K * static_cast<Scalar>(records_.size() - 1);
    for (std::size_t i = 0; i < records_.size(); ++i) {
      Record& record = records_[i];
      const Scalar others = total - record.reading_degC;
      if (newcomer || record.still_steps == 0) {
        record.still_steps = 0;
        record.others_at_change = others;
      } else if (record.fault == SensorFault::none && limits[i].stuck_steps > 0 && records_.size() > 1 &&
                 record.still_steps >= limits[i].stuck_steps &&
                 magnitude(others - record.others_at_change) >= others_moved) {
        record.fault = SensorFault::stuck;
      }
      count_trust(record, patience);
    }
  }

  /// The last accepted reading; finite, 0 where there was none.
  Scalar reading_degC(std::size_t sensor) const noexcept { return records_[sensor].reading_degC; }

  /// Why the sensor is not used in this step; none when it is.
  SensorFault fault(std::size_t sensor) const noexcept { return records_[sensor].fault; }

  /// Whether it has been bad for so long that a substitute should stand in.
  bool lost(std::size_t sensor) const noexcept { return records_[sensor].lost; }

 private:
  struct Record {
    Scalar reading_degC = 0, others_at_change = 0;  // others: sum of the other readings when this one last changed
    std::uint32_t still_steps = 0, bad_steps = 0, good_steps = 0;
    SensorFault fault = SensorFault::none;
    bool seen = false, lost = false;
  };

  static constexpr std::uint32_t most_steps = 1000000000u;
  static constexpr std::uint32_t counted(std::uint32_t steps) noexcept {
    return steps < most_steps ? steps + 1 : steps;
  }

  static SensorFault judge(Scalar reading, const Record& record, const SensorLimits<Scalar>& limits) noexcept {
    if (!is_finite(reading)) return SensorFault::not_finite;
    if (!within(reading, limits.lowest_degC, limits.highest_degC)) return SensorFault::range;
    const Scalar allowed = limits.largest_step_K * static_cast<Scalar>(record.bad_steps + 1);
    if (record.seen && !(magnitude(reading - record.reading_degC) <= allowed)) return SensorFault::rate;
    return SensorFault::none;
  }

  static void count_trust(Record& record, const GuardPatience<Scalar>& patience) noexcept {
    if (record.fault != SensorFault::none) {
      record.good_steps = 0;
      record.bad_steps = counted(record.bad_steps);
      record.lost = record.lost || record.bad_steps >= patience.lost_after_steps;
      return;
    }
    record.bad_steps = 0;
    if (!record.lost) return;
    record.good_steps = counted(record.good_steps);
    record.lost = record.good_steps < patience.recover_after_steps;
    if (record.lost) record.fault = SensorFault::recovering;
  }

  Row<Record, Sensors> records_{};
};

}  // namespace thermfit
