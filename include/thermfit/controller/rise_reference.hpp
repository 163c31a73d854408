#pragma once

#include "thermfit/controller/sensor_guard.hpp"

namespace thermfit {

/// What temperature rise counts from: the readings of one moment, the first at which the model can be used.
/// All sensors get their zero at the same time; one that is lost then has none until the next start.
template <class Scalar, int Sensors>
class RiseReference {
 public:
  /// Forgets the zero; absolute temperatures count from 0 degC and need none. Only dynamic rows allocate.
  void reset(std::size_t sensors, bool rise) {
    detail::set_size(zero_degC_, sensors);
    detail::set_size(known_, sensors);
    for (std::size_t i = 0; i < sensors; ++i) {
      zero_degC_[i] = 0;
      known_[i] = !rise;
    }
    captured_ = !rise;
  }

  /// A zero kept from before a power cycle. Values that are not finite leave that sensor without one.
  void restore(const Row<Scalar, Sensors>& zero_degC) noexcept {
    for (std::size_t i = 0; i < known_.size(); ++i) {
      known_[i] = is_finite(zero_degC[i]);
      zero_degC_[i] = known_[i] ? zero_degC[i] : Scalar(0);
    }
    captured_ = true;
  }

  /// Takes the zero from the present readings of the sensors that are not lost, unless it was taken.
  void capture(const SensorGuard<Scalar, Sensors>& guard) noexcept {
    if (captured_) return;
    for (std::size_t i = 0; i < known_.size(); ++i) {
      known_[i] = guard.fault(i) == SensorFault::none;
      zero_degC_[i] = known_[i] ? guard.reading_degC(i) : Scalar(0);
    }
    captured_ = true;
  }

  /// Whether the zero has been taken, restored or is not needed.
  bool captured() const noexcept { return captured_; }
  /// Whether that sensor has a zero.
  bool known(std::size_t sensor) const noexcept { return known_[sensor]; }
  /// The zero of each sensor, degC; 0 where there is none.
  const Row<Scalar, Sensors>& zero_degC() const noexcept { return zero_degC_; }

 private:
  Row<Scalar, Sensors> zero_degC_{};
  Row<bool, Sensors> known_{};
  bool captured_ = false;
};

}  // namespace thermfit
