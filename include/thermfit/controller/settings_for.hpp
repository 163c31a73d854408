#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "thermfit/controller/compensator_settings.hpp"
#include "thermfit/controller/narrow_model.hpp"
#include "thermfit/model/probe_level.hpp"

/// Host only: a compensator's settings in the units people think in.

namespace thermfit {

/// Wishes about a compensator. What is left empty follows from the model.
struct CompensationWishes {
  double period_s = 1;                 ///< of the controller cycle that calls step()
  std::optional<double> clamp_um;      ///< default: |mean| + 4 standard deviations of the training errors, rounded up
  double slew_um_per_s = 1;            ///< the slowest of the controls in export cards follows 1 um/s
  double lost_after_s = 5;             ///< bad readings for so long make a sensor lost
  double recover_after_s = 30;         ///< good readings for so long make it trusted again
  double hold_s = 600;                 ///< an offset is held at most so long, then ramps to zero
  double range_margin_K = 20;          ///< readings may lie so far outside those of training
  double rate_factor = 5;              ///< and change so many times faster,
  double rate_floor_K = 1;             ///< plus one step of this size for noise and resolution
  double stuck_factor = 3;             ///< and rest so many times longer; 0: stuck sensors are not looked for
  double others_moved_K = 2;           ///< while the others moved by this on average
  double frozen_factor = 4;            ///< whatever the others do, a sensor that rests so many times longer is frozen,
  double frozen_floor_s = 1800;        ///< plus so long; factor 0: frozen sensors are not looked for
  double stale_s = 5;                  ///< so long without a new heartbeat makes readings stale
  ZeroPolicy zero = ZeroPolicy::wait;  ///< what to do without a zero
  bool through_zero = false;           ///< no intercept: offset 0 at a first zero; after a datum always
  double zero_window_s = 5;            ///< samples of so long, at least three, must agree to become the zero
  double first_margin_K = 5;           ///< a first zero lies at most so far outside the beginnings of training
  double session_s = 4 * 3600;         ///< after a pause of so long a session begins: lags have settled, and its
                                       ///< climate is taken anew
  bool probe = false;                  ///< a probe may correct the demand
  std::optional<double> probe_largest_um;  ///< larger corrections by the probe are refused; default: the clamp
  double probe_jump_deviations = 6;  ///< one so many deviations of training off the last needs a second that agrees
  double probe_age_s = 1e9;          ///< a correction counts so long
  DomainPolicy domain_policy = DomainPolicy::warn;     ///< what to do with a sample unlike those of training
  DomainLimit domain_limit = DomainLimit::percent_99;  ///< which limit tells that it is unlike
  OutputSign sign = OutputSign::correction;            ///< what the offset means to the control
};

namespace detail {

/// Refuses to apply what is no thermal error: the probe's zero in a model of errors as recorded.
inline void refuse_probe_level(const TrainedModel& trained, const CompensationWishes& wishes) {
  const bool rise = trained.reference == TemperatureReference::rise;
  for (Index j = 0; j < trained.model.errors(); ++j) {
    const double level = probe_level_um(trained, j);
    if (level == 0 || (rise && (wishes.zero == ZeroPolicy::wait || wishes.through_zero))) continue;
    throw Error("model of " + trained.errors[static_cast<std::size_t>(j)],
                "it stands at " + std::to_string(std::lround(level)) +
                    " um, far beyond all that it and its temperatures moved in training: a machine coordinate or the "
                    "probe's zero, no thermal error",
                "",
                rise ? "fit with TrainingPlan::error_reference = start, or let it drop out: "
                       "CompensationWishes::through_zero"
                     : "fit temperature rises with TrainingPlan::error_reference = start");
  }
}

inline std::uint32_t steps_in(double time_s, double period_s) {
  return static_cast<std::uint32_t>(std::min(1e9, std::ceil(time_s / period_s - 1e-9)));
}

}  // namespace detail

/// Settings per step from `wishes` and what `trained` knows of its sensors. A model without a sensor envelope gives
/// the range -50…150 degC and no rate or stuck check. Throws Error when the result breaks a rule of
/// CompensatorSettings, naming it, and where a probe's zero (probe_level_um) would be applied; it counts in no clamp.
template <class Scalar, int Sensors = dynamic_size, int Errors = dynamic_size, int Features = none_or_dynamic(Sensors),
          int Lags = none_or_dynamic(Sensors), int Probes = none_or_dynamic(Sensors)>
CompensatorSettings<Scalar, Sensors, Errors, Features, Lags, Probes> settings_for(
    const TrainedModel& trained, const CompensationWishes& wishes = {}) {
  if (!(wishes.period_s > 0)) throw Error("period_s", "not above 0", "the cycle time in seconds");
  detail::refuse_probe_level(trained, wishes);
  CompensatorSettings<Scalar, Sensors, Errors, Features, Lags, Probes> settings;
  const Index sensors =
      trained.features.empty() ? trained.model.sensors() : static_cast<Index>(trained.temperatures.size());
  const SensorEnvelope& known = trained.envelope;
  settings.zero = {wishes.zero,
                   std::min(most_zero_samples, std::max(3u, detail::steps_in(wishes.zero_window_s, wishes.period_s))),
                   wishes.through_zero};
  settings.stale_steps = std::max(1u, detail::steps_in(wishes.stale_s, wishes.period_s));
  std::uint32_t all_frozen_steps = 0;  // together they rest no longer than the liveliest
  detail::fit_size<SensorLimits<Scalar>, Sensors>(settings.sensors, sensors, "sensors");
  for (Index i = 0; i < sensors; ++i) {
    SensorLimits<Scalar>& limits = settings.sensors[static_cast<std::size_t>(i)];
    limits.lowest_degC = static_cast<Scalar>(known.has_range() ? known.lowest_degC(i) - wishes.range_margin_K : -50);
    limits.highest_degC = static_cast<Scalar>(known.has_range() ? known.highest_degC(i) + wishes.range_margin_K : 150);
    limits.largest_step_K = Scalar(1e6);
    // While a zero is taken samples scatter and drift. Too little allowed would wait until a machine moves slowly, and
    // put its zero there: what is not known counts 1 K.
    const double scatter_K = known.has_starts() ? std::max(0.05, known.scatter_K(i)) : 1,
                 drift_K = known.has_rates()
                               ? known.largest_rate_K_per_min(i) / 60 * (settings.zero.samples - 1) * wishes.period_s
                               : 1;
    limits.agree_K = static_cast<Scalar>(scatter_K + drift_K);
    if (known.has_starts()) {
      limits.first_lowest_degC = static_cast<Scalar>(known.first_lowest_degC(i) - wishes.first_margin_K);
      limits.first_highest_degC = static_cast<Scalar>(known.first_highest_degC(i) + wishes.first_margin_K);
    }
    if (!known.has_rates()) continue;
    const double rests_s = 60 * known.longest_still_min(i) * wishes.frozen_factor + wishes.frozen_floor_s;
    limits.frozen_steps = wishes.frozen_factor > 0 ? std::max(2u, detail::steps_in(rests_s, wishes.period_s)) : 0;
    all_frozen_steps = i == 0 ? limits.frozen_steps : std::min(all_frozen_steps, limits.frozen_steps);
    const double per_step_K = known.largest_rate_K_per_min(i) / 60 * wishes.period_s;
    limits.largest_step_K = static_cast<Scalar>(wishes.rate_floor_K + wishes.rate_factor * per_step_K);
    const double still_s = 60 * known.longest_still_min(i) * wishes.stuck_factor;
    limits.stuck_steps = still_s > 0 ? std::max(2u, detail::steps_in(still_s, wishes.period_s)) : 0;
  }
  settings.patience = {std::max(1u, detail::steps_in(wishes.lost_after_s, wishes.period_s)),
                       std::max(1u, detail::steps_in(wishes.recover_after_s, wishes.period_s)),
                       static_cast<Scalar>(wishes.others_moved_K), all_frozen_steps};
  settings.hold_steps = detail::steps_in(wishes.hold_s, wishes.period_s);
  settings.domain_policy = trained.domain.score_variance.size() > 0 ? wishes.domain_policy : DomainPolicy::ignore;
  settings.sign = wishes.sign;
  detail::fit_size<OutputLimits<Scalar>, Errors>(settings.outputs, trained.model.errors(), "errors");
  for (Index j = 0; j < trained.model.errors(); ++j) {
    const double usual_um =
        std::ceil(std::abs(trained.error_mean(j) - probe_level_um(trained, j)) + 4 * trained.error_scale(j));
    settings.outputs[static_cast<std::size_t>(j)] = {static_cast<Scalar>(wishes.clamp_um.value_or(usual_um)),
                                                     static_cast<Scalar>(wishes.slew_um_per_s * wishes.period_s)};
  }
  if constexpr (Features != 0) {
    const auto lags = detail::lags_of(trained);
    detail::fit_size<Scalar, Lags>(settings.features.lag_share, static_cast<Index>(lags.size()), "lags");
    for (std::size_t k = 0; k < lags.size(); ++k)
      settings.features.lag_share[k] = static_cast<Scalar>(-std::expm1(-wishes.period_s / (60 * lags[k].second)));
    settings.features.session_steps = std::max(1u, detail::steps_in(wishes.session_s, wishes.period_s));
  }
  if constexpr (Probes != 0) {
    detail::fit_size<ProbeLimits<Scalar>, Probes>(settings.probe, trained.model.errors(), "errors");
    for (Index j = 0; j < trained.model.errors(); ++j) {
      const double deviation_um = trained.degrees_of_freedom > 0 ? trained.residual_deviation_um(j) : 1e6;
      settings.probe[static_cast<std::size_t>(j)] = {
          wishes.probe_largest_um ? static_cast<Scalar>(*wishes.probe_largest_um)
                                  : settings.outputs[static_cast<std::size_t>(j)].clamp_um,
          static_cast<Scalar>(std::min(1e6, wishes.probe_jump_deviations * deviation_um)),
          static_cast<Scalar>(detail::steps_in(wishes.probe_age_s, wishes.period_s))};
    }
  }
  if (const char* rule = broken_rule(settings)) throw Error("compensator settings", "a broken rule", rule);
  return settings;
}

}  // namespace thermfit
