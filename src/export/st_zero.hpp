#pragma once

/// The zero in Structured Text: as controller/datum.hpp, in its order. It lives in VAR RETAIN. There are no bytes to
/// digest, so its check is a sum: 1 where the intercept drops out, plus the square root of the i-th prime times the
/// zero of sensor i, less 1e4 where it has none. Those roots are independent over the rationals: two zeros of rounded
/// readings, one torn out of the other, never add up to the same. Of a model with lags it covers where they are too,
/// and is made anew in each step.

#include "export/st_sensors.hpp"

namespace thermfit::cli {

/// Writes how a zero is asked for, taken, kept and told.
template <class Scalar>
class StZero : public StSensors<Scalar> {
 protected:
  using Base = StSensors<Scalar>;
  using Base::Base;
  using Base::count;
  using Base::drop_probe;
  using Base::line;
  using Base::model_;
  using Base::numbered;
  using Base::of;
  using Base::real;
  using Base::retained_features;
  using Base::retained_numbers;
  using Base::sensors;
  using Base::set;
  using Base::set_if;
  using Base::settings_;
  using Base::take_lag_zeros;
  using Base::trust_if;
  using Base::type;
  using Base::values;
  using Base::within;

  inline static const std::string valid_mark = "1413891121";  // RetainedDatum::valid_mark

  void retained_variables() {
    line("VAR RETAIN");
    line("(* the zero that corrections are relative to *)");
    line("zero_mark : UDINT := 0; (* " + valid_mark + " where there is one *)");
    line("zero_model : UDINT := 0; (* the model it belongs to *)");
    line("zero_through : BOOL := FALSE; (* the intercept drops out *)");
    line("zero_check : " + type() + " := 0.0; (* a sum over the others *)");
    for (std::size_t i = 0; i < sensors(); ++i) {
      line(of(i, "zero") + " : " + type() + " := 0.0; (* degC *)");
      line(of(i, "zero_known") + " : BOOL := FALSE; (* FALSE: none, which is not 0 degC *)");
    }
    this->retained_features();
    line("END_VAR");
  }

  void request(const std::string& source) {
    set("wanted_from", source);
    set("taken", "0");
    set("waited_steps", "0");
  }

  void check_sum() {
    line("IF zero_through THEN check_now := 1.0; ELSE check_now := 0.0; END_IF;");
    unsigned prime = 1;
    const auto divides = [&](unsigned factor) { return prime % factor == 0; };
    auto all = this->retained_numbers();
    for (std::size_t i = sensors(); i-- > 0;) all.insert(all.begin(), {of(i, "zero"), of(i, "zero_known")});
    for (const auto& [value, known] : all) {
      for (bool found = false; !found;) {
        found = true;
        ++prime;
        for (unsigned factor = 2; factor * factor <= prime; ++factor) found = found && !divides(factor);
      }
      const std::string weight = real(std::sqrt(static_cast<Scalar>(prime)));
      set("check_now", "check_now + " + weight + " * " + value);
      if (!known.empty()) set_if("NOT " + known, "check_now", "check_now - " + weight + " * 10000.0");
    }
  }

  /// What is retained has moved. The mark is away while it does: a power cut in between leaves none.
  void retain() {
    line("IF zero_from <> 0 THEN");
    set("zero_mark", "0");
    check_sum();
    set("zero_check", "check_now");
    set("zero_mark", valid_mark);
    line("END_IF;");
  }

  std::size_t samples() const { return settings_.zero.samples; }
  static std::string window(std::size_t i, std::size_t k) { return of(i, numbered("w", k)); }

  /// Datum::collect; the window is shifted, newest first.
  void collect() {
    line("(* one more sample for the zero that was asked for *)");
    line("IF wanted_from <> 0 THEN");
    count("waited_steps");
    set("missing", "0");
    set("same", "TRUE");
    set("complete", "TRUE");
    for (std::size_t i = 0; i < sensors(); ++i) {
      line("IF complete THEN");
      std::string good = "(" + of(i, "fault") + " = 0 OR " + of(i, "returning") + ")";
      if (model_.rise && settings_.zero.policy == ZeroPolicy::first)
        good +=
            " AND (wanted_from <> 1 OR (" +
            within(of(i, "reading"), settings_.sensors[i].first_lowest_degC, settings_.sensors[i].first_highest_degC) +
            "))";
      set("sample_good", good);
      std::string unusable = "NOT sample_good";
      if (model_.has_substitute[i])
        unusable += " AND NOT (" + of(i, "lost") + " AND waited_steps > " + std::to_string(settings_.hold_steps) + ")";
      line("IF " + unusable + " THEN");
      set("complete", "FALSE");
      set("taken", "0");
      line("ELSE");
      set_if("NOT sample_good", "missing", "missing + 1");
      set_if("NOT (" + of(i, "counted") + " = sample_good)", "same", "FALSE");
      set(of(i, "counted"), "sample_good");
      line("END_IF;");
      line("END_IF;");
    }
    line("IF complete THEN");
    set_if("missing > 1 OR NOT same", "taken", "0");
    line("IF missing <= 1 THEN");
    for (std::size_t i = 0; i < sensors(); ++i) {
      for (std::size_t k = samples() - 1; k > 0; --k) set(window(i, k), window(i, k - 1));
      set(window(i, 0), of(i, "reading"));
    }
    set_if("taken < " + std::to_string(samples()), "taken", "taken + 1");
    set("agreed", "taken >= " + std::to_string(samples()));
    for (std::size_t i = 0; i < sensors(); ++i) {
      set("lowest", window(i, 0));
      set("highest", window(i, 0));
      for (std::size_t k = 1; k < samples(); ++k) {
        set_if(window(i, k) + " < lowest", "lowest", window(i, k));
        set_if(window(i, k) + " > highest", "highest", window(i, k));
      }
      set_if(of(i, "counted") + " AND NOT (highest - lowest <= " + real(settings_.sensors[i].agree_K) + ")", "agreed",
             "FALSE");
    }
    line("IF agreed THEN");
    take();
    line("END_IF;");
    line("END_IF;");
    line("END_IF;");
    line("END_IF;");
  }

  /// Datum::take. The mark is away while the values change: a power cut in between leaves none.
  void take() {
    set("zero_mark", "0");
    for (std::size_t i = 0; i < sensors(); ++i) {
      line("(* the median *)");
      for (std::size_t k = 0; k < samples(); ++k) set(numbered("rank", k), window(i, k));
      for (std::size_t k = 0; k <= samples() / 2; ++k)
        for (std::size_t m = k + 1; m < samples(); ++m) {
          const std::string low = numbered("rank", k), high = numbered("rank", m);
          line("IF " + high + " < " + low + " THEN swap := " + low + "; " + low + " := " + high + "; " + high +
               " := swap; END_IF;");
        }
      set(of(i, "zero_known"), of(i, "counted"));
      set(of(i, "zero"), "0.0");
      set_if(of(i, "counted"), of(i, "zero"), numbered("rank", samples() / 2));
      trust_if(of(i, "counted") + " AND " + of(i, "returning"), i);
    }
    this->take_lag_zeros();
    drop_probe();
    set("zero_through", settings_.zero.through_zero ? "TRUE" : "wanted_from = 2");
    set("zero_from", "wanted_from");
    set("wanted_from", "0");
    set("zero_model", std::to_string(model_.identity));
    check_sum();
    set("zero_check", "check_now");
    set("zero_mark", valid_mark);
  }

  void show_zero() {
    set("shown_from", "zero_from");
    set("shown_pending", "wanted_from <> 0");
  }
};

}  // namespace thermfit::cli
