#pragma once

#include "thermfit/controller/datum.hpp"
#include "thermfit/controller/domain_guard.hpp"
#include "thermfit/controller/probe_corrections.hpp"
#include "thermfit/controller/slew_limit.hpp"

namespace thermfit {

/// What the offset means. Controls differ, and a wrong sign doubles the error: it is written out everywhere.
enum class OutputSign : std::int8_t {
  error = 1,       ///< offset = predicted thermal error
  correction = -1  ///< offset = minus the predicted error: what is added to the axis command
};

/// How a compensator behaves. Everything is per step, since a controller counts cycles; settings_for.hpp makes these
/// from seconds and micrometres per second.
template <class Scalar, int Sensors, int Errors, int Features = none_or_dynamic(Sensors),
          int Lags = none_or_dynamic(Sensors), int Probes = none_or_dynamic(Sensors)>
struct CompensatorSettings {
  Row<SensorLimits<Scalar>, Sensors> sensors{};  ///< range, rate and stuck check of each sensor
  GuardPatience<Scalar> patience{};              ///< when a sensor is lost and when it is trusted again
  std::uint32_t hold_steps = 600;  ///< steps an offset may be held before it ramps to zero; 0: ramps at once
  DomainPolicy domain_policy = DomainPolicy::warn;  ///< what to do with a sample unlike those of training
  FeatureRule<Scalar, Features, Lags> features{};   ///< how lags go on; empty without
  Row<ProbeLimits<Scalar>, Probes> probe{};         ///< of each error's probe, in um and steps; empty without
  Row<OutputLimits<Scalar>, Errors> outputs{};      ///< clamp and slew of each axis
  OutputSign sign = OutputSign::correction;         ///< what the offset means to the control
  ZeroRule zero{};                                  ///< where the zero comes from
  std::uint32_t stale_steps = 5;  ///< steps without a new heartbeat after which readings are stale; >= 1
};

/// Text of the first rule that `settings` break, or nullptr. A compensator refuses to start with broken settings.
template <class Scalar, int Sensors, int Errors, int Features, int Lags, int Probes>
constexpr const char* broken_rule(
    const CompensatorSettings<Scalar, Sensors, Errors, Features, Lags, Probes>& settings) noexcept {
  constexpr Scalar most = Scalar(1e6);  // so that no product in the guard overflows, not even in float
  for (const SensorLimits<Scalar>& sensor : settings.sensors) {
    if (!within(sensor.lowest_degC, -most, most) || !within(sensor.highest_degC, -most, most))
      return "sensors: lowest_degC and highest_degC lie within -1e6 to 1e6";
    if (!(sensor.lowest_degC < sensor.highest_degC)) return "sensors: lowest_degC is below highest_degC";
    if (!(sensor.largest_step_K > 0 && sensor.largest_step_K <= most))
      return "sensors: largest_step_K is above 0 and at most 1e6";
    if (!(sensor.first_lowest_degC < sensor.first_highest_degC))
      return "sensors: first_lowest_degC is below first_highest_degC";
    if (!(sensor.agree_K > 0 && sensor.agree_K <= most)) return "sensors: agree_K is above 0 and at most 1e6";
  }
  const GuardPatience<Scalar>& patience = settings.patience;
  if (patience.lost_after_steps < 1 || patience.recover_after_steps < 1)
    return "patience: lost_after_steps and recover_after_steps are at least 1";
  if (!(patience.others_moved_K > 0 && patience.others_moved_K <= most))
    return "patience: others_moved_K is above 0 and at most 1e6";
  for (const OutputLimits<Scalar>& output : settings.outputs) {
    if (!(output.clamp_um > 0 && output.clamp_um <= most)) return "outputs: clamp_um is above 0 and at most 1e6";
    if (!(output.slew_um_per_step > 0 && output.slew_um_per_step <= most))
      return "outputs: slew_um_per_step is above 0 and at most 1e6";
    if (!(output.clamp_um - output.slew_um_per_step < output.clamp_um))
      return "outputs: slew_um_per_step is not lost in the rounding of clamp_um";
  }
  if constexpr (Features != 0) {
    for (const Scalar share : settings.features.lag_share)
      if (!(share > 0 && share <= 1)) return "features: lag_share is above 0 and at most 1";
    if (settings.features.session_steps < 1) return "features: session_steps is at least 1";
  }
  for (const ProbeLimits<Scalar>& probe : settings.probe)
    if (!(probe.largest_um >= 0 && probe.jump_um >= 0 && probe.longest_s >= 0))
      return "probe: largest_um, jump_um and longest_s are 0 or more";
  if (settings.domain_policy > DomainPolicy::hold) return "domain_policy is one of ignore, warn, shrink, hold";
  if (settings.sign != OutputSign::error && settings.sign != OutputSign::correction)
    return "sign is error or correction";
  if (settings.zero.policy > ZeroPolicy::first) return "zero.policy is wait or first";
  if (settings.zero.samples < 3 || settings.zero.samples > most_zero_samples) return "zero.samples is 3 to 9";
  if (settings.stale_steps < 1) return "stale_steps is at least 1";
  return nullptr;
}

}  // namespace thermfit
