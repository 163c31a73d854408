#pragma once

#include <limits>

#include "thermfit/controller/arithmetic.hpp"
#include "thermfit/controller/controller_feature.hpp"
#include "thermfit/controller/status.hpp"

namespace thermfit {

/// What survives a power cycle of a session: plain data; nothing of a model without features.
template <class Scalar, int Features, int Lags>
struct RetainedSession {
  Row<Scalar, Lags> lag_degC{};       ///< where each lag was; NaN: not known
  Row<Scalar, Lags> lag_zero_degC{};  ///< and where at the zero
  Scalar climate_degC =
      std::numeric_limits<Scalar>::quiet_NaN();  ///< mean temperature where the session began; NaN: there is none

  /// Calls `see` with each number; of a model whose features are none, as a dynamic one may have, with none.
  template <class See>
  void each(See see) const noexcept {
    if (lag_degC.empty() && !is_finite(climate_degC)) return;
    for (const Scalar value : lag_degC) see(value);
    for (const Scalar value : lag_zero_degC) see(value);
    see(climate_degC);
  }
};

/// Nothing.
template <class Scalar, int Lags>
struct RetainedSession<Scalar, 0, Lags> {
  /// There is none.
  template <class See>
  void each(See) const noexcept {}
};

/// The share of its way that a lag goes in `steps` steps, 1 - (1 - share)^steps, by doubling: without exp(), and so the
/// same on every machine.
template <class Scalar>
constexpr Scalar share_of_way(Scalar share, std::uint32_t steps) noexcept {
  if (steps == 1) return share;
  Scalar result = 0;
  for (; steps > 0; steps /= 2) {
    if (steps % 2 == 1) result += share * (1 - result);
    share += share * (1 - share);
  }
  return result;
}

/// What a model on derived channels remembers: where its lags are, where they were at the zero, and the climate of the
/// session, the mean temperature where it began.
///
/// Lags run on absolute temperatures from the first samples on, whether there is a zero or not, so that a datum on a
/// warm machine gives the change since then. A session begins with so many samples in a row without a fault as make a
/// zero: until then lags are at their temperatures, as in the first row of a batch. A sensor that is not used leaves
/// its lag where it is; when it is used again the lag goes the whole way at once, as through a longer sampling
/// interval: `x <- x + (1 - exp(-n dt / tau)) (T - x)`. So it does after a time off. What rounding takes from a step is
/// kept for the next, so that a short cycle does not stop a lag, not even in float.
template <class Scalar, int Sensors, int Features, int Lags>
class Session {
 public:
  using Retained = RetainedSession<Scalar, Features, Lags>;  ///< what survives a power cycle

  /// None has begun. Only dynamic rows allocate.
  template <class Model>
  void reset(const Model& model) {
    detail::set_size(lags_, model.features.lag_sensor.size());
    detail::set_size(present_, lags_.size());
    detail::set_size(zero_degC_, lags_.size());
    for (std::size_t k = 0; k < lags_.size(); ++k) {
      lags_[k] = Lag{};
      present_[k] = Place{};
      zero_degC_[k] = 0;
    }
    climate_degC_ = std::numeric_limits<Scalar>::quiet_NaN();
    begun_ = asleep_ = 0;
  }

  /// Time that passes while nothing is looked at.
  void sleep(std::uint32_t steps) noexcept { asleep_ = counted(asleep_, steps); }

  /// Where lags are now by the readings that were accepted last, `steps` steps after the ones before.
  template <class Model, class Guard, class Rule>
  void look(const Model& model, const Guard& guard, const Rule& rule, std::uint32_t steps) noexcept {
    const std::uint32_t passed = counted(steps, asleep_);
    asleep_ = 0;
    if (passed >= rule.session_steps) begun_ = 0;
    for (std::size_t k = 0; k < lags_.size(); ++k) {
      const Lag& lag = lags_[k];
      const Scalar reading = guard.reading_degC(model.features.lag_sensor[k]);
      lags_[k].missed = counted(lag.missed, passed);
      present_[k] = Place{reading, 0};
      if (begun_ == 0 || !lag.known) continue;
      const Scalar way = (reading - lag.at.degC) - lag.at.rest;
      const Scalar step = share_of_way(rule.lag_share[k], lag.missed) * way + lag.at.rest;
      present_[k].degC = lag.at.degC + step;
      present_[k].rest = step - (present_[k].degC - lag.at.degC);
    }
  }

  /// Leaves the lags of the sensors in use there, and counts the samples of a beginning.
  template <class Model, class Guard>
  void settle(const Model& model, const Guard& guard, std::uint32_t samples) noexcept {
    for (std::size_t k = 0; k < lags_.size(); ++k)
      if (guard.fault(model.features.lag_sensor[k]) == SensorFault::none) lags_[k] = Lag{present_[k], 0, true};
    if (begun_ > 0 || model.features.channels.empty()) return;
    bool complete = true;
    Scalar sum = 0, used = 0;
    for (std::size_t i = 0; i < model.sensors(); ++i) {
      const bool good = guard.fault(i) == SensorFault::none;
      complete = complete && (good || guard.lost(i));
      if (!good) continue;
      sum += guard.reading_degC(i);
      used += 1;
    }
    if (used > 0) climate_degC_ = sum / used;
    taken_ = complete && used > 0 ? taken_ + 1 : 0;
    if (taken_ < samples) return;
    taken_ = 0;
    begun_ = 1;
  }

  /// The zero was taken of the sensors that `datum` knows.
  template <class Model, class Datum>
  void take_zero(const Model& model, const Datum& datum) noexcept {
    for (std::size_t k = 0; k < lags_.size(); ++k)
      zero_degC_[k] = datum.known(model.features.lag_sensor[k]) ? present_[k].degC : Scalar(0);
  }

  /// Goes on from before a power cycle, `off_steps` steps ago.
  void restore(const Retained& retained, std::uint32_t off_steps) noexcept {
    for (std::size_t k = 0; k < lags_.size(); ++k) {
      const bool known = is_finite(retained.lag_degC[k]);
      lags_[k] = Lag{{known ? retained.lag_degC[k] : Scalar(0), 0}, 0, known};
      present_[k] = lags_[k].at;
      zero_degC_[k] = is_finite(retained.lag_zero_degC[k]) ? retained.lag_zero_degC[k] : Scalar(0);
    }
    climate_degC_ = retained.climate_degC;
    begun_ = 1;
    asleep_ = off_steps;
  }

  /// What to keep over a power cycle.
  void retain(Retained& kept) const {
    kept.lag_zero_degC = zero_degC_;
    kept.lag_degC = zero_degC_;
    for (std::size_t k = 0; k < lags_.size(); ++k)
      kept.lag_degC[k] = lags_[k].known ? lags_[k].at.degC : std::numeric_limits<Scalar>::quiet_NaN();
    kept.climate_degC = climate_degC_;
  }

  /// The features of the readings relative to the zero of `datum`.
  template <class Model, class Guard, class Datum, class Values>
  void take_values(const Model& model, const Guard& guard, const Datum& datum, Values& values) const noexcept {
    const auto rise = [&](std::size_t i) { return guard.reading_degC(i) - datum.zero_degC()[i]; };
    const auto& all = model.features;
    const Scalar climate = climate_degC_ < all.climate_lowest_degC    ? all.climate_lowest_degC
                           : climate_degC_ > all.climate_highest_degC ? all.climate_highest_degC
                                                                      : climate_degC_;
    const Scalar factor = climate - all.climate_mean_degC;
    for (std::size_t f = 0; f < all.channels.size(); ++f) {
      const ControllerFeature& channel = all.channels[f];
      if (channel.kind == ControllerFeatureKind::lag) {
        values[f] = present_[channel.lag].degC - zero_degC_[channel.lag];
        continue;
      }
      values[f] = rise(channel.sensor);
      if (channel.kind == ControllerFeatureKind::climate) values[f] *= factor;
      if (channel.kind == ControllerFeatureKind::difference) values[f] -= rise(channel.other);
    }
  }

 private:
  struct Place {
    Scalar degC = 0, rest = 0;  // rest: what rounding has taken
  };
  struct Lag {
    Place at{};
    std::uint32_t missed = 0;  // steps since it was there
    bool known = false;
  };

  Row<Lag, Lags> lags_{};
  Row<Place, Lags> present_{};
  Row<Scalar, Lags> zero_degC_{};
  Scalar climate_degC_ = std::numeric_limits<Scalar>::quiet_NaN();
  std::uint32_t taken_ = 0, begun_ = 0, asleep_ = 0;
};

/// A model on the sensors themselves remembers nothing.
template <class Scalar, int Sensors, int Lags>
class Session<Scalar, Sensors, 0, Lags> {
 public:
  using Retained = RetainedSession<Scalar, 0, Lags>;  ///< nothing

  /// Nothing.
  template <class Model>
  void reset(const Model&) noexcept {}
  /// Nothing.
  void sleep(std::uint32_t) noexcept {}
  /// Nothing.
  template <class Model, class Guard, class Rule>
  void look(const Model&, const Guard&, const Rule&, std::uint32_t) noexcept {}
  /// Nothing.
  template <class Model, class Guard>
  void settle(const Model&, const Guard&, std::uint32_t) noexcept {}
  /// Nothing.
  template <class Model, class Datum>
  void take_zero(const Model&, const Datum&) noexcept {}
  /// Nothing.
  void restore(const Retained&, std::uint32_t) noexcept {}
  /// Nothing.
  void retain(Retained&) const noexcept {}
};

}  // namespace thermfit
