#pragma once

#include "thermfit/controller/retained_datum.hpp"
#include "thermfit/controller/sensor_guard.hpp"

namespace thermfit {

/// Whether a compensator that knows no zero may take one by itself.
enum class ZeroPolicy : std::uint8_t {
  wait,  ///< no: it waits for a datum, or starts with a retained zero
  first  ///< yes, from its first samples: for machines that are always switched on cold
};

/// How a zero is taken.
struct ZeroRule {
  ZeroPolicy policy = ZeroPolicy::wait;  ///< what happens without a zero
  std::uint32_t samples = 5;             ///< good ones in a row that must agree; 3 to most_zero_samples
  bool through_zero = false;             ///< a first zero lets the intercept drop out too, as a datum always does
};
/// The most samples a zero is taken from.
constexpr std::uint32_t most_zero_samples = 9;

/// The thermal state that corrections are relative to: the readings at the moment the work offset was probed.
///
/// A zero is the median of several good samples in a row that agree with each other, never a single one. All sensors
/// get theirs at the same time; one that is lost then, and has a substitute, has none until the next.
template <class Scalar, int Sensors>
class Datum {
 public:
  using Zero = Row<Scalar, Sensors>;                  ///< one reading a sensor, degC
  using Limits = Row<SensorLimits<Scalar>, Sensors>;  ///< what first readings look like, and how well samples agree
  using Guard = SensorGuard<Scalar, Sensors>;         ///< whose readings are taken

  /// No zero, none asked for. Only dynamic rows allocate.
  void reset(std::size_t sensors) {
    detail::set_size(zero_degC_, sensors);
    detail::set_size(known_, sensors);
    detail::set_size(window_, sensors);
    detail::set_size(counted_, sensors);
    forget();
  }

  /// No zero, none asked for.
  void forget() noexcept {
    for (std::size_t i = 0; i < known_.size(); ++i) {
      zero_degC_[i] = 0;
      known_[i] = false;
    }
    source_ = wanted_ = ZeroSource::none;
    through_zero_ = false;
  }

  /// The zero of before a power cycle; none when `retained` is torn, or another model's. Returns whether there is one.
  template <class Retained>
  bool restore(const Retained& retained, std::uint32_t model) noexcept {
    forget();
    if (!retained.valid(model)) return false;
    for (std::size_t i = 0; i < known_.size(); ++i) {
      known_[i] = is_finite(retained.zero_degC[i]);
      zero_degC_[i] = known_[i] ? retained.zero_degC[i] : Scalar(0);
    }
    through_zero_ = retained.through_zero != 0;
    source_ = ZeroSource::retained;
    return true;
  }

  /// What to keep over a power cycle, for the model of that identity, into what is kept of the session; says "none"
  /// where there is no zero.
  template <class Retained>
  void retain(Retained& kept, std::uint32_t model) const {
    kept.zero_degC = zero_degC_;
    for (std::size_t i = 0; i < known_.size(); ++i)
      if (!known_[i]) kept.zero_degC[i] = std::numeric_limits<Scalar>::quiet_NaN();
    kept.through_zero = through_zero_ ? 1 : 0;
    if (source_ != ZeroSource::none) kept.seal(model);
  }

  /// Asks for a zero from the samples that follow; until it is there, the old one counts.
  void request(ZeroSource source) noexcept {
    wanted_ = source;
    taken_ = 0;
    waited_steps_ = 0;
  }

  /// Takes back what was asked for. A datum that was not taken leaves no zero: the old one is not true any more.
  void abandon() noexcept {
    if (wanted_ == ZeroSource::datum) forget();
    wanted_ = ZeroSource::none;
  }

  /// Offers one more sample to the zero that was asked for. A sensor that is lost is waited for as long as
  /// `patience_steps`, then left out where `substitutes` has one for it and no other is missing. One that has returned
  /// need not agree with the others: with a new zero it begins anew, and is trusted. Returns whether it was taken.
  bool collect(Guard& guard, const Limits& limits, const ZeroRule& rule, const Row<bool, Sensors>& substitutes,
               std::uint32_t steps, std::uint32_t patience_steps) noexcept {
    if (wanted_ == ZeroSource::none) return false;
    waited_steps_ = counted(waited_steps_, steps);
    std::uint32_t missing = 0;
    bool same = true;
    for (std::size_t i = 0; i < known_.size(); ++i) {
      const bool good =
          (guard.fault(i) == SensorFault::none || guard.returning(i)) && fits(guard.reading_degC(i), limits[i]);
      const bool spared = guard.lost(i) && substitutes[i] && waited_steps_ > patience_steps;
      if (!good && !spared) {
        taken_ = 0;
        return false;
      }
      missing += good ? 0 : 1;
      same = same && counted_[i] == good;
      counted_[i] = good;
    }
    if (missing > 1 || !same) taken_ = 0;
    if (missing > 1) return false;
    for (std::size_t i = 0; i < known_.size(); ++i) window_[i][taken_ % rule.samples] = guard.reading_degC(i);
    taken_ = taken_ + 1 < 2 * rule.samples ? taken_ + 1 : rule.samples;
    if (taken_ < rule.samples || !agreed(limits, rule.samples)) return false;
    take(rule);
    for (std::size_t i = 0; i < known_.size(); ++i)
      if (counted_[i] && guard.returning(i)) guard.trust(i);
    return true;
  }

  /// Whether there is a zero.
  bool known() const noexcept { return source_ != ZeroSource::none; }
  /// Whether that sensor has one.
  bool known(std::size_t sensor) const noexcept { return known_[sensor]; }
  /// Whether one was asked for and is not there yet.
  bool pending() const noexcept { return wanted_ != ZeroSource::none; }
  /// Where it comes from.
  ZeroSource source() const noexcept { return source_; }
  /// Whether the intercept drops out, so that the offset is 0 at the zero.
  bool through_zero() const noexcept { return through_zero_; }
  /// The zero of each sensor, degC; 0 where there is none.
  const Zero& zero_degC() const noexcept { return zero_degC_; }

 private:
  using Window = std::array<Scalar, most_zero_samples>;

  /// A datum may be taken in any thermal state; who takes the first readings for a cold start checks that it is one.
  bool fits(Scalar reading, const SensorLimits<Scalar>& limits) const noexcept {
    return wanted_ != ZeroSource::first || within(reading, limits.first_lowest_degC, limits.first_highest_degC);
  }

  bool agreed(const Limits& limits, std::uint32_t samples) const noexcept {
    for (std::size_t i = 0; i < window_.size(); ++i) {
      Scalar lowest = window_[i][0], highest = window_[i][0];
      for (std::uint32_t k = 1; k < samples; ++k) {
        if (window_[i][k] < lowest) lowest = window_[i][k];
        if (window_[i][k] > highest) highest = window_[i][k];
      }
      if (counted_[i] && !(highest - lowest <= limits[i].agree_K)) return false;
    }
    return true;
  }

  void take(const ZeroRule& rule) noexcept {
    for (std::size_t i = 0; i < window_.size(); ++i) {
      known_[i] = counted_[i];
      zero_degC_[i] = counted_[i] ? median(window_[i], rule.samples) : Scalar(0);
    }
    through_zero_ = rule.through_zero || wanted_ == ZeroSource::datum;
    source_ = wanted_;
    wanted_ = ZeroSource::none;
  }

  static Scalar median(Window sorted, std::uint32_t samples) noexcept {
    for (std::uint32_t k = 1; k < samples; ++k)
      for (std::uint32_t m = k; m > 0 && sorted[m] < sorted[m - 1]; --m) {
        const Scalar higher = sorted[m - 1];
        sorted[m - 1] = sorted[m];
        sorted[m] = higher;
      }
    return sorted[samples / 2];
  }

  Zero zero_degC_{};
  Row<bool, Sensors> known_{};
  Row<Window, Sensors> window_{};  ///< the samples offered last
  Row<bool, Sensors> counted_{};   ///< the sensors they hold
  std::uint32_t taken_ = 0, waited_steps_ = 0;
  ZeroSource source_ = ZeroSource::none, wanted_ = ZeroSource::none;
  bool through_zero_ = false;
};

}  // namespace thermfit
