#pragma once

#include "thermfit/controller/arithmetic.hpp"
#include "thermfit/controller/row.hpp"
#include "thermfit/model/held_correction.hpp"

namespace thermfit {

/// What a probe has found to be missing in each error's demand, held until the next reading. Times are steps; with
/// `Probes` 0 there is no probe and nothing is kept.
template <class Scalar, int Probes>
class ProbeCorrections {
 public:
  using Limits = Row<ProbeLimits<Scalar>, Probes>;  ///< what readings of each error are judged by

  /// No reading yet. Only dynamic rows allocate.
  void reset(std::size_t errors) {
    detail::set_size(held_, errors);
    drop();
  }

  /// None any more: what readings were relative to has changed.
  void drop() noexcept {
    for (One& one : held_) one = One{};
  }

  /// So many steps pass.
  void age(std::uint32_t steps) noexcept {
    for (One& one : held_) one.age_steps = counted(one.age_steps, steps);
  }

  /// Judges a reading of that error against what was demanded when it was taken, um.
  ProbeReading take(std::size_t error, Scalar measured_um, Scalar demand_um, const Limits& limits) noexcept {
    One& one = held_[error];
    const ProbeReading result = one.correction.take(measured_um, demand_um, Scalar(0), limits[error]);
    if (result != ProbeReading::taken) return result;
    one.age_steps = 0;
    one.taken = true;
    return result;
  }

  /// `demand_um` with what the probe has found; `used` becomes true where that counts.
  Scalar corrected(std::size_t error, Scalar demand_um, const Limits& limits, bool& used) const noexcept {
    const One& one = held_[error];
    if (!one.taken || !(static_cast<Scalar>(one.age_steps) <= limits[error].longest_s)) return demand_um;
    used = true;
    return demand_um + one.correction.value(static_cast<Scalar>(one.age_steps), limits[error]);
  }

 private:
  struct One {
    HeldCorrection<Scalar> correction{};
    std::uint32_t age_steps = 0;
    bool taken = false;
  };
  Row<One, Probes> held_{};
};

/// Without a probe nothing is corrected.
template <class Scalar>
class ProbeCorrections<Scalar, 0> {
 public:
  using Limits = Row<ProbeLimits<Scalar>, 0>;  ///< none
  /// Nothing.
  void reset(std::size_t) noexcept {}
  /// Nothing.
  void drop() noexcept {}
  /// Nothing.
  void age(std::uint32_t) noexcept {}
  /// `demand_um`.
  constexpr Scalar corrected(std::size_t, Scalar demand_um, const Limits&, bool&) const noexcept { return demand_um; }
};

}  // namespace thermfit
