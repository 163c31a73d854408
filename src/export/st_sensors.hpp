#pragma once

/// Which readings are trusted, in Structured Text: as controller/sensor_guard.hpp, in its order.

#include "export/st_probe.hpp"

namespace thermfit::cli {

/// Writes the checks of each reading, and who is trusted again.
template <class Scalar>
class StSensors : public StProbe<Scalar> {
 protected:
  using Base = StProbe<Scalar>;
  using Base::Base;
  using Base::count;
  using Base::domain_values;
  using Base::equation;
  using Base::errors;
  using Base::finite;
  using Base::has_reference;
  using Base::line;
  using Base::model_;
  using Base::number;
  using Base::numbered;
  using Base::of;
  using Base::of_steps;
  using Base::reading_of;
  using Base::real;
  using Base::sensors;
  using Base::set;
  using Base::set_if;
  using Base::settings_;
  using Base::share_inside;
  using Base::values;
  using Base::within;
  using Base::without_sign;

  void heartbeat() {
    line("(* whether the readings are new *)");
    line("IF NOT has_heartbeat OR Heartbeat <> heartbeat_before THEN");
    set("silent_steps", "0");
    line("ELSE");
    count("silent_steps");
    line("END_IF;");
    set_if("Heartbeat <> 0", "has_heartbeat", "TRUE");
    set("heartbeat_before", "Heartbeat");
    set("stale", "silent_steps >= " + std::to_string(settings_.stale_steps));
  }

  void guard() {
    line("(* each reading by itself and by its past *)");
    set("total", "0.0");
    set("newcomer", "FALSE");
    set("all_still", "4294967295");
    for (std::size_t i = 0; i < sensors(); ++i) guard_alone(i);
    line("(* and by the others *)");
    set("all_frozen", settings_.patience.all_frozen_steps > 0
                          ? "all_still >= " + std::to_string(settings_.patience.all_frozen_steps)
                          : "FALSE");
    for (std::size_t i = 0; i < sensors(); ++i) guard_by_others(i);
  }

  void guard_alone(std::size_t i) {
    const SensorLimits<Scalar>& limits = settings_.sensors[i];
    set(of(i, "fault"), "0");
    line("IF stale THEN");
    set(of(i, "fault"), "7");
    line("ELSIF NOT (" + finite(reading_of(i)) + ") THEN");
    set(of(i, "fault"), "1");
    line("ELSIF NOT (" + within(reading_of(i), limits.lowest_degC, limits.highest_degC) + ") THEN");
    set(of(i, "fault"), "2");
    line("ELSIF " + of(i, "seen") + " THEN");
    set("change", reading_of(i) + " - " + of(i, "reading"));
    without_sign("change");
    set_if("NOT (change <= " + real(limits.largest_step_K) + " * " + of_steps(of(i, "bad") + " + steps") + ")",
           of(i, "fault"), "3");
    line("END_IF;");
    line("IF " + of(i, "fault") + " = 0 THEN");
    line("IF " + of(i, "seen") + " AND " + reading_of(i) + " = " + of(i, "reading") + " THEN");
    count(of(i, "still"));
    line("ELSE");
    set(of(i, "still"), "0");
    line("END_IF;");
    set_if("NOT " + of(i, "seen"), "newcomer", "TRUE");
    set(of(i, "reading"), reading_of(i));
    set(of(i, "seen"), "TRUE");
    set_if(of(i, "still") + " < all_still", "all_still", of(i, "still"));
    line("END_IF;");
    set_vouched(i, "total", "total + ");
  }

  /// What a sensor tells about whether the others should have moved: of one that is lost, only what was trusted.
  void set_vouched(std::size_t i, const std::string& variable, const std::string& plus) {
    line("IF " + of(i, "lost") + " THEN");
    set(variable, plus + of(i, "trusted_at"));
    line("ELSE");
    set(variable, plus + of(i, "reading"));
    line("END_IF;");
  }

  void guard_by_others(std::size_t i) {
    const SensorLimits<Scalar>& limits = settings_.sensors[i];
    set_vouched(i, "others", "total - ");
    line("IF newcomer OR " + of(i, "still") + " = 0 THEN");
    set(of(i, "still"), "0");
    set(of(i, "others"), "others");
    line("ELSIF " + of(i, "fault") + " = 0 THEN");
    std::string rests = "all_frozen";
    if (limits.frozen_steps > 0) rests += " OR " + of(i, "still") + " >= " + std::to_string(limits.frozen_steps);
    set_if(rests, of(i, "fault"), "4");
    if (limits.stuck_steps > 0 && sensors() > 1) {
      const Scalar moved = settings_.patience.others_moved_K * static_cast<Scalar>(sensors() - 1);
      set("change", "others - " + of(i, "others"));
      without_sign("change");
      set_if(of(i, "still") + " >= " + std::to_string(limits.stuck_steps) + " AND change >= " + real(moved),
             of(i, "fault"), "4");
    }
    line("END_IF;");
    set(of(i, "returning"), "FALSE");
    line("IF " + of(i, "fault") + " <> 0 THEN");
    set(of(i, "good"), "0");
    count(of(i, "bad"));
    set_if(of(i, "bad") + " >= " + std::to_string(settings_.patience.lost_after_steps), of(i, "lost"), "TRUE");
    line("ELSE");
    set(of(i, "bad"), "0");
    line("IF " + of(i, "lost") + " THEN");
    count(of(i, "good"));
    set(of(i, "returning"), of(i, "good") + " >= " + std::to_string(settings_.patience.recover_after_steps));
    line("IF " + of(i, "returning") + " THEN " + of(i, "fault") + " := 8; ELSE " + of(i, "fault") + " := 5; END_IF;");
    line("ELSE");
    set(of(i, "trusted_at"), of(i, "reading"));
    set(of(i, "trusted"), "TRUE");
    line("END_IF;");
    line("END_IF;");
  }

  /// Whether sensor i, where it comes back alone, is compared with its substitute.
  bool compared(std::size_t i) const { return model_.has_substitute[i] && model_.agreement_um[i][0] > 0; }

  void trust() {
    line("(* sensors that read well again are trusted where they agree with the others *)");
    set("away", "0");
    set("all_read", "TRUE");
    set("referenced", "TRUE");
    for (std::size_t i = 0; i < sensors(); ++i) {
      set_if(of(i, "fault") + " <> 0", "away", "away + 1");
      set_if(of(i, "fault") + " <> 0 AND NOT " + of(i, "returning"), "all_read", "FALSE");
      set_if("NOT " + has_reference(i), "referenced", "FALSE");
    }
    line("IF away > 0 THEN");
    set("together", "FALSE");
    if (settings_.domain_policy != DomainPolicy::ignore) {
      line("IF all_read AND referenced THEN");
      domain_values();
      share_inside();
      set("together", "share >= 1.0");
      line("END_IF;");
    }
    bool any = false;
    for (std::size_t i = 0; i < sensors(); ++i) any = any || compared(i);
    if (any) {
      line("IF away = 1 THEN");
      values();
      equation(model_.equation, "demand");
      line("END_IF;");
    }
    for (std::size_t i = 0; i < sensors(); ++i) trust(i);
    line("END_IF;");
  }

  void trust(std::size_t i) {
    line("IF " + of(i, "returning") + " THEN");
    set("change", of(i, "reading") + " - " + of(i, "trusted_at"));
    without_sign("change");
    set("vouched", std::string("together OR NOT ") + of(i, "trusted") + (model_.rise ? " OR zero_from = 0" : "") +
                       " OR change <= " + real(settings_.patience.others_moved_K));
    if (compared(i)) {
      line("IF away = 1 AND " + has_reference(i) + " THEN");
      equation(model_.substitutes[i], "other");
      set("vouched", "TRUE");
      for (std::size_t j = 0; j < errors(); ++j) {
        set("change", numbered("demand", j) + " - " + numbered("other", j));
        without_sign("change");
        set_if("NOT (change <= " + real(model_.agreement_um[i][j]) + ")", "vouched", "FALSE");
      }
      line("END_IF;");
    }
    trust_if("vouched", i);
    line("END_IF;");
  }

  void trust_if(const std::string& condition, std::size_t i) {
    line("IF " + condition + " THEN");
    if (sensors() > 1) set("change", of(i, "reading") + " - " + of(i, "trusted_at"));
    for (std::size_t k = 0; k < sensors(); ++k)
      if (k != i) set(of(k, "others"), of(k, "others") + " + change");
    set(of(i, "lost"), "FALSE");
    set(of(i, "returning"), "FALSE");
    set(of(i, "fault"), "0");
    line("END_IF;");
  }

  void count_unused() {
    line("(* which sensors can be used *)");
    for (std::size_t i = 0; i < sensors(); ++i) {
      set("fault_now", of(i, "fault"));
      set_if("fault_now = 0 AND zero_from <> 0 AND NOT " + of(i, "zero_known"), "fault_now", "6");
      line("IF fault_now <> 0 THEN");
      line("IF unused = 0 THEN");
      set("first_unused", number(i));
      set("first_fault", "fault_now");
      line("END_IF;");
      set("unused", "unused + 1");
      line("END_IF;");
    }
    set("usable", "unused = 0");
    for (std::size_t i = 0; i < sensors(); ++i)
      if (model_.has_substitute[i])
        set_if("unused = 1 AND first_unused = " + number(i), "usable", of(i, "lost") + " OR NOT " + has_reference(i));
  }
};

}  // namespace thermfit::cli
