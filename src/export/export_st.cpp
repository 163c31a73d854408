#include "export/source_text.hpp"
#include "export/st_features.hpp"
#include "export/st_text.hpp"
#include "export/test_vectors.hpp"
#include "thermfit/error.hpp"

/// IEC 61131-3 as every compiler takes it: scalars only, every loop written out, comparisons that NaN fails
/// (`x >= lo AND x <= hi`), no bit operations. The arithmetic is that of controller/compensator.hpp, in its order.
///
/// The zero of datum.hpp lives in VAR RETAIN. There are no bytes to digest, so its check is a sum: 1 where the
/// intercept drops out, plus the square root of the i-th prime times the zero of sensor i, less 1e4 where it has none.
/// Those roots are independent over the rationals: two zeros of rounded readings, one torn out of the other, never add
/// up to the same. Of a model with lags it covers where they are too, and is made anew in each step.

namespace thermfit::cli {
namespace {

template <class Scalar>
class StWriter : StFeatures<Scalar> {
  using Features = StFeatures<Scalar>;
  using Features::derived;
  using Features::input;
  using Features::inputs;
  using Features::lags;
  using Features::model_;
  using Features::settings_;
  using Text = StText<Scalar>;
  using Text::count;
  using Text::finite;
  using Text::line;
  using Text::most_steps;
  using Text::number;
  using Text::numbered;
  using Text::of;
  using Text::of_steps;
  using Text::real;
  using Text::set;
  using Text::set_if;
  using Text::type;
  using Text::within;
  using Text::without_sign;

 public:
  using Device = HostCompensator<Scalar>;

  StWriter(const ExportRequest& request, const typename Device::Model& model, const typename Device::Settings& settings)
      : Features(model, settings),
        request_(request),
        sensors_(identifiers(request.trained.temperatures)),
        errors_(identifiers(request.trained.errors)) {}

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
    return Text::taken();
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
    return Text::taken();
  }

 private:
  inline static const std::string valid_mark = "1413891121";  // RetainedDatum::valid_mark

  std::size_t sensors() const { return sensors_.size(); }
  std::size_t errors() const { return errors_.size(); }
  std::size_t components() const { return model_.domain.rotations.size(); }
  std::string reading_of(std::size_t i) const { return "Temperature_" + sensors_[i]; }
  std::string output(std::size_t j) const { return "Offset_" + errors_[j] + "_" + request_.unit.identifier; }

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

  /// Compensator::has_reference.
  std::string has_reference(std::size_t i) const {
    return model_.rise ? of(i, "zero_known") : "(zero_from = 0 OR " + of(i, "zero_known") + ")";
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

  /// The readings less the zero, which is 0 where there is none.
  void values() {
    for (std::size_t i = 0; i < sensors(); ++i) set(of(i, "value"), of(i, "reading") + " - " + of(i, "zero"));
    this->derive_values();
  }
  /// The same as the training domain takes them.
  void domain_values() {
    if (model_.rise) return values();
    for (std::size_t i = 0; i < sensors(); ++i) set(of(i, "value"), of(i, "reading"));
  }

  /// Whether the intercept drops out.
  std::string through() const { return model_.rise ? "zero_through" : "zero_from <> 0"; }

  void equation(const typename Device::Model::Equation& from, const std::string& result) {
    for (std::size_t j = 0; j < errors(); ++j) {
      const std::string sum = numbered(result, j);
      line("IF " + through() + " THEN " + sum + " := 0.0; ELSE " + sum + " := " + real(from.intercept_um[j]) +
           "; END_IF;");
      for (std::size_t i = 0; i < inputs(); ++i)
        set(sum, sum + " + " + real(from.coefficients[j][i]) + " * " + input(i));
    }
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

  std::string standardised(std::size_t i) const {
    return "(" + input(i) + " - " + real(model_.domain.mean[i]) + ") * " + real(model_.domain.inverse_scale[i]);
  }

  void apply_domain() {
    line("IF follow THEN");
    line("(* how far from the samples of training, a missing sensor at what the others let expect *)");
    domain_values();
    if (derived())
      fill_in_channels();
    else
      for (std::size_t i = 0; i < sensors(); ++i) {
        if (!model_.has_substitute[i]) continue;
        line("IF first_unused = " + number(i) + " THEN");
        fill_in(i);
        line("END_IF;");
      }
    share_inside();
    line("IF share < 1.0 THEN");
    set("outside", "TRUE");
    if (settings_.domain_policy == DomainPolicy::shrink)
      for (std::size_t j = 0; j < errors(); ++j) {
        const std::string demand = numbered("demand", j), intercept = real(model_.equation.intercept_um[j]);
        set("centre", real(model_.centre_um[j]));
        line("IF " + through() + " THEN");
        if (model_.rise) {
          set("centre", "centre - " + intercept);
        } else {
          set("others", intercept);
          for (std::size_t i = 0; i < sensors(); ++i)
            set("others", "others + " + real(model_.equation.coefficients[j][i]) + " * " + of(i, "zero"));
          set("centre", "centre - others");
        }
        line("END_IF;");
        set(demand, "centre + share * (" + demand + " - centre)");
      }
    if (settings_.domain_policy == DomainPolicy::hold) set("follow", "FALSE");
    line("END_IF;");
    line("END_IF;");
  }

  /// The channels of the lost sensor, first at their means: then the scores are those of the others.
  void fill_in_channels() {
    const auto for_each_lost = [&](const auto& write) {
      for (std::size_t i = 0; i < sensors(); ++i) {
        if (!model_.has_substitute[i]) continue;
        line("IF first_unused = " + number(i) + " THEN");
        write(i);
        line("END_IF;");
      }
    };
    line("IF unused > 0 THEN");
    for_each_lost([&](std::size_t i) {
      for (const std::size_t f : this->made_of(i)) set(input(f), real(model_.domain.mean[f]));
    });
    scores();
    for_each_lost([&](std::size_t i) { this->fill_in_all(i); });
    line("END_IF;");
  }

  void scores() {
    for (std::size_t a = 0; a < components(); ++a) {
      const std::string score = numbered("score", a);
      set(score, "0.0");
      for (std::size_t i = 0; i < inputs(); ++i)
        set(score, score + " + " + real(model_.domain.rotations[a][i]) + " * (" + standardised(i) + ")");
    }
  }

  /// DomainGuard::fill_in.
  void fill_in(std::size_t sensor) {
    const auto& domain = model_.domain;
    Scalar own = 0;
    set("expectation", "0.0");
    for (std::size_t a = 0; a < components(); ++a) {
      set("residual", "0.0");
      for (std::size_t i = 0; i < sensors(); ++i)
        if (i != sensor) set("residual", "residual + " + real(domain.rotations[a][i]) + " * (" + standardised(i) + ")");
      set("expectation", "expectation + " + real(domain.loadings[a][sensor]) + " * residual");
      own += domain.loadings[a][sensor] * domain.rotations[a][sensor];
    }
    const std::string mean = real(domain.mean[sensor]);
    set(of(sensor, "value"),
        own < Scalar(0.99) ? mean + " + (expectation / " + real(1 - own) + ") / " + real(domain.inverse_scale[sensor])
                           : mean);
  }

  /// DomainGuard::share_inside.
  void share_inside() {
    const auto& domain = model_.domain;
    set("t_squared", "0.0");
    set("spe", "0.0");
    set("share", "1.0");
    for (std::size_t a = 0; a < components(); ++a) {
      const std::string score = numbered("score", a);
      set(score, "0.0");
      for (std::size_t i = 0; i < inputs(); ++i)
        set(score, score + " + " + real(domain.rotations[a][i]) + " * (" + standardised(i) + ")");
      set("t_squared", "t_squared + " + score + " * " + score + " * " + real(domain.inverse_score_variance[a]));
    }
    for (std::size_t i = 0; i < inputs(); ++i) {
      set("residual", standardised(i));
      for (std::size_t a = 0; a < components(); ++a)
        set("residual", "residual - " + real(domain.loadings[a][i]) + " * " + numbered("score", a));
      set("spe", "spe + residual * residual");
    }
    if (domain.t2_limit > 0)
      set_if("NOT (t_squared <= " + real(domain.t2_limit) + ")", "share", real(domain.t2_limit) + " / t_squared");
    if (domain.spe_limit > 0) {
      line("IF NOT (spe <= " + real(domain.spe_limit) + ") THEN");
      set_if("NOT (share <= " + real(domain.spe_limit) + " / spe)", "share", real(domain.spe_limit) + " / spe");
      line("END_IF;");
    }
    set_if("NOT (share >= 0.0 AND share <= 1.0)", "share", "0.0");
    set_if("share < 1.0", "share", "SQRT(share)");
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

  void show_zero() {
    set("shown_from", "zero_from");
    set("shown_pending", "wanted_from <> 0");
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

  const ExportRequest& request_;
  std::vector<std::string> sensors_, errors_;
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
