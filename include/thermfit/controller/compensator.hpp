#pragma once

#include "thermfit/controller/compensator_settings.hpp"
#include "thermfit/controller/controller_model.hpp"
#include "thermfit/controller/session.hpp"
#include "thermfit/controller/state_machine.hpp"

namespace thermfit {

/// What a caller knows about one call of Compensator::step().
struct CompensatorCall {
  std::uint32_t periods = 1;    ///< since the call before; 0: none has passed, and nothing moves
  std::uint32_t heartbeat = 0;  ///< changes whenever the readings are new; 0 from the start: there is none
};

/// Temperatures in, offset and status out, once per controller cycle, whatever the sensors do.
///
/// For any input at all the offset is finite, within ± clamp, and moves at most by the slew limit a step.
/// state_machine.hpp is the behaviour, status.hpp the status word. With fixed sizes nothing allocates and nothing
/// throws; model and settings are referred to and must outlive the compensator.
///
/// Corrections are relative to a zero: the thermal state when the work offset was probed (datum.hpp). It is retained
/// over a power cycle, or given by a datum; without one the compensator does nothing and says so, unless the settings
/// let it take its first samples.
///
/// A caller runs `start()` once and `step()` with the newest readings (degC, absolute, in the model's order) at a
/// fixed period; a reading that did not arrive is handed over as NaN.
///
/// A model on derived channels (the method transfer) has `Features` of them and `Lags`; session.hpp is what it
/// remembers besides the zero. With `Probes` (as many as errors) probe() takes measured errors now and then. A model
/// without any of it costs no byte and no cycle for it.
template <class Scalar, int Sensors, int Errors, int Components, int Features = none_or_dynamic(Sensors),
          int Lags = none_or_dynamic(Sensors), int Probes = none_or_dynamic(Sensors)>
class Compensator {
 public:
  static_assert(Sensors != 0 && Errors != 0, "a model has sensors and errors");
  static_assert(Probes == 0 || Probes == Errors, "a probe reads every error, or there is none");
  using Model = ControllerModel<Scalar, Sensors, Errors, Components, Features, Lags>;     ///< the model it runs
  using Settings = CompensatorSettings<Scalar, Sensors, Errors, Features, Lags, Probes>;  ///< how it behaves
  using Temperatures = Row<Scalar, Sensors>;                        ///< one reading a sensor, degC
  using Offsets = Row<Scalar, Errors>;                              ///< one offset an error, um
  using Retained = RetainedDatum<Scalar, Sensors, Features, Lags>;  ///< a zero to keep over a power cycle
  static constexpr std::uint32_t off_unknown = 0xffffffffu;         ///< how long the power was off is not known

  /// Off, offset 0. Faulty settings show in status() and are never started.
  Compensator(const Model& model, const Settings& settings) noexcept : model_(model), settings_(settings) {
    detail::set_size(offset_um_, model.errors());
    detail::set_size(demand_um_, model.errors());
    detail::set_size(values_, model.inputs());
    datum_.reset(model.sensors());
    session_.reset(model);
    probe_.reset(model.errors());
    reset();
    if (!settings_fit()) status_.word = CompensatorStatus::bad_settings_bit;
  }
  Compensator(const Model&&, const Settings&) = delete;
  Compensator(const Model&, const Settings&&) = delete;

  /// Starts from the present offset (0 after power-on), relative to the zero it knows. Without one, and unless the
  /// settings let it take one, it stays at 0 and says no_datum. Returns false, and stays off, when the settings are
  /// faulty.
  bool start() noexcept {
    if (!settings_fit()) return false;
    reset();
    if (model_.rise && !datum_.known() && settings_.zero.policy == ZeroPolicy::first) datum_.request(ZeroSource::first);
    raise(CompensatorEvent::start);
    status_.word = 0;
    tell();
    return true;
  }

  /// Bumpless start where another source already applies `offset_um`; clamped, NaN counts as 0.
  bool start(const Offsets& offset_um) noexcept {
    if (!start()) return false;
    for (std::size_t j = 0; j < offset_um_.size(); ++j)
      offset_um_[j] = clamped(offset_um[j], settings_.outputs[j].clamp_um);
    return true;
  }

  /// Starts relative to the zero of before a power cycle, `off_steps` periods after the last step; as without one when
  /// `retained` is none, torn or another model's: status().zero_source() tells. A model with lags cannot tell where
  /// they are when it is not known how long the power was off: then it takes no zero either.
  bool resume(const Retained& retained, std::uint32_t off_steps = off_unknown) noexcept {
    restore(retained, off_steps);
    return start();
  }

  /// The same where another source already applies `offset_um`.
  bool resume(const Retained& retained, const Offsets& offset_um, std::uint32_t off_steps = off_unknown) noexcept {
    restore(retained, off_steps);
    return start(offset_um);
  }

  /// The operator probes the work offset now: the zero becomes the median of the samples that follow, once they agree,
  /// and the offset 0 there; the intercept drops out. Until then the old zero counts. While off or stopping it forgets
  /// the zero.
  void take_datum() noexcept {
    if (state_ == CompensatorState::off || state_ == CompensatorState::stopping) return datum_.forget();
    datum_.request(ZeroSource::datum);
  }

  /// Ramps to zero and switches off.
  void stop() noexcept {
    raise(CompensatorEvent::stop);
    datum_.abandon();
    status_.word = (status_.word & ~std::uint32_t(15)) | static_cast<std::uint32_t>(state_);
  }

  /// One cycle: `call.periods` periods after the one before.
  CompensatorStatus step(const Temperatures& temperatures_degC, const CompensatorCall& call = {}) noexcept {
    if (state_ == CompensatorState::off) {
      session_.sleep(call.periods);
      status_.word = settings_fit() ? 0 : CompensatorStatus::bad_settings_bit;
      return status_;
    }
    if (call.periods == 0) return status_;
    status_.word = 0;
    guard_.check(temperatures_degC, settings_.sensors, settings_.patience, call.periods, heartbeat_stopped(call));
    session_.look(model_, guard_, settings_.features, call.periods);
    trust_who_agrees();
    session_.settle(model_, guard_, settings_.zero.samples);
    if (datum_.collect(guard_, settings_.sensors, settings_.zero, model_.has_substitute, call.periods,
                       settings_.hold_steps)) {
      session_.take_zero(model_, datum_);
      probe_.drop();
    }
    probe_.age(call.periods);
    CompensatorEvent event = judge();
    held_steps_ = event == CompensatorEvent::no_demand ? counted(held_steps_, call.periods) : 0;
    if (held_steps_ > settings_.hold_steps) event = CompensatorEvent::hold_expired;
    raise(event);
    if (move_offset(call.periods)) raise(CompensatorEvent::at_zero);
    tell();
    return status_;
  }

  /// A probe has measured that error, um, as the model counts it: the whole thermal error since the zero, which is what
  /// is left of it less the offset applied (plus it, where the sign is `error`). What it differs by from the demand of
  /// the last step is added to the demand from the next step on, until the next reading or until it is too old; the
  /// offset goes there at the slew limit. Readings that are no number, too large, or far off the last one without a
  /// second that agrees are refused, as told; a new zero and a start drop what is held.
  template <int Readings = Probes>
  ProbeReading probe(std::size_t error, Scalar measured_um) noexcept {
    static_assert(Readings != 0, "the compensator was made without a probe");
    if (state_ != CompensatorState::tracking && state_ != CompensatorState::substituting)
      return ProbeReading::no_demand;
    return probe_.take(error, measured_um, demand_um_[error], settings_.probe);
  }

  /// The offset of each error after the last step, um; finite and within ± clamp.
  const Offsets& offset_um() const noexcept { return offset_um_; }
  /// The status word of the last step.
  CompensatorStatus status() const noexcept { return status_; }
  /// What it is doing now.
  CompensatorState state() const noexcept { return state_; }

  /// The zero, to be stored over a power cycle whenever it changes; says none where there is none. Only dynamic rows
  /// allocate.
  ///
  /// A model with lags wants it stored now and then besides: where they were when the power went is what counts.
  Retained retained() const {
    Retained kept;
    session_.retain(kept.session());
    datum_.retain(kept, model_.identity);
    return kept;
  }

 private:
  bool settings_fit() const noexcept { return broken_rule(settings_) == nullptr; }

  void restore(const Retained& retained, std::uint32_t off_steps) noexcept {
    session_.reset(model_);
    if (!datum_.restore(retained, model_.identity)) return;
    if (has_lags() && off_steps == off_unknown) return datum_.forget();
    session_.restore(retained.session(), off_steps == off_unknown ? 0 : off_steps);
  }

  bool has_lags() const noexcept {
    if constexpr (Lags != 0) return model_.features.lag_sensor.size() > 0;
    return false;
  }

  void reset() noexcept {
    guard_.reset(model_.sensors());
    probe_.drop();
    domain_.reset(model_.domain);
    held_steps_ = silent_steps_ = 0;
    has_heartbeat_ = false;
  }

  void raise(CompensatorEvent event) noexcept { state_ = next_state(state_, event); }

  /// What every status word ends with.
  void tell() noexcept {
    status_.word |= static_cast<std::uint32_t>(state_) | static_cast<std::uint32_t>(datum_.source()) << 28 |
                    (datum_.pending() ? CompensatorStatus::zero_pending_bit : 0);
  }

  bool heartbeat_stopped(const CompensatorCall& call) noexcept {
    if (!has_heartbeat_ || call.heartbeat != heartbeat_) {
      silent_steps_ = 0;
    } else {
      silent_steps_ = counted(silent_steps_, call.periods);
    }
    has_heartbeat_ = has_heartbeat_ || call.heartbeat != 0;
    heartbeat_ = call.heartbeat;
    return silent_steps_ >= settings_.stale_steps;
  }

  /// Whether the demand is relative to a zero: of models on temperature rise always, of others after a datum.
  bool relative() const noexcept { return model_.rise || datum_.known(); }
  bool has_reference(std::size_t sensor) const noexcept { return !relative() || datum_.known(sensor); }

  /// The readings, relative to the zero or absolute: the equation takes them as the demand is, the training domain as
  /// the model was fitted.
  void take_values(bool from_zero) noexcept {
    if constexpr (Features != 0)
      if (model_.features.channels.size() > 0) return session_.take_values(model_, guard_, datum_, values_);
    for (std::size_t i = 0; i < model_.sensors(); ++i)
      values_[i] = guard_.reading_degC(i) - (from_zero ? datum_.zero_degC()[i] : Scalar(0));
  }

  Scalar predicted(const typename Model::Equation& equation, std::size_t error) const noexcept {
    return relative() && (datum_.through_zero() || !model_.rise) ? equation.change(error, values_)
                                                                 : equation.predict(error, values_);
  }

  /// Lost sensors that read well again are trusted where they agree with the others.
  void trust_who_agrees() noexcept {
    std::uint32_t away = 0;
    bool all_read = true;
    for (std::size_t i = 0; i < model_.sensors(); ++i) {
      away += guard_.fault(i) == SensorFault::none ? 0 : 1;
      all_read = all_read && (guard_.fault(i) == SensorFault::none || guard_.returning(i));
    }
    if (away == 0) return;
    const bool together = all_read && agree_together();
    for (std::size_t i = 0; i < model_.sensors(); ++i) {
      if (!guard_.returning(i)) continue;
      const bool compared = away == 1 && has_reference(i) && model_.has_substitute[i] && model_.agreement_um[i][0] > 0;
      if (compared ? agrees_with_substitute(i) : together || near_where_it_was(i)) guard_.trust(i);
    }
  }

  bool agrees_with_substitute(std::size_t sensor) noexcept {
    take_values(relative());
    for (std::size_t j = 0; j < demand_um_.size(); ++j) {
      const Scalar difference = predicted(model_.equation, j) - predicted(model_.substitutes[sensor], j);
      if (!(magnitude(difference) <= model_.agreement_um[sensor][j])) return false;
    }
    return true;
  }

  /// Several that come back at once agree when the sample as a whole is like those of training.
  bool agree_together() noexcept {
    if (settings_.domain_policy == DomainPolicy::ignore) return false;
    for (std::size_t i = 0; i < model_.sensors(); ++i)
      if (!has_reference(i)) return false;
    take_values(model_.rise);
    return domain_.share_inside(model_.domain, values_) >= 1;
  }

  /// What nothing can vouch for comes back where it was; freely where nothing rests on it yet.
  bool near_where_it_was(std::size_t sensor) const noexcept {
    if (!guard_.trusted_before(sensor) || (model_.rise && !datum_.known())) return true;
    return magnitude(guard_.reading_degC(sensor) - guard_.trusted_degC(sensor)) <= settings_.patience.others_moved_K;
  }

  /// Which sensors can be used, and the demand that follows from them.
  CompensatorEvent judge() noexcept {
    const std::uint32_t unused = count_unused();
    if (model_.rise && !datum_.known())
      return datum_.pending() && state_ != CompensatorState::no_datum ? CompensatorEvent::no_demand
                                                                      : CompensatorEvent::no_zero;
    if (!usable(unused)) return CompensatorEvent::no_demand;
    const bool whole = unused == 0;
    take_values(relative());
    const auto& equation = whole ? model_.equation : model_.substitutes[first_unused_];
    for (std::size_t j = 0; j < demand_um_.size(); ++j) {
      demand_um_[j] = predicted(equation, j);
      if (!is_finite(demand_um_[j])) return CompensatorEvent::no_demand;
    }
    if (!apply_domain(whole)) return CompensatorEvent::no_demand;
    return whole ? CompensatorEvent::demand : CompensatorEvent::substitute_demand;
  }

  /// Counts the sensors that cannot be used and tells of the first in the status.
  std::uint32_t count_unused() noexcept {
    std::uint32_t unused = 0;
    SensorFault first_fault = SensorFault::none;
    for (std::size_t i = 0; i < model_.sensors(); ++i) {
      SensorFault fault = guard_.fault(i);
      if (fault == SensorFault::none && datum_.known() && !has_reference(i)) fault = SensorFault::no_reference;
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
    return guard_.lost(first_unused_) || !has_reference(first_unused_);
  }

  /// Treats a sample outside the domain as the settings say, a missing sensor at what the others let expect; false when
  /// it must not be followed.
  bool apply_domain(bool whole) noexcept {
    if (settings_.domain_policy == DomainPolicy::ignore) return true;
    take_values(model_.rise);
    if (!whole) fill_in(first_unused_);
    const Scalar share = domain_.share_inside(model_.domain, values_);
    if (share >= 1) return true;
    status_.word |= CompensatorStatus::outside_domain_bit;
    if (settings_.domain_policy == DomainPolicy::shrink)
      for (std::size_t j = 0; j < demand_um_.size(); ++j) {
        const Scalar centre = model_.centre_um[j] - left_out(j);
        demand_um_[j] = centre + share * (demand_um_[j] - centre);
      }
    return settings_.domain_policy != DomainPolicy::hold;
  }

  /// What a sensor's inputs should be by the others.
  void fill_in(std::size_t sensor) noexcept {
    if constexpr (Features != 0)
      if (model_.features.channels.size() > 0)
        return domain_.fill_in_all(model_.domain, values_,
                                   [&](std::size_t f) { return model_.features.channels[f].of(sensor); });
    domain_.fill_in(model_.domain, values_, sensor);
  }

  /// What drops out of the prediction where the offset is 0 at the zero.
  Scalar left_out(std::size_t error) const noexcept {
    if constexpr (Features <= 0)
      if (!model_.rise) return datum_.known() ? model_.equation.predict(error, datum_.zero_degC()) : Scalar(0);
    return datum_.through_zero() ? model_.equation.intercept_um[error] : Scalar(0);
  }

  /// Moves every offset towards where the state wants it; true when all of them are zero.
  bool move_offset(std::uint32_t periods) noexcept {
    const OffsetTarget kind = offset_target(state_);
    bool at_zero = true;
    for (std::size_t j = 0; j < offset_um_.size(); ++j) {
      const OutputLimits<Scalar>& limits = settings_.outputs[j];
      Scalar target = kind == OffsetTarget::rest ? offset_um_[j] : Scalar(0);
      if (kind == OffsetTarget::demand) {
        bool probed = false;
        const Scalar demand = probe_.corrected(j, demand_um_[j], settings_.probe, probed);
        const Scalar wanted = settings_.sign == OutputSign::correction ? -demand : demand;
        if (probed) status_.word |= CompensatorStatus::probed_bit;
        target = clamped(wanted, limits.clamp_um);
        if (!(target == wanted)) status_.word |= CompensatorStatus::clamped_bit;
      }
      offset_um_[j] = slewed(offset_um_[j], target, limits.slew_um_per_step * static_cast<Scalar>(periods));
      if (!(offset_um_[j] == target)) status_.word |= CompensatorStatus::slewing_bit;
      at_zero = at_zero && offset_um_[j] == 0;
    }
    return at_zero;
  }

  const Model& model_;
  const Settings& settings_;
  SensorGuard<Scalar, Sensors> guard_;
  Datum<Scalar, Sensors> datum_;
  DomainGuard<Scalar, Model::Inputs, Components> domain_;
  Row<Scalar, Model::Inputs> values_{};
  Offsets demand_um_{}, offset_um_{};
  CompensatorStatus status_;
  std::size_t first_unused_ = 0;
  std::uint32_t held_steps_ = 0, silent_steps_ = 0, heartbeat_ = 0;
  bool has_heartbeat_ = false;
  CompensatorState state_ = CompensatorState::off;
  Session<Scalar, Sensors, Features, Lags> session_;
  ProbeCorrections<Scalar, Probes> probe_;
};

}  // namespace thermfit
