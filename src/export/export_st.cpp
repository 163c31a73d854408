#include "export/source_text.hpp"
#include "export/st_zero.hpp"
#include "export/test_vectors.hpp"
#include "thermfit/error.hpp"

/// IEC 61131-3 as every compiler takes it: scalars only, every loop written out, comparisons that NaN fails
/// (`x >= lo AND x <= hi`), no bit operations. The arithmetic is that of controller/compensator.hpp, in its order.

namespace thermfit::cli {
namespace {

template <class Scalar>
class StWriter : StZero<Scalar> {
  using Base = StZero<Scalar>;
  using Base::age_probe;
  using Base::apply_domain;
  using Base::check_sum;
  using Base::collect;
  using Base::components;
  using Base::count;
  using Base::count_unused;
  using Base::derived;
  using Base::drop_probe;
  using Base::equation;
  using Base::errors;
  using Base::errors_;
  using Base::finite;
  using Base::guard;
  using Base::heartbeat;
  using Base::lags;
  using Base::line;
  using Base::model_;
  using Base::most_steps;
  using Base::number;
  using Base::numbered;
  using Base::of;
  using Base::of_probe;
  using Base::of_steps;
  using Base::output;
  using Base::probe;
  using Base::probe_of;
  using Base::probe_variables;
  using Base::reading_of;
  using Base::real;
  using Base::request;
  using Base::request_;
  using Base::retain;
  using Base::retained_variables;
  using Base::samples;
  using Base::sensors;
  using Base::sensors_;
  using Base::set;
  using Base::set_if;
  using Base::settings_;
  using Base::show_zero;
  using Base::trust;
  using Base::type;
  using Base::valid_mark;
  using Base::values;
  using Base::window;
  using typename Base::Device;

 public:
  using Base::Base;

  std::string compensator() {
    line("FUNCTION_BLOCK " + request_.name);
    variables();
    commands();
    probe();
    set("steps", "Periods");
    line("IF steps > " + most_steps + " THEN steps := " + most_steps + "; END_IF;");
    line("IF state = 0 THEN");
    if (derived()) count("asleep_steps");
    nothing_to_tell();
    for (const char* zero : {"shown_from := 0;", "shown_pending := FALSE;"}) line(zero);
    line("ELSIF Periods > 0 THEN");
    nothing_to_tell();
    heartbeat();
    guard();
    this->look();
    trust();
    this->settle();
    collect();
    age_probe();
    judge();
    advance();
    move();
    show_zero();
    if (derived()) retain();
    line("END_IF;");
    outputs();
    line("END_FUNCTION_BLOCK");
    return this->taken();
  }

  std::string test() {
    const auto vectors = TestCourse<Scalar>(model_, settings_, Scalar(1e6)).run();
    line("FUNCTION_BLOCK " + request_.name + "_test");
    line("(* Call once a cycle until Done. Failed is then 0, or the number of the first vector that went wrong. *)");
    line("VAR_OUTPUT");
    line("Done : BOOL := FALSE;");
    line("Failed : UDINT := 0;");
    line("END_VAR");
    line("VAR");
    line("device : " + request_.name + ";");
    line("vector, remaining, expected_status : UDINT := 0;");
    line("enable, datum : BOOL := FALSE;");
    line("difference : " + type() + " := 0.0;");
    for (std::size_t i = 0; i < sensors(); ++i) line(numbered("reading", i) + " : " + type() + " := 0.0;");
    for (std::size_t j = 0; j < errors(); ++j) line(numbered("expected", j) + " : " + type() + " := 0.0;");
    line("END_VAR");
    line("IF vector = 0 THEN");
    line("(* the zero that a test before has left *)");
    line("device(Enable := FALSE, Datum := TRUE);");
    line("device(Enable := FALSE, Datum := FALSE);");
    line("END_IF;");
    line("IF remaining = 0 AND NOT Done THEN");
    line("vector := vector + 1;");
    line("CASE vector OF");
    for (std::size_t v = 0; v < vectors.size(); ++v) line(std::to_string(v + 1) + ": " + row(vectors[v]));
    line("ELSE");
    line("Done := TRUE;");
    line("END_CASE;");
    line("END_IF;");
    line("IF NOT Done THEN");
    std::string call = "device(Enable := enable, Datum := datum";
    for (std::size_t i = 0; i < sensors(); ++i) call += ", " + reading_of(i) + " := " + numbered("reading", i);
    line(call + ");");
    set("datum", "FALSE");
    line("remaining := remaining - 1;");
    line("IF remaining = 0 AND Failed = 0 THEN");
    line("IF device.Status <> expected_status THEN Failed := vector; END_IF;");
    for (std::size_t j = 0; j < errors(); ++j) {
      const Scalar tolerance = std::is_same_v<Scalar, float> ? Scalar(1e-3) : Scalar(1e-9);
      line("difference := device." + output(j) + " - " + numbered("expected", j) + " * " +
           real(static_cast<Scalar>(request_.unit.per_um)) + ";");
      line("IF NOT (difference >= " + real(-tolerance) + " AND difference <= " + real(tolerance) +
           ") THEN Failed := vector; END_IF;");
    }
    line("END_IF;");
    line("END_IF;");
    line("END_FUNCTION_BLOCK");
    return this->taken();
  }

 private:
  std::string row(const TestVector<Scalar>& vector) const {
    std::string text =
        "remaining := " + std::to_string(vector.repeat) + "; expected_status := " + std::to_string(vector.status) + ";";
    if (vector.command == TestVector<Scalar>::start) text += " enable := TRUE;";
    if (vector.command == TestVector<Scalar>::stop) text += " enable := FALSE;";
    if (vector.command == TestVector<Scalar>::datum) text += " datum := TRUE;";
    for (std::size_t i = 0; i < sensors(); ++i)
      text += " " + numbered("reading", i) + " := " + real(vector.readings_degC[i]) + ";";
    for (std::size_t j = 0; j < errors(); ++j)
      text += " " + numbered("expected", j) + " := " + real(vector.offset_um[j]) + ";";
    return text;
  }

  void variables() {
    line("VAR_INPUT");
    line("Enable : BOOL := FALSE; (* rising: start; falling: ramp to zero, off *)");
    line("Datum : BOOL := FALSE; (* rising: the work offset is probed now; while off: forget the zero *)");
    line("Heartbeat : UDINT := 0; (* changes whenever the readings are new; 0 from the start: there is none *)");
    line("Periods : UDINT := 1; (* of the cycle since the call before; 0: nothing moves *)");
    for (std::size_t i = 0; i < sensors(); ++i)
      line(reading_of(i) + " : " + type() + " := 0.0; (* degC, " + comment_text(request_.trained.temperatures[i]) +
           " *)");
    this->feature_inputs();
    for (std::size_t j = 0; j < errors() && request_.wishes.probe; ++j) {
      line(probe_of(j) + " : " + type() + " := 0.0; (* um, the whole thermal error measured by a probe: what is left " +
           (settings_.sign == OutputSign::correction ? "less" : "and") + " the offset applied *)");
      line(probe_of(j) + "_new : BOOL := FALSE; (* rising: it was read now *)");
    }
    line("END_VAR");
    line("VAR_OUTPUT");
    for (std::size_t j = 0; j < errors(); ++j)
      line(output(j) + " : " + type() + " := 0.0; (* " + request_.unit.name + ", the " +
           sign_name(request_.wishes.sign) + ", " + comment_text(request_.trained.errors[j]) + " *)");
    line(
        "Status : UDINT := 0; (* State_now + 16 outside domain + 32 clamped + 64 slewing + 256 * Sensor + 65536 * "
        "Fault + 1048576 * sensors not used + 268435456 * Zero_source + 1073741824 * Zero_pending" +
        std::string(request_.wishes.probe ? " + 2147483648 * a probe corrects *)" : " *)"));
    line(
        "State_now : UDINT := 0; (* 0 off, 1 starting, 2 tracking, 3 substituting, 4 holding, 5 fallback, 6 stopping, "
        "7 no datum *)");
    line("Sensor : UDINT := 0; (* first sensor not used, from 1; 0 none *)");
    line(
        "Fault : UDINT := 0; (* 1 not finite, 2 range, 3 rate, 4 stuck, 5 recovering, 6 no reference, 7 stale, 8 "
        "disagrees *)");
    line("Zero_source : UDINT := 0; (* 0 none, or off; 1 first samples, 2 datum, 3 retained *)");
    line("Zero_pending : BOOL := FALSE; (* a zero was asked for and is not there yet *)");
    line("Ok : BOOL := FALSE; (* all sensors used, in the training domain, not clamped *)");
    for (std::size_t j = 0; j < errors() && request_.wishes.probe; ++j)
      line(probe_of(j) +
           "_told : UDINT := 4; (* of the last reading: 0 taken, 1 no number, 2 too large, 3 to be repeated, "
           "4 nothing is predicted to compare with *)");
    line("END_VAR");
    retained_variables();
    line("VAR");
    line("running, awake, forget, ask, datum_before, has_heartbeat, stale, newcomer, all_frozen : BOOL := FALSE;");
    line("all_read, referenced, together, vouched, complete, same, sample_good, agreed : BOOL := FALSE;");
    line("usable, outside, clamped, slewing, follow, at_zero, shown_pending : BOOL := FALSE;");
    line("state, steps, silent_steps, heartbeat_before, all_still, away, held_steps : UDINT := 0;");
    line("unused, first_unused, first_fault, fault_now, outcome, status_word : UDINT := 0;");
    line("zero_from, wanted_from, shown_from, taken, waited_steps, missing : UDINT := 0;");
    line(
        "change, total, others, share, t_squared, spe, residual, expectation, centre, target, wanted, slew, swap, "
        "lowest, highest, check_now : " +
        type() + " := 0.0;");
    std::string ranks;
    for (std::size_t k = 0; k < samples(); ++k) ranks += (k == 0 ? "" : ", ") + numbered("rank", k);
    line(ranks + " : " + type() + " := 0.0;");
    for (std::size_t i = 0; i < sensors(); ++i) {
      std::string reals;
      for (const char* what : {"reading", "others", "trusted_at", "value"}) reals += of(i, what) + ", ";
      for (std::size_t k = 0; k < samples(); ++k) reals += (k == 0 ? "" : ", ") + window(i, k);
      line(reals + " : " + type() + " := 0.0;");
      line(of(i, "still") + ", " + of(i, "bad") + ", " + of(i, "good") + ", " + of(i, "fault") + " : UDINT := 0;");
      line(of(i, "seen") + ", " + of(i, "lost") + ", " + of(i, "returning") + ", " + of(i, "trusted") + ", " +
           of(i, "counted") + " : BOOL := FALSE;");
    }
    for (std::size_t a = 0; a < components(); ++a) line(numbered("score", a) + " : " + type() + " := 0.0;");
    for (std::size_t j = 0; j < errors(); ++j)
      line(numbered("offset", j) + ", " + numbered("demand", j) + ", " + numbered("other", j) + " : " + type() +
           " := 0.0;");
    this->feature_variables();
    probe_variables();
    line("END_VAR");
  }

  /// Enable and Datum.
  void commands() {
    line("(* Enable and Datum *)");
    set("forget", "FALSE");
    set("ask", "FALSE");
    line("IF Enable AND NOT running AND NOT awake THEN");
    line("(* after power-up: the zero that was kept, where it is whole and this model's *)");
    set("awake", "TRUE");
    set("zero_from", "0");
    line("IF zero_mark = " + valid_mark + " AND zero_model = " + std::to_string(model_.identity) + " THEN");
    check_sum();
    set_if("zero_check = check_now" + std::string(lags() > 0 ? " AND Off_periods < 4294967295" : ""), "zero_from", "3");
    line("END_IF;");
    set("forget", "zero_from = 0");
    if (derived()) {
      line("IF forget THEN");
      this->forget_session();
      line("ELSE");
      this->restore_session();
      line("END_IF;");
    }
    line("END_IF;");
    line("IF running AND NOT Enable AND state <> 0 THEN");
    set("state", "6");
    set("forget", "wanted_from = 2");
    set("wanted_from", "0");
    line("END_IF;");
    line("IF Datum AND NOT datum_before THEN");
    line("IF (state = 0 OR state = 6) AND NOT (Enable AND NOT running) THEN forget := TRUE; ELSE ask := TRUE; END_IF;");
    line("END_IF;");
    set("datum_before", "Datum");
    line("IF forget THEN");
    set("zero_mark", "0");
    for (std::size_t i = 0; i < sensors(); ++i) {
      set(of(i, "zero"), "0.0");
      set(of(i, "zero_known"), "FALSE");
    }
    set("zero_through", "FALSE");
    set("zero_from", "0");
    set("wanted_from", "0");
    line("END_IF;");
    line("IF Enable AND NOT running THEN");
    for (std::size_t i = 0; i < sensors(); ++i) {
      for (const char* quantity : {"reading", "others", "trusted_at"}) set(of(i, quantity), "0.0");
      for (const char* counter : {"still", "bad", "good", "fault"}) set(of(i, counter), "0");
      for (const char* flag : {"seen", "lost", "returning", "trusted"}) set(of(i, flag), "FALSE");
    }
    set("held_steps", "0");
    set("silent_steps", "0");
    set("has_heartbeat", "FALSE");
    drop_probe();
    set("state", "1");
    nothing_to_tell();
    if (model_.rise && settings_.zero.policy == ZeroPolicy::first) {
      line("IF zero_from = 0 THEN");
      request("1");
      line("END_IF;");
    }
    show_zero();
    line("END_IF;");
    set("running", "Enable");
    line("IF ask THEN");
    request("2");
    line("END_IF;");
  }

  void nothing_to_tell() {
    for (const char* flag : {"outside", "clamped", "slewing"}) set(flag, "FALSE");
    if (request_.wishes.probe) set("probe_corrects", "FALSE");
    for (const char* counter : {"unused", "first_unused", "first_fault"}) set(counter, "0");
  }

  /// outcome: 0 no demand, 1 demand, 2 demand of a substitute, 3 no zero.
  void judge() {
    count_unused();
    set("outcome", "0");
    if (model_.rise) {
      line("IF zero_from = 0 THEN");
      set_if("wanted_from = 0 OR state = 7", "outcome", "3");
      line("ELSIF usable THEN");
    } else {
      line("IF usable THEN");
    }
    line("(* the model, or the one made without the lost sensor *)");
    values();
    line("IF unused = 0 THEN");
    equation(model_.equation, "demand");
    for (std::size_t i = 0; i < sensors(); ++i) {
      if (!model_.has_substitute[i]) continue;
      line("ELSIF first_unused = " + number(i) + " THEN");
      equation(model_.substitutes[i], "demand");
    }
    line("END_IF;");
    set("follow", "TRUE");
    for (std::size_t j = 0; j < errors(); ++j) set_if("NOT (" + finite(numbered("demand", j)) + ")", "follow", "FALSE");
    if (settings_.domain_policy != DomainPolicy::ignore) apply_domain();
    line("IF follow THEN");
    line("IF unused = 0 THEN outcome := 1; ELSE outcome := 2; END_IF;");
    line("END_IF;");
    line("END_IF;");
  }

  /// next_state() for the events of a step.
  void advance() {
    line("(* the next state *)");
    line("IF outcome = 0 THEN");
    count("held_steps");
    line("ELSE");
    set("held_steps", "0");
    line("END_IF;");
    line("IF state <> 6 THEN");
    line("IF outcome = 3 THEN");
    set("state", "7");
    line("ELSIF outcome = 1 THEN");
    set("state", "2");
    line("ELSIF outcome = 2 THEN");
    set("state", "3");
    line("ELSIF state <> 7 THEN");
    line("IF held_steps > " + std::to_string(settings_.hold_steps) + " THEN");
    set("state", "5");
    line("ELSIF state = 2 OR state = 3 THEN");
    set("state", "4");
    line("END_IF;");
    line("END_IF;");
    line("END_IF;");
  }

  void move() {
    line("(* clamp and slew *)");
    set("at_zero", "TRUE");
    for (std::size_t j = 0; j < errors(); ++j) {
      const std::string clamp = real(settings_.outputs[j].clamp_um), offset = numbered("offset", j);
      set("target", "0.0");
      line("IF state = 2 OR state = 3 THEN");
      std::string demand = numbered("demand", j);
      if (request_.wishes.probe) {
        set("corrected", demand);
        line("IF " + of_probe(j, "taken") + " AND " + of_steps(of_probe(j, "age")) +
             " <= " + real(settings_.probe[j].longest_s) + " THEN");
        set("corrected", "corrected + " + of_probe(j, "held"));
        set("probe_corrects", "TRUE");
        line("END_IF;");
        demand = "corrected";
      }
      set("wanted", (settings_.sign == OutputSign::correction ? "-" : "") + demand);
      line("IF wanted >= (-" + clamp + ") AND wanted <= " + clamp + " THEN");
      set("target", "wanted");
      line("ELSIF wanted > " + clamp + " THEN");
      set("target", clamp);
      line("ELSIF wanted < (-" + clamp + ") THEN");
      set("target", "-" + clamp);
      line("END_IF;");
      set_if("NOT (target = wanted)", "clamped", "TRUE");
      line("ELSIF state = 1 OR state = 4 THEN");
      set("target", offset);
      line("END_IF;");
      set("slew", real(settings_.outputs[j].slew_um_per_step) + " * " + of_steps("steps"));
      set("change", "target - " + offset);
      line("IF change >= (-slew) AND change <= slew THEN");
      set(offset, "target");
      line("ELSIF change > 0.0 THEN");
      set(offset, offset + " + slew");
      line("ELSE");
      set(offset, offset + " - slew");
      line("END_IF;");
      set_if("NOT (" + offset + " = target)", "slewing", "TRUE");
      set_if("NOT (" + offset + " = 0.0)", "at_zero", "FALSE");
    }
    set_if("at_zero AND state = 6", "state", "0");
  }

  void outputs() {
    line("(* what comes out *)");
    for (std::size_t j = 0; j < errors(); ++j)
      set(output(j), numbered("offset", j) + " * " + real(static_cast<Scalar>(request_.unit.per_um)));
    set("status_word", "state + 256 * first_unused + 65536 * first_fault + 1048576 * unused + 268435456 * shown_from");
    set_if("outside", "status_word", "status_word + 16");
    set_if("clamped", "status_word", "status_word + 32");
    set_if("slewing", "status_word", "status_word + 64");
    set_if("shown_pending", "status_word", "status_word + 1073741824");
    if (request_.wishes.probe) set_if("probe_corrects", "status_word", "status_word + 2147483648");
    set("Status", "status_word");
    set("State_now", "state");
    set("Sensor", "first_unused");
    set("Fault", "first_fault");
    set("Zero_source", "shown_from");
    set("Zero_pending", "shown_pending");
    set("Ok", "state = 2 AND NOT outside AND NOT clamped");
  }
};

template <class Scalar>
std::string st_compensator(const ExportRequest& request) {
  const auto model = narrow_model<Scalar>(request.trained, request.wishes.domain_limit);
  const auto settings = settings_for<Scalar>(request.trained, request.wishes);
  StWriter<Scalar> writer(request, model, settings);
  return writer.compensator() + '\n' + writer.test();
}

const char* const advice =
    "   Enable rising starts, falling ramps to zero. Datum rising, when the work offset is probed, makes the readings\n"
    "   that follow the zero: VAR RETAIN keeps it over a power cycle (TwinCAT: write VAR PERSISTENT), and nothing "
    "else\n"
    "   of the instance may be kept. zero_check is a sum with weights: 1 where zero_through, and the square root of "
    "the\n"
    "   i-th prime times the zero of sensor i, less 10000 where it has none.\n"
    "   A reading that is missing is handed over as NaN. Where a comparison with NaN stops the controller (TwinCAT:\n"
    "   floating point exceptions of the task), switch that off, or hand over 1.0E6 instead: it counts as out of "
    "range.\n";

}  // namespace

ControllerSource export_st(const ExportRequest& request) {
  const std::string code = request.single_precision ? st_compensator<float>(request) : st_compensator<double>(request);
  if (st_uses(code, request.name) != 2)  // the block, and the instance in its test
    throw Error("name", "'" + request.name + "', which the function block calls something of its own", {},
                "try " + identifiers({"thermal_" + request.name})[0]);
  return "(* Thermal compensation, IEC 61131-3 Structured Text: call " + request.name + " every " +
         real_text(request.wishes.period_s) + " s. " + request.name + "_test tests it where it runs.\n" + advice +
         fact_comment(request, "  ") + "*)\n" + code;
}

}  // namespace thermfit::cli
