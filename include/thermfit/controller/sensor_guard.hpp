#pragma once

#include "thermfit/controller/arithmetic.hpp"
#include "thermfit/controller/row.hpp"
#include "thermfit/controller/status.hpp"

namespace thermfit {

/// What a working sensor can do.
template <class Scalar>
struct SensorLimits {
  Scalar lowest_degC = 0;           ///< readings below are no temperatures of this machine
  Scalar highest_degC = 0;          ///< readings above neither
  Scalar largest_step_K = 0;        ///< most it can change from one step to the next; > 0
  std::uint32_t stuck_steps = 0;    ///< so long without any change is suspicious while the others move; 0: not checked
  std::uint32_t frozen_steps = 0;   ///< so long without any change is a fault whatever the others do; 0: not checked
  Scalar first_lowest_degC = -1e6;  ///< a machine that is switched on cold reads no less,
  Scalar first_highest_degC = 1e6;  ///< and no more
  Scalar agree_K = 1;               ///< samples of a machine at rest lie within this of each other: noise, resolution
};

/// How patient the guard is.
template <class Scalar>
struct GuardPatience {
  std::uint32_t lost_after_steps = 5;      ///< bad readings in a row after which a sensor counts as lost; >= 1
  std::uint32_t recover_after_steps = 30;  ///< good readings in a row after which it may be trusted again; >= 1
  Scalar others_moved_K = 1;  ///< how far the others must have moved on average for a sensor to be called stuck; a
                              ///< sensor that nothing can vouch for comes back only so near to where it was
  std::uint32_t all_frozen_steps = 0;  ///< so long without a change of any sensor is a fault of all; 0: not checked
};

/// Judges each reading by itself (finite, range), by its past (rate, frozen) and by the others (stuck).
///
/// A rejected reading never touches what is remembered of a sensor. The rate is judged against the last accepted
/// reading with an allowance that grows with the time since: a spike is forgotten at once, and a real change that
/// happened unseen is accepted as soon as it is plausible. A sensor that was lost is trusted again when it has read
/// well for long enough and agrees with the rest.
template <class Scalar, int Sensors>
class SensorGuard {
 public:
  /// Forgets everything. `sensors` is the number of sensors; only dynamic rows allocate.
  void reset(std::size_t sensors) {
    detail::set_size(records_, sensors);
    for (Record& record : records_) record = Record{};
  }

  /// Takes one reading of each sensor, `steps` steps after the one before; `stale` readings are old ones repeated.
  void check(const Row<Scalar, Sensors>& readings_degC, const Row<SensorLimits<Scalar>, Sensors>& limits,
             const GuardPatience<Scalar>& patience, std::uint32_t steps = 1, bool stale = false) noexcept {
    Scalar total = 0;
    bool newcomer = false;
    std::uint32_t all_still = std::numeric_limits<std::uint32_t>::max();
    for (std::size_t i = 0; i < records_.size(); ++i) {
      Record& record = records_[i];
      const Scalar reading = readings_degC[i];
      record.fault = stale ? SensorFault::stale : judge(reading, record, limits[i], steps);
      if (record.fault == SensorFault::none) {
        record.still_steps = record.seen && reading == record.reading_degC ? counted(record.still_steps, steps) : 0;
        newcomer = newcomer || !record.seen;
        record.reading_degC = reading;
        record.seen = true;
        if (record.still_steps < all_still) all_still = record.still_steps;
      }
      total += vouched(record);
    }
    const bool all_frozen = patience.all_frozen_steps > 0 && all_still >= patience.all_frozen_steps;
    const Scalar others_moved = patience.others_moved_K * static_cast<Scalar>(records_.size() - 1);
    for (std::size_t i = 0; i < records_.size(); ++i) {
      Record& record = records_[i];
      const Scalar others = total - vouched(record);
      if (newcomer || record.still_steps == 0) {
        record.still_steps = 0;
        record.others_at_change = others;
      } else if (record.fault == SensorFault::none && (all_frozen || frozen(record, limits[i]) ||
                                                       (records_.size() > 1 && stuck(record, limits[i]) &&
                                                        magnitude(others - record.others_at_change) >= others_moved))) {
        record.fault = SensorFault::stuck;
      }
      count_trust(record, patience, steps);
    }
  }

  /// Whether the sensor was lost and has read well for long enough: who knows the others says whether it agrees.
  bool returning(std::size_t sensor) const noexcept { return records_[sensor].returning; }

  /// Trusts a returning sensor again. What it moved by unseen is no sign that the others should have moved.
  void trust(std::size_t sensor) noexcept {
    Record& record = records_[sensor];
    const Scalar unseen = record.reading_degC - record.trusted_degC;
    for (std::size_t i = 0; i < records_.size(); ++i)
      if (i != sensor) records_[i].others_at_change += unseen;
    record.lost = record.returning = false;
    record.fault = SensorFault::none;
  }

  /// The last accepted reading; finite, 0 where there was none.
  Scalar reading_degC(std::size_t sensor) const noexcept { return records_[sensor].reading_degC; }

  /// The reading when the sensor was last used.
  Scalar trusted_degC(std::size_t sensor) const noexcept { return records_[sensor].trusted_degC; }

  /// Whether the sensor was ever used.
  bool trusted_before(std::size_t sensor) const noexcept { return records_[sensor].trusted; }

  /// Why the sensor is not used in this step; none when it is.
  SensorFault fault(std::size_t sensor) const noexcept { return records_[sensor].fault; }

  /// Whether it has been bad for so long that a substitute should stand in.
  bool lost(std::size_t sensor) const noexcept { return records_[sensor].lost; }

 private:
  struct Record {
    Scalar reading_degC = 0, others_at_change = 0;  // others: sum of the other readings when this one last changed
    Scalar trusted_degC = 0;
    std::uint32_t still_steps = 0, bad_steps = 0, good_steps = 0;
    SensorFault fault = SensorFault::none;
    bool seen = false, lost = false, returning = false, trusted = false;
  };

  static SensorFault judge(Scalar reading, const Record& record, const SensorLimits<Scalar>& limits,
                           std::uint32_t steps) noexcept {
    if (!is_finite(reading)) return SensorFault::not_finite;
    if (!within(reading, limits.lowest_degC, limits.highest_degC)) return SensorFault::range;
    const Scalar allowed = limits.largest_step_K * static_cast<Scalar>(counted(record.bad_steps, steps));
    if (record.seen && !(magnitude(reading - record.reading_degC) <= allowed)) return SensorFault::rate;
    return SensorFault::none;
  }

  /// What a sensor tells about whether the others should have moved: of one that is lost, only what was trusted.
  static Scalar vouched(const Record& record) noexcept {
    return record.lost ? record.trusted_degC : record.reading_degC;
  }

  static bool frozen(const Record& record, const SensorLimits<Scalar>& limits) noexcept {
    return limits.frozen_steps > 0 && record.still_steps >= limits.frozen_steps;
  }

  static bool stuck(const Record& record, const SensorLimits<Scalar>& limits) noexcept {
    return limits.stuck_steps > 0 && record.still_steps >= limits.stuck_steps;
  }

  static void count_trust(Record& record, const GuardPatience<Scalar>& patience, std::uint32_t steps) noexcept {
    record.returning = false;
    if (record.fault != SensorFault::none) {
      record.good_steps = 0;
      record.bad_steps = counted(record.bad_steps, steps);
      record.lost = record.lost || record.bad_steps >= patience.lost_after_steps;
      return;
    }
    record.bad_steps = 0;
    if (!record.lost) {
      record.trusted_degC = record.reading_degC;
      record.trusted = true;
      return;
    }
    record.good_steps = counted(record.good_steps, steps);
    record.returning = record.good_steps >= patience.recover_after_steps;
    record.fault = record.returning ? SensorFault::disagrees : SensorFault::recovering;
  }

  Row<Record, Sensors> records_{};
};

}  // namespace thermfit
