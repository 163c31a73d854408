#pragma once

#include <cmath>
#include <limits>

namespace thermfit {

/// What a probe's reading is judged by before it corrects a model.
template <typename Scalar = double>
struct ProbeLimits {
  Scalar largest_um = std::numeric_limits<Scalar>::infinity();  ///< a correction beyond is refused
  Scalar jump_um = std::numeric_limits<Scalar>::infinity();     ///< one further off the last needs a second that agrees
  Scalar longest_s = std::numeric_limits<Scalar>::infinity();   ///< an older one no longer counts
};

/// What became of a reading.
enum class ProbeReading {
  taken,           ///< it is the correction from now on
  no_number,       ///< not finite
  too_large,       ///< beyond the largest correction
  to_be_repeated,  ///< too far off the last one; taken when the next agrees with it
  no_demand        ///< nothing is predicted that it could be compared with
};

/// What a model misses, measured now and then and held until the next reading: a measured error less the predicted one
/// is added to what the model predicts from then on. Neither allocates nor throws: controller code.
template <typename Scalar = double>
class HeldCorrection {
 public:
  /// Judges `measured - predicted` (um) at `now_s`.
  ProbeReading take(Scalar measured_um, Scalar predicted_um, Scalar now_s, const ProbeLimits<Scalar>& limits) noexcept {
    const Scalar missed = measured_um - predicted_um;
    if (!std::isfinite(missed)) return ProbeReading::no_number;
    if (std::abs(missed) > limits.largest_um) return ProbeReading::too_large;
    const bool agrees = waiting_ && std::abs(missed - waiting_um_) <= limits.jump_um;
    if (!agrees && std::abs(missed - held_um_) > limits.jump_um) {
      waiting_ = true;
      waiting_um_ = missed;
      return ProbeReading::to_be_repeated;
    }
    waiting_ = false;
    held_um_ = missed;
    since_s_ = now_s;
    return ProbeReading::taken;
  }

  /// What is added to a prediction at `now_s`, um: 0 before the first reading and when the last is too old.
  Scalar value(Scalar now_s, const ProbeLimits<Scalar>& limits) const noexcept {
    return now_s - since_s_ <= limits.longest_s ? held_um_ : Scalar(0);
  }

 private:
  Scalar held_um_ = 0, since_s_ = 0, waiting_um_ = 0;
  bool waiting_ = false;
};

}  // namespace thermfit
