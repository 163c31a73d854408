#pragma once

/// Derived channels in Structured Text: lags, the climate of a session, and the inputs of the model that follow; as
/// controller/session.hpp, in its order. A model on the sensors themselves has none of it.

#include "export/st_block.hpp"

namespace thermfit::cli {

/// Writes what a function block needs of the derived channels of its model.
template <class Scalar>
class StFeatures : public StBlock<Scalar> {
 protected:
  using Base = StBlock<Scalar>;
  using Base::Base;
  using Base::derived;
  using Base::input;
  using Base::inputs;
  using Base::lags;
  using Base::line;
  using Base::model_;
  using Base::most_steps;
  using Base::number;
  using Base::numbered;
  using Base::of;
  using Base::real;
  using Base::set;
  using Base::set_if;
  using Base::settings_;
  using Base::type;

  void feature_inputs() {
    if (lags() > 0)
      line(
          "Off_periods : UDINT := 4294967295; (* how long the power was off, where Enable rises first; 4294967295: not "
          "known, then lags are not either, and there is no zero until a datum *)");
  }

  void feature_variables() {
    if (!derived()) return;
    line("session_begun, sample_complete : BOOL := FALSE;");
    line("begin_samples, asleep_steps, passed_steps, share_left, share_half : UDINT := 0;");
    line("climate_factor, lag_share, share_grown, lag_step, sample_sum, sample_count : " + type() + " := 0.0;");
    for (std::size_t k = 0; k < lags(); ++k) {
      line(of_lag(k, "rest") + ", " + of_lag(k, "present") + ", " + of_lag(k, "present_rest") + " : " + type() +
           " := 0.0;");
      line(of_lag(k, "missed") + " : UDINT := 0;");
    }
    for (std::size_t f = 0; f < inputs(); ++f) line(input(f) + " : " + type() + " := 0.0;");
  }

  void retained_features() {
    if (!derived()) return;
    line("session_degC : " + type() + " := 0.0; (* mean temperature where the session began *)");
    for (std::size_t k = 0; k < lags(); ++k) {
      line(of_lag(k, "at") + ", " + of_lag(k, "zero") + " : " + type() + " := 0.0; (* degC, where the lag of sensor " +
           number(model_.features.lag_sensor[k]) + " is and was at the zero *)");
      line(of_lag(k, "known") + " : BOOL := FALSE;");
    }
  }

  /// Numbers that the sum over what is retained covers besides the zeros, and whether each is known.
  std::vector<std::pair<std::string, std::string>> retained_numbers() const {
    std::vector<std::pair<std::string, std::string>> all;
    for (std::size_t k = 0; k < lags(); ++k) {
      all.emplace_back(of_lag(k, "at"), of_lag(k, "known"));
      all.emplace_back(of_lag(k, "zero"), "");
    }
    if (derived()) all.emplace_back("session_degC", "");
    return all;
  }

  /// After power-up, where the zero that was kept is taken: Session::restore.
  void restore_session() {
    if (!derived()) return;
    set("session_begun", "TRUE");
    set("begin_samples", "0");
    if (lags() == 0) return;
    set("asleep_steps", "Off_periods");
    set_if("asleep_steps > " + most_steps, "asleep_steps", most_steps);
    for (std::size_t k = 0; k < lags(); ++k) set(of_lag(k, "present"), of_lag(k, "at"));
  }

  /// Where it is not: Session::reset.
  void forget_session() {
    if (!derived()) return;
    set("session_begun", "FALSE");
    set("begin_samples", "0");
    set("asleep_steps", "0");
    set("session_degC", "0.0");
    for (std::size_t k = 0; k < lags(); ++k) {
      for (const char* what : {"at", "zero"}) set(of_lag(k, what), "0.0");
      set(of_lag(k, "known"), "FALSE");
    }
  }

  /// Session::look.
  void look() {
    if (!derived()) return;
    line("(* where the lags are now *)");
    set("passed_steps", "steps + asleep_steps");
    set_if("passed_steps > " + most_steps, "passed_steps", most_steps);
    set("asleep_steps", "0");
    set_if("passed_steps >= " + std::to_string(settings_.features.session_steps), "session_begun", "FALSE");
    for (std::size_t k = 0; k < lags(); ++k) {
      const std::string missed = of_lag(k, "missed"), at = of_lag(k, "at"), rest = of_lag(k, "rest");
      const std::string reading = of(model_.features.lag_sensor[k], "reading"), present = of_lag(k, "present");
      set_if(missed + " <= " + most_steps, missed, missed + " + passed_steps");
      set(present, reading);
      set(of_lag(k, "present_rest"), "0.0");
      line("IF session_begun AND " + of_lag(k, "known") + " THEN");
      set("lag_share", real(settings_.features.lag_share[k]));
      line("IF " + missed + " <> 1 THEN");
      set("share_grown", "lag_share");
      set("lag_share", "0.0");
      set("share_left", missed);
      line("WHILE share_left > 0 DO");
      set("share_half", "share_left / 2");
      set_if("share_left > share_half + share_half", "lag_share", "lag_share + share_grown * (1.0 - lag_share)");
      set("share_grown", "share_grown + share_grown * (1.0 - share_grown)");
      set("share_left", "share_half");
      line("END_WHILE;");
      line("END_IF;");
      set("lag_step", "lag_share * ((" + reading + " - " + at + ") - " + rest + ") + " + rest);
      set(present, at + " + lag_step");
      set(of_lag(k, "present_rest"), "lag_step - (" + present + " - " + at + ")");
      line("END_IF;");
    }
  }

  /// Session::settle.
  void settle() {
    if (!derived()) return;
    line("(* and where they stay *)");
    for (std::size_t k = 0; k < lags(); ++k) {
      line("IF " + of(model_.features.lag_sensor[k], "fault") + " = 0 THEN");
      set(of_lag(k, "at"), of_lag(k, "present"));
      set(of_lag(k, "rest"), of_lag(k, "present_rest"));
      set(of_lag(k, "missed"), "0");
      set(of_lag(k, "known"), "TRUE");
      line("END_IF;");
    }
    line("IF NOT session_begun THEN");
    set("sample_complete", "TRUE");
    set("sample_sum", "0.0");
    set("sample_count", "0.0");
    for (std::size_t i = 0; i < model_.sensors(); ++i) {
      line("IF " + of(i, "fault") + " = 0 THEN");
      set("sample_sum", "sample_sum + " + of(i, "reading"));
      set("sample_count", "sample_count + 1.0");
      line("ELSIF NOT " + of(i, "lost") + " THEN");
      set("sample_complete", "FALSE");
      line("END_IF;");
    }
    line("IF sample_count > 0.0 THEN");
    set("session_degC", "sample_sum / sample_count");
    line("ELSE");
    set("sample_complete", "FALSE");
    line("END_IF;");
    line("IF sample_complete THEN");
    set("begin_samples", "begin_samples + 1");
    line("ELSE");
    set("begin_samples", "0");
    line("END_IF;");
    line("IF begin_samples >= " + std::to_string(settings_.zero.samples) + " THEN");
    set("begin_samples", "0");
    set("session_begun", "TRUE");
    line("END_IF;");
    line("END_IF;");
  }

  /// Session::take_zero.
  void take_lag_zeros() {
    for (std::size_t k = 0; k < lags(); ++k) {
      set(of_lag(k, "zero"), "0.0");
      set_if(of(model_.features.lag_sensor[k], "zero_known"), of_lag(k, "zero"), of_lag(k, "present"));
    }
  }

  /// Session::take_values, from the rises of the sensors.
  void derive_values() {
    if (!derived()) return;
    const auto& all = model_.features;
    bool climate = false;
    for (const ControllerFeature& channel : all.channels)
      climate = climate || channel.kind == ControllerFeatureKind::climate;
    if (climate) {
      const std::string low = real(all.climate_lowest_degC), high = real(all.climate_highest_degC);
      set("climate_factor", "session_degC");
      set_if("session_degC < " + low, "climate_factor", low);
      set_if("session_degC > " + high, "climate_factor", high);
      set("climate_factor", "climate_factor - " + real(all.climate_mean_degC));
    }
    for (std::size_t f = 0; f < inputs(); ++f) {
      const ControllerFeature& channel = all.channels[f];
      const std::string rise = of(channel.sensor, "value");
      switch (channel.kind) {
        case ControllerFeatureKind::lag:
          set(input(f), of_lag(channel.lag, "present") + " - " + of_lag(channel.lag, "zero"));
          break;
        case ControllerFeatureKind::climate:
          set(input(f), rise + " * climate_factor");
          break;
        case ControllerFeatureKind::difference:
          set(input(f), rise + " - " + of(channel.other, "value"));
          break;
        case ControllerFeatureKind::rise:
          set(input(f), rise);
      }
    }
  }

  /// The channels that are made of that sensor.
  std::vector<std::size_t> made_of(std::size_t sensor) const {
    std::vector<std::size_t> own;
    for (std::size_t f = 0; f < inputs(); ++f)
      if (model_.features.channels[f].of(sensor)) own.push_back(f);
    return own;
  }

  /// DomainGuard::fill_in_all for a sensor whose channels stand at their means, with the scores of the rest.
  void fill_in_all(std::size_t sensor) {
    const auto& domain = model_.domain;
    const std::vector<std::size_t> own = made_of(sensor);
    const auto weight = [&](std::size_t a, std::size_t f, bool spanned) {
      return spanned ? domain.rotations[a][f] * domain.inverse_score_variance[a] : domain.loadings[a][f];
    };
    const auto shared = [&](std::size_t f, std::size_t g, bool spanned) {
      Scalar sum = 0;
      for (std::size_t a = 0; a < domain.rotations.size(); ++a) sum += weight(a, f, spanned) * domain.rotations[a][g];
      return sum;
    };
    for (const std::size_t f : own) set(input(f), "0.0");
    for (int sweep = 0; sweep < DomainGuard<Scalar, dynamic_size, dynamic_size>::fill_in_sweeps; ++sweep)
      for (const std::size_t f : own) {
        const bool spanned = !(shared(f, f, false) < Scalar(0.99));
        const Scalar whole = shared(f, f, spanned);
        set("expectation", "0.0");
        for (std::size_t a = 0; a < domain.rotations.size(); ++a)
          set("expectation", "expectation + " + real(weight(a, f, spanned)) + " * " + numbered("score", a));
        for (const std::size_t g : own)
          if (g != f) set("expectation", "expectation + " + real(shared(f, g, spanned)) + " * " + input(g));
        set(input(f), !spanned    ? "expectation / " + real(1 - whole)
                      : whole > 0 ? "(-expectation) / " + real(whole)
                                  : std::string("0.0"));
      }
    for (const std::size_t f : own)
      set(input(f), real(domain.mean[f]) + " + " + input(f) + " / " + real(domain.inverse_scale[f]));
  }

  static std::string of_lag(std::size_t k, const std::string& what) { return "l" + number(k) + "_" + what; }
};

}  // namespace thermfit::cli
