#include "export/source_text.hpp"
#include "export/test_vectors.hpp"

/// IEC 61131-3 as every compiler takes it: scalars only, every loop written out, comparisons that NaN fails
/// (`x >= lo AND x <= hi`), no bit operations. The arithmetic is that of controller/compensator.hpp, in its order.

namespace thermfit::cli {
namespace {

template <class Scalar>
class StWriter {
 public:
  using Device = HostCompensator<Scalar>;

  StWriter(const ExportRequest& request, const typename Device::Model& model, const typename Device::Settings& settings)
      : request_(request),
        model_(model),
        settings_(settings),
        sensors_(identifiers(request.trained.temperatures)),
        errors_(identifiers(request.trained.errors)) {}

  std::string compensator() {
    text_.clear();
    line("FUNCTION_BLOCK " + request_.name);
    variables();
    start_and_stop();
    line("status_word := 0;");
    line("IF state <> 0 THEN");
    guard();
    demand();
    advance();
    move();
    line("status_word := status_word + state;");
    line("END_IF;");
    for (std::size_t j = 0; j < errors_.size(); ++j)
      line(output(j) + " := " + offset(j) + " * " + real(static_cast<Scalar>(request_.unit.per_um)) + ";");
    line("Status := status_word;");
    line("State_now := state;");
    line("Sensor := first_unused;");
    line("Fault := first_fault;");
    line("Ok := state = 2 AND NOT outside AND NOT clamped;");
    line("END_FUNCTION_BLOCK");
    return text_;
  }

  std::string test() {
    text_.clear();
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
    line("enable : BOOL := FALSE;");
    line("difference : " + type() + " := 0.0;");
    for (std::size_t i = 0; i < sensors_.size(); ++i) line("x" + number(i) + " : " + type() + " := 0.0;");
    for (std::size_t j = 0; j < errors_.size(); ++j) line("e" + number(j) + " : " + type() + " := 0.0;");
    line("END_VAR");
    line("IF remaining = 0 AND NOT Done THEN");
    line("vector := vector + 1;");
    line("CASE vector OF");
    for (std::size_t v = 0; v < vectors.size(); ++v) {
      const TestVector<Scalar>& vector = vectors[v];
      std::string row = std::to_string(v + 1) + ": remaining := " + std::to_string(vector.repeat) +
                        "; expected_status := " + std::to_string(vector.status) + ";";
      if (vector.command != TestVector<Scalar>::none)
        row += std::string(" enable := ") + (vector.command == TestVector<Scalar>::start ? "TRUE;" : "FALSE;");
      for (std::size_t i = 0; i < sensors_.size(); ++i)
        row += " x" + number(i) + " := " + real(vector.readings_degC[i]) + ";";
      for (std::size_t j = 0; j < errors_.size(); ++j)
        row += " e" + number(j) + " := " + real(vector.offset_um[j]) + ";";
      line(row);
    }
    line("ELSE");
    line("Done := TRUE;");
    line("END_CASE;");
    line("END_IF;");
    line("IF NOT Done THEN");
    std::string call = "device(Enable := enable";
    for (std::size_t i = 0; i < sensors_.size(); ++i) call += ", " + input(i) + " := x" + number(i);
    line(call + ");");
    line("remaining := remaining - 1;");
    line("IF remaining = 0 AND Failed = 0 THEN");
    line("IF device.Status <> expected_status THEN Failed := vector; END_IF;");
    for (std::size_t j = 0; j < errors_.size(); ++j) {
      const Scalar tolerance = std::is_same_v<Scalar, float> ? Scalar(1e-3) : Scalar(1e-9);
      line("difference := device." + output(j) + " - e" + number(j) + " * " +
           real(static_cast<Scalar>(request_.unit.per_um)) + ";");
      line("IF NOT (difference >= " + real(-tolerance) + " AND difference <= " + real(tolerance) +
           ") THEN Failed := vector; END_IF;");
    }
    line("END_IF;");
    line("END_IF;");
    line("END_FUNCTION_BLOCK");
    return text_;
  }

 private:
  static std::string type() { return std::is_same_v<Scalar, float> ? "REAL" : "LREAL"; }
  static std::string number(std::size_t index) { return std::to_string(index + 1); }
  static std::string real(Scalar value) {
    const std::string text = upper_case(real_text(value));
    return value < 0 ? "(" + text + ")" : text;
  }
  std::string input(std::size_t i) const { return "Temperature_" + sensors_[i]; }
  std::string output(std::size_t j) const { return "Offset_" + errors_[j] + "_" + request_.unit.identifier; }
  static std::string offset(std::size_t j) { return "offset" + number(j); }
  static std::string of(std::size_t i, const char* what) { return "s" + number(i) + "_" + what; }

  /// One line, indented by the blocks that are open.
  void line(const std::string& text) {
    const auto starts = [&](const char* word) { return text.rfind(word, 0) == 0; };
    const bool closed_in_line = text.find("END_IF;") != std::string::npos && !starts("END_IF");
    if ((starts("END_") && !starts("END_FUNCTION")) || starts("ELSE") || starts("ELSIF")) indent_ -= 2;
    text_ += std::string(indent_, ' ') + text + '\n';
    if (!closed_in_line && (starts("IF ") || starts("ELSE") || starts("ELSIF") || starts("CASE") || starts("VAR")))
      indent_ += 2;
  }

  void variables() {
    line("VAR_INPUT");
    line("Enable : BOOL := FALSE; (* rising: start; falling: ramp to zero, off *)");
    for (std::size_t i = 0; i < sensors_.size(); ++i) line(input(i) + " : " + type() + " := 0.0; (* degC *)");
    line("END_VAR");
    line("VAR_OUTPUT");
    for (std::size_t j = 0; j < errors_.size(); ++j)
      line(output(j) + " : " + type() + " := 0.0; (* " + request_.unit.name + ", the " +
           sign_name(request_.wishes.sign) + " *)");
    line(
        "Status : UDINT := 0; (* State_now + 16 outside domain + 32 clamped + 64 slewing + 256 * Sensor + 65536 * "
        "Fault + 1048576 * sensors not used *)");
    line(
        "State_now : UDINT := 0; (* 0 off, 1 starting, 2 tracking, 3 substituting, 4 holding, 5 fallback, 6 stopping "
        "*)");
    line("Sensor : UDINT := 0; (* first sensor not used, from 1; 0 none *)");
    line("Fault : UDINT := 0; (* 1 not finite, 2 range, 3 rate, 4 stuck, 5 recovering, 6 no reference *)");
    line("Ok : BOOL := FALSE; (* all sensors used, in the training domain, not clamped *)");
    line("END_VAR");
    line("VAR");
    line("running, zero_captured, usable, newcomer, outside, clamped, slewing, follow, at_zero : BOOL := FALSE;");
    line("state, status_word, held_steps, unused, first_unused, first_fault, fault_now : UDINT := 0;");
    line("change, total, others, share, t2, spe, residual, target, wanted : " + type() + " := 0.0;");
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      line(of(i, "reading") + ", " + of(i, "others") + ", " + of(i, "zero") + ", " + of(i, "value") + " : " + type() +
           " := 0.0;");
      line(of(i, "still") + ", " + of(i, "bad") + ", " + of(i, "good") + ", " + of(i, "fault") + " : UDINT := 0;");
      line(of(i, "seen") + ", " + of(i, "lost") + ", " + of(i, "zero_known") + " : BOOL := FALSE;");
    }
    for (std::size_t a = 0; a < components(); ++a) line("score" + number(a) + " : " + type() + " := 0.0;");
    for (std::size_t j = 0; j < errors_.size(); ++j)
      line("offset" + number(j) + ", demand" + number(j) + " : " + type() + " := 0.0;");
    line("END_VAR");
  }

  void start_and_stop() {
    line("first_unused := 0;");
    line("first_fault := 0;");
    line("outside := FALSE;");
    line("clamped := FALSE;");
    line("slewing := FALSE;");
    line("IF Enable AND NOT running THEN");
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      for (const char* real_variable : {"reading", "others", "zero"}) line(of(i, real_variable) + " := 0.0;");
      for (const char* counter : {"still", "bad", "good", "fault"}) line(of(i, counter) + " := 0;");
      line(of(i, "seen") + " := FALSE;");
      line(of(i, "lost") + " := FALSE;");
      line(of(i, "zero_known") + " := " + (model_.rise ? "FALSE;" : "TRUE;"));
    }
    line(std::string("zero_captured := ") + (model_.rise ? "FALSE;" : "TRUE;"));
    line("held_steps := 0;");
    line("state := 1;");
    line("END_IF;");
    line("IF running AND NOT Enable AND state <> 0 THEN");
    line("state := 6;");
    line("END_IF;");
    line("running := Enable;");
  }

  void guard() {
    const std::string most = real(std::numeric_limits<Scalar>::max());
    line("(* each reading by itself and by its past *)");
    line("total := 0.0;");
    line("newcomer := FALSE;");
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      const SensorLimits<Scalar>& limits = settings_.sensors[i];
      line(of(i, "fault") + " := 0;");
      line("IF NOT (" + input(i) + " >= (-" + most + ") AND " + input(i) + " <= " + most + ") THEN");
      line(of(i, "fault") + " := 1;");
      line("ELSIF NOT (" + input(i) + " >= " + real(limits.lowest_degC) + " AND " + input(i) +
           " <= " + real(limits.highest_degC) + ") THEN");
      line(of(i, "fault") + " := 2;");
      line("ELSIF " + of(i, "seen") + " THEN");
      line("change := " + input(i) + " - " + of(i, "reading") + ";");
      line("IF change < 0.0 THEN change := -change; END_IF;");
      line("IF NOT (change <= " + real(limits.largest_step_K) + " * UDINT_TO_" + type() + "(" + of(i, "bad") +
           " + 1)) THEN " + of(i, "fault") + " := 3; END_IF;");
      line("END_IF;");
      line("IF " + of(i, "fault") + " = 0 THEN");
      line("IF " + of(i, "seen") + " AND " + input(i) + " = " + of(i, "reading") + " THEN");
      count(of(i, "still"));
      line("ELSE");
      line(of(i, "still") + " := 0;");
      line("END_IF;");
      line("IF NOT " + of(i, "seen") + " THEN newcomer := TRUE; END_IF;");
      line(of(i, "reading") + " := " + input(i) + ";");
      line(of(i, "seen") + " := TRUE;");
      line("END_IF;");
      line("total := total + " + of(i, "reading") + ";");
    }
    line("(* and by the others *)");
    const Scalar others_moved = settings_.patience.others_moved_K * static_cast<Scalar>(sensors_.size() - 1);
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      line("others := total - " + of(i, "reading") + ";");
      line("IF newcomer OR " + of(i, "still") + " = 0 THEN");
      line(of(i, "still") + " := 0;");
      line(of(i, "others") + " := others;");
      if (settings_.sensors[i].stuck_steps > 0 && sensors_.size() > 1) {
        line("ELSIF " + of(i, "fault") + " = 0 AND " + of(i, "still") +
             " >= " + std::to_string(settings_.sensors[i].stuck_steps) + " THEN");
        line("change := others - " + of(i, "others") + ";");
        line("IF change < 0.0 THEN change := -change; END_IF;");
        line("IF change >= " + real(others_moved) + " THEN " + of(i, "fault") + " := 4; END_IF;");
      }
      line("END_IF;");
      line("IF " + of(i, "fault") + " <> 0 THEN");
      line(of(i, "good") + " := 0;");
      count(of(i, "bad"));
      line("IF " + of(i, "bad") + " >= " + std::to_string(settings_.patience.lost_after_steps) + " THEN " +
           of(i, "lost") + " := TRUE; END_IF;");
      line("ELSE");
      line(of(i, "bad") + " := 0;");
      line("IF " + of(i, "lost") + " THEN");
      count(of(i, "good"));
      line(of(i, "lost") + " := " + of(i, "good") + " < " + std::to_string(settings_.patience.recover_after_steps) +
           ";");
      line("IF " + of(i, "lost") + " THEN " + of(i, "fault") + " := 5; END_IF;");
      line("END_IF;");
      line("END_IF;");
    }
  }

  void count(const std::string& counter) {
    line("IF " + counter + " < 1000000000 THEN " + counter + " := " + counter + " + 1; END_IF;");
  }

  void count_unused() {
    line("unused := 0;");
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      line("fault_now := " + of(i, "fault") + ";");
      line("IF fault_now = 0 AND zero_captured AND NOT " + of(i, "zero_known") + " THEN fault_now := 6; END_IF;");
      line("IF fault_now <> 0 THEN");
      line("IF unused = 0 THEN");
      line("first_unused := " + number(i) + ";");
      line("first_fault := fault_now;");
      line("END_IF;");
      line("unused := unused + 1;");
      line("END_IF;");
    }
    line("usable := unused = 0;");
    for (std::size_t i = 0; i < sensors_.size(); ++i)
      if (model_.has_substitute[i])
        line("IF unused = 1 AND first_unused = " + number(i) + " THEN usable := " + of(i, "lost") +
             " OR (zero_captured AND NOT " + of(i, "zero_known") + "); END_IF;");
  }

  void equation(const typename Device::Model::Equation& from) {
    for (std::size_t j = 0; j < errors_.size(); ++j) {
      line("demand" + number(j) + " := " + real(from.intercept_um[j]) + ";");
      for (std::size_t i = 0; i < sensors_.size(); ++i)
        line("demand" + number(j) + " := demand" + number(j) + " + " + real(from.coefficients[j][i]) + " * " +
             of(i, "value") + ";");
    }
  }

  void demand() {
    line("(* which sensors can be used *)");
    count_unused();
    line("IF usable AND NOT zero_captured THEN");
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      line(of(i, "zero_known") + " := " + of(i, "fault") + " = 0;");
      line("IF " + of(i, "zero_known") + " THEN " + of(i, "zero") + " := " + of(i, "reading") + "; END_IF;");
    }
    line("zero_captured := TRUE;");
    count_unused();
    line("END_IF;");
    line("IF unused > 0 THEN status_word := 256 * first_unused + 65536 * first_fault + 1048576 * unused; END_IF;");
    line("follow := FALSE;");
    line("IF zero_captured AND usable THEN");
    line("(* the model, or the one made without the lost sensor *)");
    for (std::size_t i = 0; i < sensors_.size(); ++i)
      line(of(i, "value") + " := " + of(i, "reading") + " - " + of(i, "zero") + ";");
    line("IF unused = 0 THEN");
    equation(model_.equation);
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (!model_.has_substitute[i]) continue;
      line("ELSIF first_unused = " + number(i) + " THEN");
      equation(model_.substitutes[i]);
    }
    line("END_IF;");
    const std::string most = real(std::numeric_limits<Scalar>::max());
    line("follow := TRUE;");
    for (std::size_t j = 0; j < errors_.size(); ++j) {
      const std::string demand = "demand" + number(j);
      line("IF NOT (" + demand + " >= (-" + most + ") AND " + demand + " <= " + most +
           ") THEN follow := FALSE; END_IF;");
    }
    if (settings_.domain_policy != DomainPolicy::ignore) domain();
    line("END_IF;");
  }

  std::size_t components() const { return model_.domain.rotations.size(); }

  void domain() {
    const auto& domain = model_.domain;
    const auto standardised = [&](std::size_t i) {
      return "(" + of(i, "value") + " - " + real(domain.mean[i]) + ") * " + real(domain.inverse_scale[i]);
    };
    line("IF follow AND unused = 0 THEN");
    line("(* how far from the samples of training *)");
    line("t2 := 0.0;");
    line("spe := 0.0;");
    line("share := 1.0;");
    for (std::size_t a = 0; a < components(); ++a) {
      const std::string score = "score" + number(a);
      line(score + " := 0.0;");
      for (std::size_t i = 0; i < sensors_.size(); ++i)
        line(score + " := " + score + " + " + real(domain.rotations[a][i]) + " * (" + standardised(i) + ");");
      line("t2 := t2 + " + score + " * " + score + " * " + real(domain.inverse_score_variance[a]) + ";");
    }
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      line("residual := " + standardised(i) + ";");
      for (std::size_t a = 0; a < components(); ++a)
        line("residual := residual - " + real(domain.loadings[a][i]) + " * score" + number(a) + ";");
      line("spe := spe + residual * residual;");
    }
    if (domain.t2_limit > 0) {
      line("IF NOT (t2 <= " + real(domain.t2_limit) + ") THEN share := " + real(domain.t2_limit) + " / t2; END_IF;");
    }
    if (domain.spe_limit > 0) {
      line("IF NOT (spe <= " + real(domain.spe_limit) + ") THEN");
      line("IF NOT (share <= " + real(domain.spe_limit) + " / spe) THEN share := " + real(domain.spe_limit) +
           " / spe; END_IF;");
      line("END_IF;");
    }
    line("IF NOT (share >= 0.0 AND share <= 1.0) THEN share := 0.0; END_IF;");
    line("IF share < 1.0 THEN");
    line("share := SQRT(share);");
    line("outside := TRUE;");
    line("status_word := status_word + 16;");
    if (settings_.domain_policy == DomainPolicy::shrink)
      for (std::size_t j = 0; j < errors_.size(); ++j) {
        const std::string demand = "demand" + number(j), centre = real(model_.centre_um[j]);
        line(demand + " := " + centre + " + share * (" + demand + " - " + centre + ");");
      }
    if (settings_.domain_policy == DomainPolicy::hold) line("follow := FALSE;");
    line("END_IF;");
    line("END_IF;");
  }

  void advance() {
    line("(* the next state *)");
    line("IF follow THEN");
    line("held_steps := 0;");
    line("IF state <> 6 THEN");
    line("IF unused = 0 THEN state := 2; ELSE state := 3; END_IF;");
    line("END_IF;");
    line("ELSIF held_steps >= " + std::to_string(settings_.hold_steps) + " THEN");
    line("IF state <> 6 THEN state := 5; END_IF;");
    line("ELSE");
    line("held_steps := held_steps + 1;");
    line("IF state = 2 OR state = 3 THEN state := 4; END_IF;");
    line("END_IF;");
  }

  void move() {
    line("(* clamp and slew *)");
    line("at_zero := TRUE;");
    for (std::size_t j = 0; j < errors_.size(); ++j) {
      const std::string clamp = real(settings_.outputs[j].clamp_um), slew = real(settings_.outputs[j].slew_um_per_step);
      const std::string offset = StWriter::offset(j);
      line("target := 0.0;");
      line("IF state = 2 OR state = 3 THEN");
      line(std::string("wanted := ") + (settings_.sign == OutputSign::correction ? "-" : "") + "demand" + number(j) +
           ";");
      line("IF wanted >= (-" + clamp + ") AND wanted <= " + clamp + " THEN");
      line("target := wanted;");
      line("ELSIF wanted > " + clamp + " THEN");
      line("target := " + clamp + ";");
      line("ELSIF wanted < (-" + clamp + ") THEN");
      line("target := -" + clamp + ";");
      line("END_IF;");
      line("IF NOT (target = wanted) THEN clamped := TRUE; END_IF;");
      line("ELSIF state = 1 OR state = 4 THEN");
      line("target := " + offset + ";");
      line("END_IF;");
      line("change := target - " + offset + ";");
      line("IF change >= (-" + slew + ") AND change <= " + slew + " THEN");
      line(offset + " := target;");
      line("ELSIF change > 0.0 THEN");
      line(offset + " := " + offset + " + " + slew + ";");
      line("ELSE");
      line(offset + " := " + offset + " - " + slew + ";");
      line("END_IF;");
      line("IF NOT (" + offset + " = target) THEN slewing := TRUE; END_IF;");
      line("IF NOT (" + offset + " = 0.0) THEN at_zero := FALSE; END_IF;");
    }
    line("IF clamped THEN status_word := status_word + 32; END_IF;");
    line("IF slewing THEN status_word := status_word + 64; END_IF;");
    line("IF at_zero AND state = 6 THEN state := 0; END_IF;");
  }

  const ExportRequest& request_;
  const typename Device::Model& model_;
  const typename Device::Settings& settings_;
  std::vector<std::string> sensors_, errors_;
  std::string text_;
  std::size_t indent_ = 0;
};

template <class Scalar>
std::string st_compensator(const ExportRequest& request) {
  const auto model = narrow_model<Scalar>(request.trained, request.wishes.domain_limit);
  const auto settings = settings_for<Scalar>(request.trained, request.wishes);
  StWriter<Scalar> writer(request, model, settings);
  return writer.compensator() + '\n' + writer.test();
}

}  // namespace

ControllerSource export_st(const ExportRequest& request) {
  return "(* Thermal compensation, IEC 61131-3 Structured Text: call " + request.name + " every " +
         real_text(request.wishes.period_s) + " s. " + request.name + "_test tests it where it runs.\n" +
         fact_comment(request, "  ") + "*)\n" +
         (request.single_precision ? st_compensator<float>(request) : st_compensator<double>(request));
}

}  // namespace thermfit::cli
