#pragma once

/// What a probe has found, held until the next reading, in Structured Text: as controller/probe_corrections.hpp.

#include "export/st_model.hpp"

namespace thermfit::cli {

/// Writes how readings of a probe are judged and kept; nothing where the export is without.
template <class Scalar>
class StProbe : public StModel<Scalar> {
 protected:
  using Base = StModel<Scalar>;
  using Base::Base;
  using Base::count;
  using Base::errors;
  using Base::errors_;
  using Base::finite;
  using Base::line;
  using Base::number;
  using Base::numbered;
  using Base::of;
  using Base::real;
  using Base::request_;
  using Base::set;
  using Base::settings_;
  using Base::type;
  using Base::without_sign;

  std::string probe_of(std::size_t j) const { return "Probe_" + errors_[j]; }
  static std::string of_probe(std::size_t j, const std::string& what) { return "p" + number(j) + "_" + what; }

  void probe_variables() {
    if (!request_.wishes.probe) return;
    line("probe_corrects : BOOL := FALSE;");
    line("corrected, missed_um, away_um : " + type() + " := 0.0;");
    for (std::size_t j = 0; j < errors(); ++j) {
      line(of_probe(j, "held") + ", " + of_probe(j, "waiting_um") + " : " + type() + " := 0.0;");
      line(of_probe(j, "age") + " : UDINT := 0;");
      line(of_probe(j, "before") + ", " + of_probe(j, "taken") + ", " + of_probe(j, "waiting") + ", " +
           of_probe(j, "agrees") + " : BOOL := FALSE;");
    }
  }

  /// Compensator::probe, of the demand of the step before.
  void probe() {
    if (!request_.wishes.probe) return;
    line("(* readings of the probe *)");
    for (std::size_t j = 0; j < errors(); ++j) {
      const ProbeLimits<Scalar>& limits = settings_.probe[j];
      const std::string told = probe_of(j) + "_told";
      line("IF " + probe_of(j) + "_new AND NOT " + of_probe(j, "before") + " THEN");
      set(told, "4");
      line("IF state = 2 OR state = 3 THEN");
      set("missed_um", probe_of(j) + " - " + numbered("demand", j));
      set("away_um", "missed_um - " + of_probe(j, "waiting_um"));
      without_sign("away_um");
      set(of_probe(j, "agrees"), of_probe(j, "waiting") + " AND away_um <= " + real(limits.jump_um));
      line("IF NOT (" + finite("missed_um") + ") THEN");
      set(told, "1");
      line("ELSIF missed_um > " + real(limits.largest_um) + " OR missed_um < (-" + real(limits.largest_um) + ") THEN");
      set(told, "2");
      line("ELSE");
      set("away_um", "missed_um - " + of_probe(j, "held"));
      without_sign("away_um");
      line("IF NOT " + of_probe(j, "agrees") + " AND away_um > " + real(limits.jump_um) + " THEN");
      set(of_probe(j, "waiting"), "TRUE");
      set(of_probe(j, "waiting_um"), "missed_um");
      set(told, "3");
      line("ELSE");
      set(of_probe(j, "waiting"), "FALSE");
      set(of_probe(j, "held"), "missed_um");
      set(of_probe(j, "age"), "0");
      set(of_probe(j, "taken"), "TRUE");
      set(told, "0");
      line("END_IF;");
      line("END_IF;");
      line("END_IF;");
      line("END_IF;");
      set(of_probe(j, "before"), probe_of(j) + "_new");
    }
  }

  void drop_probe() {
    for (std::size_t j = 0; j < errors() && request_.wishes.probe; ++j) {
      for (const char* what : {"held", "waiting_um"}) set(of_probe(j, what), "0.0");
      set(of_probe(j, "age"), "0");
      for (const char* what : {"taken", "waiting"}) set(of_probe(j, what), "FALSE");
    }
  }

  void age_probe() {
    for (std::size_t j = 0; j < errors() && request_.wishes.probe; ++j) count(of_probe(j, "age"));
  }
};

}  // namespace thermfit::cli
