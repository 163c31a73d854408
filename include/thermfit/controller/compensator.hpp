#pragma once

#include "thermfit/controller/compensator_settings.hpp"
#include "thermfit/controller/controller_model.hpp"
#include "thermfit/controller/rise_reference.hpp"
#include "thermfit/controller/state_machine.hpp"

namespace thermfit {

/// Temperatures in, offset and status out, once per controller cycle, whatever the sensors do.
///
/// For any input at all the offset is finite, within ± clamp, and moves at most by the slew limit a step.
/// state_machine.hpp is the behaviour, status.hpp the status word. With fixed sizes nothing allocates and nothing
/// throws; model and settings are referred to and must outlive the compensator.
///
/// A caller runs `start()` once and `step()` with the newest readings (degC, absolute, in the model's order) at a
/// fixed period; a reading that did not arrive is handed over as NaN.
template <class Scalar, int Sensors, int Errors, int Components>
class Compensator {
 public:
  static_assert(Sensors != 0 && Errors != 0, "a model has sensors and errors");
  using Model = ControllerModel<Scalar, Sensors, Errors, Components>;  ///< the model it runs
  using Settings = CompensatorSettings<Scalar, Sensors, Errors>;       ///< how it behaves
  using Temperatures = Row<Scalar, Sensors>;                           ///< one reading a sensor, degC
  using Offsets = Row<Scalar, Errors>;                                 ///< one offset an error, um

  /// Off, offset 0. Faulty settings show in status() and are never started.
  Compensator(const Model& model, const Settings& settings) noexcept : model_(model), settings_(settings) {
    detail::set_size(offset_um_, model.errors());
    detail::set_size(demand_um_, model.errors());
    detail::set_size(values_, model.sensors());
    reset();
    if (!settings_fit()) status_.word = CompensatorStatus::bad_settings_bit;
  }
  Compensator(const Model&&, const Settings&) = delete;
  Compensator(const Model&, const Settings&&) = delete;

  /// Starts from the present offset (0 after power-on). The zero of the temperature rise is the first usable sample.
  /// Returns false, and stays off, when the settings are faulty.
  bool start() noexcept {
    if (!settings_fit()) return false;
    reset();
    raise(CompensatorEvent::start);
    status_.word = static_cast<std::uint32_t>(state_);
    return true;
  }

  /// Bumpless start where another source already applies `offset_um`; clamped, NaN counts as 0.
  bool start(const Offsets& offset_um) noexcept {
    if (!start()) return false;
    for (std::size_t j = 0; j < offset_um_.size(); ++j)
      offset_um_[j] = clamped(offset_um[j], settings_.outputs[j].clamp_um);
    return true;
  }

  /// The same on a machine that is still warm, with the zero of the temperature rise kept from before.
  bool start(const Offsets& offset_um, const Temperatures& zero_degC) noexcept {
    if (!start(offset_um)) return false;
    if (model_.rise) reference_.restore(zero_degC);
    return true;
  }

  /// Ramps to zero and switches off.
  void stop() noexcept {
    raise(CompensatorEvent::stop);
    status_.word = (status_.word & ~std::uint32_t(15)) | static_cast<std::uint32_t>(state_);
  }

  /// One cycle.
  CompensatorStatus step(const Temperatures& temperatures_degC) noexcept {
    status_.word = 0;
    if (state_ == CompensatorState::off) {
      if (!settings_fit()) status_.word = CompensatorStatus::bad_settings_bit;
      return status_;
    }
    guard_.check(temperatures_degC, settings_.sensors, settings_.patience);
    CompensatorEvent event = judge();
    if (event == CompensatorEvent::no_demand) {
      if (held_steps_ >= settings_.hold_steps) event = CompensatorEvent::hold_expired;
      if (held_steps_ < settings_.hold_steps) ++held_steps_;
    } else {
      held_steps_ = 0;
    }
    raise(event);
    if (move_offset()) raise(CompensatorEvent::at_zero);
    status_.word |= static_cast<std::uint32_t>(state_);
    return status_;
  }

  /// The offset of each error after the last step, um; finite and within ± clamp.
  const Offsets& offset_um() const noexcept { return offset_um_; }
  /// The status word of the last step.
  CompensatorStatus status() const noexcept { return status_; }
  /// What it is doing now.
  CompensatorState state() const noexcept { return state_; }

  /// The zero of the temperature rise, to be kept over a power cycle; 0 where there is none.
  const Temperatures& zero_degC() const noexcept { return reference_.zero_degC(); }

 private:
  bool settings_fit() const noexcept { return broken_rule(settings_) == nullptr; }

  void reset() noexcept {
    guard_.reset(model_.sensors());
    reference_.reset(model_.sensors(), model_.rise);
    domain_.reset(model_.domain);
    held_steps_ = 0;
  }

  void raise(CompensatorEvent event) noexcept { state_ = next_state(state_, event); }

  /// Which sensors can be used, and the demand that follows from them.
  CompensatorEvent judge() noexcept {
    std::uint32_t unused = count_unused();
    if (!reference_.captured()) {
      if (!usable(unused)) return CompensatorEvent::no_demand;
      reference_.capture(guard_);
      unused = count_unused();
    }
    if (!usable(unused)) return CompensatorEvent::no_demand;
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = guard_.reading_degC(i) - reference_.zero_degC()[i];
    const bool whole = unused == 0;
    const auto& equation = whole ? model_.equation : model_.substitutes[first_unused_];
    for (std::size_t j = 0; j < demand_um_.size(); ++j) {
      demand_um_[j] = equation.predict(j, values_);
      if (!is_finite(demand_um_[j])) return CompensatorEvent::no_demand;
    }
    if (!whole) return CompensatorEvent::substitute_demand;
    return apply_domain() ? CompensatorEvent::demand : CompensatorEvent::no_demand;
  }

  /// Counts the sensors that cannot be used and tells of the first in the status.
  std::uint32_t count_unused() noexcept {
    std::uint32_t unused = 0;
    SensorFault first_fault = SensorFault::none;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      SensorFault fault = guard_.fault(i);
      if (fault == SensorFault::none && reference_.captured() && !reference_.known(i))
        fault = SensorFault::no_reference;
      if (fault == SensorFault::none) continue;
      if (unused++ > 0) continue;
      first_unused_ = i;
      first_fault = fault;
    }
    if (unused > 0)
      status_.word = CompensatorStatus::sensor_bits(static_cast<std::uint32_t>(first_unused_ + 1), first_fault, unused);
    return unused;
  }

  /// No sensor missing, or one that is gone for good and has a substitute.
  bool usable(std::uint32_t unused) const noexcept {
    if (unused == 0) return true;
    if (unused > 1 || !model_.has_substitute[first_unused_]) return false;
    return guard_.lost(first_unused_) || (reference_.captured() && !reference_.known(first_unused_));
  }

  /// Treats a sample outside the domain as the settings say; false when it must not be followed.
  bool apply_domain() noexcept {
    if (settings_.domain_policy == DomainPolicy::ignore) return true;
    const Scalar share = domain_.share_inside(model_.domain, values_);
    if (share >= 1) return true;
    status_.word |= CompensatorStatus::outside_domain_bit;
    if (settings_.domain_policy == DomainPolicy::shrink)
      for (std::size_t j = 0; j < demand_um_.size(); ++j)
        demand_um_[j] = model_.centre_um[j] + share * (demand_um_[j] - model_.centre_um[j]);
    return settings_.domain_policy != DomainPolicy::hold;
  }

  /// Moves every offset one step towards where the state wants it; true when all of them are zero.
  bool move_offset() noexcept {
    const OffsetTarget kind = offset_target(state_);
    bool at_zero = true;
    for (std::size_t j = 0; j < offset_um_.size(); ++j) {
      const OutputLimits<Scalar>& limits = settings_.outputs[j];
      Scalar target = kind == OffsetTarget::rest ? offset_um_[j] : Scalar(0);
      if (kind == OffsetTarget::demand) {
        const Scalar wanted = settings_.sign == OutputSign::correction ? -demand_um_[j] : demand_um_[j];
        target = clamped(wanted, limits.clamp_um);
        if (!(target == wanted)) status_.word |= CompensatorStatus::clamped_bit;
      }
      offset_um_[j] = slewed(offset_um_[j], target, limits.slew_um_per_step);
      if (!(offset_um_[j] == target)) status_.word |= CompensatorStatus::slewing_bit;
      at_zero = at_zero && offset_um_[j] == 0;
    }
    return at_zero;
  }

  const Model& model_;
  const Settings& settings_;
  SensorGuard<Scalar, Sensors> guard_;
  RiseReference<Scalar, Sensors> reference_;
  DomainGuard<Scalar, Sensors, Components> domain_;
  Temperatures values_{};
  Offsets demand_um_{}, offset_um_{};
  CompensatorStatus status_;
  std::size_t first_unused_ = 0;
  std::uint32_t held_steps_ = 0;
  CompensatorState state_ = CompensatorState::off;
};

}  // namespace thermfit
