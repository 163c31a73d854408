#include "report/diagnosis_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cli/table.hpp"
#include "report/diagnosis_words.hpp"
#include "report/fitted_batches_text.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

constexpr std::size_t width = 80;

std::string percent(double share, int decimals = 0) { return fixed_text(100 * share, decimals) + " %"; }

/// Probabilities are never told as certain.
std::string confidence_text(double confidence) {
  return confidence > .99 ? "above 99 %" : confidence < .01 ? "below 1 %" : percent(confidence);
}

std::string size_text(double rms) { return std::isnan(rms) ? "-" : fixed_text(rms, std::abs(rms) < 10 ? 2 : 1); }

std::string title_of(const std::string& effect, const std::string& location, const std::string& driver) {
  std::string text = effect;
  if (!location.empty()) text += " at " + location;
  if (!driver.empty()) text += " (driven by " + driver + ")";
  return text;
}

std::string parameter_text(const Estimate& one) {
  std::string text = one.name + " = " + general_text(one.value, 3);
  if (one.standard_error >= 0) text += " +- " + general_text(one.standard_error, 2);
  return one.unit.empty() ? text : text + ' ' + one.unit;
}

std::string named_output(const Gap& gap) { return gap.output.empty() ? "all temperatures" : gap.output; }

/// "the gap in Z goes from 2.70 to 0.33 um rms on batches not used for fitting, a shrink of 88 % (95 % interval 83 to
/// 91
/// %); the noise is 0.27 um."
std::string shrink_text(const Gap& gap) {
  const std::string unit = ' ' + gap.unit;
  return "the gap in " + named_output(gap) + " goes from " + size_text(gap.rms.calibrated) + " to " +
         size_text(gap.rms.with_effect) + unit + " rms" +
         (gap.held_out ? " on batches not used for fitting, a shrink of " + fixed_text(gap.shrink_percent, 0) +
                             " % (95 % interval " + fixed_text(gap.shrink_ci95_percent.low, 0) + " to " +
                             fixed_text(gap.shrink_ci95_percent.high, 0) + " %)"
                       : " on the one batch it was fitted to, which proves nothing") +
         "; the noise is " + size_text(gap.rms.noise) + unit + ".";
}

/// A fault of a thermometer shows in its own reading, whatever the gap is told for: " T7 itself goes from 1.31 to 0.06
/// K." An offset counts from the machine as given, since calibration moves offsets too.
std::string own_reading(const Diagnosis& diagnosis) {
  const FoundEffect& found = diagnosis.effects[0];
  for (const ChannelGap& one : diagnosis.gap.per_sensor)
    if (one.channel == found.location && one.channel != diagnosis.gap.output)
      return " " + one.channel + " itself goes from " +
             size_text(found.against_as_given ? one.rms.as_simulated : one.rms.calibrated) + " to " +
             size_text(one.rms.with_effect) + " " + one.unit + ".";
  return "";
}

std::string moved_most(const Diagnosis& diagnosis) {
  std::vector<std::string> parts;
  for (const CalibrationMove& move : diagnosis.calibration)
    if (parts.size() < 3 && std::abs(move.prior_sds) >= 1)
      parts.push_back(move.parameter + " (" + (move.prior_sds > 0 ? "+" : "") + fixed_text(move.prior_sds, 1) +
                      " prior sd)");
  return parts.empty() ? "" : " Moved most: " + joined(parts) + ".";
}

/// "at head_front acts a coolant film (coolant driven by pump, confidence 88 %)".
std::string acts_text(const FoundEffect& found) {
  std::string text = "at " + (found.location == "all" ? "all nodes" : found.location);
  if (!found.same_place.empty()) text += " (or " + joined(found.same_place, " or ") + ")";
  return text + " " + (found.meaning.empty() ? "acts an effect of its own" : found.meaning) + " (" + found.effect +
         (found.driver.empty() ? "" : " driven by " + found.driver) + ", confidence " +
         confidence_text(found.confidence) + ")";
}

/// Prior deviations from which a calibrated number says something about its part or thermometer.
constexpr double telling_sds = 3;

/// Calibrated numbers that are further off than the machine file lets expect.
std::vector<std::string> moved_far(const Diagnosis& diagnosis) {
  std::vector<std::string> lines;
  for (const CalibrationMove& move : diagnosis.calibration) {
    if (!move.pinned || std::abs(move.prior_sds) <= telling_sds) continue;
    lines.push_back(move.parameter + ": " + general_text(move.to, 4) + (move.unit.empty() ? "" : " " + move.unit) +
                    " instead of " + general_text(move.from, 4) + ", " + fixed_text(std::abs(move.prior_sds), 1) +
                    " prior deviations: a wrong number in the machine file, a fault there, or something that it lacks");
  }
  return lines;
}

/// Whether these data could have shown what the simulator lacks, and did not.
bool lacks_nothing(const Diagnosis& diagnosis) {
  return diagnosis.suspected.empty() && diagnosis.weaker_claims.empty() && moved_far(diagnosis).empty();
}

/// Where, when and with what a gap without a name goes.
std::string whereabouts(const Diagnosis& diagnosis) {
  std::string text;
  if (!diagnosis.where.places.empty() && diagnosis.where.places[0].share > 0)
    text +=
        " It lies most at " + diagnosis.where.places[0].name + " (" + percent(diagnosis.where.places[0].share) + ").";
  const ConditionShare* telling = nullptr;
  for (const ConditionShare& one : diagnosis.where.conditions)
    if (one.factor != "batch" && one.share_of_time > .02 && one.share > one.share_of_time &&
        (!telling || one.share - one.share_of_time > telling->share - telling->share_of_time))
      telling = &one;
  if (telling) {
    const std::string level = telling->is_range
                                  ? general_text(telling->range.low, 5) + " to " + general_text(telling->range.high, 5)
                                  : telling->level;
    text += " " + percent(telling->share) + " of it arises at " + telling->factor + " " + level + ", in " +
            percent(telling->share_of_time) + " of the time.";
  }
  return text;
}

/// What is certainly wrong between the sides, and what to do about it.
std::string unlike_sentence(const Diagnosis& diagnosis) {
  std::string text = "The two sides are not written down alike, so that no effect is looked for: ";
  std::vector<std::string> what, remedies;
  for (const DataProblem& one : diagnosis.data_problems) {
    if (!one.certain || one.kind == DataProblem::Kind::datum) continue;
    what.push_back(what_of(one));
    const std::string remedy = remedy_of(one, diagnosis.simulator);
    if (std::find(remedies.begin(), remedies.end(), remedy) == remedies.end()) remedies.push_back(remedy);
  }
  text += joined(what, "; ");
  if (text.back() != '?') text += ".";
  for (std::string& remedy : remedies) {
    if (remedy[0] == '-')
      remedy = "Say " + remedy;
    else
      remedy[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(remedy[0])));
    text += " " + remedy + ".";
  }
  return text;
}

std::string sentence(const Diagnosis& diagnosis) {
  if (diagnosis.unlike_sides) return unlike_sentence(diagnosis);
  const Gap& gap = diagnosis.gap;
  const std::string unit = ' ' + gap.unit;
  switch (diagnosis.verdict) {
    case Verdict::none:
      return "There is no gap to explain: in " + named_output(gap) + " the simulation is off by " +
             size_text(gap.rms.as_simulated) + unit + " rms, the noise is " + size_text(gap.rms.noise) + unit + ".";
    case Verdict::miscalibration:
      return (gap.held_out ? std::string("The simulator is miscalibrated") +
                                 (lacks_nothing(diagnosis) ? " and lacks nothing" : "") + ": its own parameters take "
                           : "The simulator's own parameters can close the gap: they take ") +
             named_output(gap) + " from " + size_text(gap.rms.as_simulated) + " to " + size_text(gap.rms.calibrated) +
             unit + " rms" +
             (gap.held_out ? " on batches not used for fitting"
                           : " on the one batch they were fitted to, which proves nothing") +
             "; the noise is " + size_text(gap.rms.noise) + unit + "." + moved_most(diagnosis);
    case Verdict::unknown:
      if (!diagnosis.parts.empty())
        return "The gap is real and part of its cause is found: something acts at " + diagnosis.parts[0].location +
               (diagnosis.parts[0].driver.empty() ? "" : ", driven by " + diagnosis.parts[0].driver) +
               ", and its nearest law in the catalogue, " + diagnosis.parts[0].effect + ", closes " +
               percent(diagnosis.parts[0].closes) +
               " of the squared gap on batches not used for fitting. The rest has "
               "no name: a law of another shape there, or another cause beside it." +
               whereabouts(diagnosis);
      return "The gap is real and has no name: in " + named_output(gap) + " calibration leaves " +
             size_text(gap.rms.calibrated) + unit + " rms, the noise is " + size_text(gap.rms.noise) + unit +
             ", and nothing in the catalogue closes it" + (gap.held_out ? " on batches not used for fitting." : ".") +
             whereabouts(diagnosis);
    case Verdict::effect:
    case Verdict::ambiguous:
      break;
  }
  std::string text;
  for (const FoundEffect& found : diagnosis.effects) {
    text += (text.empty() ? "" : ", and ") + acts_text(found);
  }
  text += ": " + shrink_text(gap) + own_reading(diagnosis);
  if (diagnosis.verdict == Verdict::ambiguous) return "Several explanations fit these data. The best: " + text;
  text[0] = 'A';
  return text;
}

class Sections {
 public:
  void add(const std::string& title, const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    text += '\n' + title + '\n';
    for (const std::string& line : lines) text += wrap(" - " + line, width, 3);
  }
  std::string text;
};

/// What is not named, and why it is told all the same.
std::vector<std::string> suspected(const Diagnosis& diagnosis) {
  std::vector<std::string> lines;
  for (const FoundEffect& found : diagnosis.suspected) {
    std::string line = title_of(found.effect, found.location, found.driver) + ", " + confidence_text(found.confidence) +
                       ": the best account of what is left, not beyond doubt; closes " + percent(found.closes) +
                       " of it";
    for (const Rival& rival : found.alternatives)
      line += "; or " + title_of(rival.effect, rival.location, rival.driver) + ", " + confidence_text(rival.confidence);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<std::string> ruled_out(const Diagnosis& diagnosis) {
  std::vector<std::string> lines;
  std::size_t more = 0;
  for (const RuledOut& one : diagnosis.ruled_out) {
    if (one.by == RuledOutBy::remains) continue;
    if (lines.size() < 8)
      lines.push_back(title_of(one.effect, one.location, "") + ": " + reason_of(one, diagnosis.gap.held_out));
    else
      ++more;
  }
  if (more > 0) lines.push_back(std::to_string(more) + " more: --json lists them");
  return lines;
}

/// What closes most of the gap without a name is not ruled out.
std::vector<std::string> nearest_accounts(const Diagnosis& diagnosis) {
  std::vector<std::string> lines;
  for (const RuledOut& one : diagnosis.ruled_out)
    if (one.by == RuledOutBy::remains)
      lines.push_back(title_of(one.effect, one.location, "") + ": " + reason_of(one, diagnosis.gap.held_out));
  return lines;
}

std::vector<std::string> not_told_apart(const Diagnosis& diagnosis) {
  std::vector<std::string> lines;
  for (const FoundEffect& found : diagnosis.effects) {
    for (const Rival& rival : found.alternatives)
      lines.push_back(title_of(rival.effect, rival.location, rival.driver) + ", " + confidence_text(rival.confidence) +
                      " against " + confidence_text(found.confidence) + " for " +
                      title_of(found.effect, found.location, ""));
    if (!found.same_place.empty())
      lines.push_back(found.effect + ": the place may as well be " + joined(found.same_place, ", "));
  }
  if (!diagnosis.where.agrees) lines.push_back(difference_of(diagnosis.where));
  return lines;
}

std::vector<std::string> next_experiment(const NextExperiment& next) {
  std::vector<std::string> lines;
  double hours = 0;
  for (const PlannedBlock& block : next.plan) {
    lines.push_back(schedule_of(block) + ": " + settings_of(block) + " (" + fixed_text(block.machine_hours, 1) +
                    " machine hours)");
    hours += block.machine_hours;
  }
  if (const std::string remark = remark_of(next); !remark.empty()) lines.push_back(remark);
  if (next.separates.size() > 1 && std::isfinite(next.confusion_after))
    lines.push_back("probability of taking one for the other: " + confidence_text(next.confusion_before) + " now, " +
                    confidence_text(next.confusion_after) + " after these " + fixed_text(hours, 1) + " hours");
  return lines;
}

std::vector<std::string> data_problems(const Diagnosis& diagnosis) {
  std::vector<std::string> lines;
  for (const DataProblem& one : diagnosis.data_problems) {
    const std::string remedy = remedy_of(one, diagnosis.simulator);
    lines.push_back(place_of(one) + ": " + what_of(one) +
                    (remedy.empty() ? "" : (what_of(one).back() == '?' ? " " : "; ") + remedy));
  }
  return lines;
}

std::string remaining_text(const Diagnosis& diagnosis) {
  const Remaining& remaining = diagnosis.remaining;
  if (diagnosis.verdict == Verdict::none || remaining.looks.empty()) return "";
  const RemainingLook& first = remaining.looks[0];
  if (remaining.looks.size() == 1 && first.channel.empty() && first.kind == RemainingLook::Kind::noise)
    return "What remains is noise.\n";
  return wrap("What remains: " + size_text(remaining.unexplained) + ' ' + diagnosis.gap.unit +
                  " beyond noise, cause unknown: " + looks_of(remaining, diagnosis.gap.unit) + ".",
              width, 0);
}

std::string gap_table(const Diagnosis& diagnosis) {
  Table table({"gap, rms", "as simulated", "calibrated", "with effect", "noise", "unit"});
  const bool named = !diagnosis.effects.empty();
  const auto add = [&](const std::string& name, const GapLevels& rms, const std::string& unit) {
    table.add({name, size_text(rms.as_simulated), size_text(rms.calibrated), named ? size_text(rms.with_effect) : "-",
               size_text(rms.noise), unit});
  };
  add(output_name(diagnosis.gap), diagnosis.gap.rms, diagnosis.gap.unit);
  if (!diagnosis.gap.per_sensor.empty()) table.rule();
  for (const ChannelGap& one : diagnosis.gap.per_sensor)
    if (one.channel != diagnosis.gap.output) add(one.channel, one.rms, one.unit);
  if (!diagnosis.gap.per_batch.empty()) table.rule();
  for (const BatchGap& one : diagnosis.gap.per_batch)
    add(output_name(diagnosis.gap) + " in " + one.batch, one.rms, diagnosis.gap.unit);
  return table.text();
}

std::string transfer_table(const Transfer& transfer) {
  if (transfer.points.empty()) return "";
  Table table({"trained on simulated, scored on real", "as simulated", "calibrated", "with effect"});
  const auto row = [&](const std::string& name, const std::array<double, 3>& values) {
    table.add({name, size_text(values[0]), size_text(values[1]), size_text(values[2])});
  };
  row("S_mean, um (points " + joined(transfer.points, " ") + ")", transfer.S_mean);
  row("S_std, um", transfer.S_std);
  return '\n' + table.text();
}

std::string period_text(Interval minutes) {
  if (std::isinf(minutes.low)) return "offset of the whole batch";
  if (std::isinf(minutes.high)) return "longer than " + general_text(minutes.low, 4) + " min";
  return general_text(minutes.low, 4) + " to " + general_text(minutes.high, 4) + " min";
}

std::string where_table(const Where& where) {
  Table table({"where the calibrated gap lies", "", "share", "of time"});
  table.left(1);
  std::string last;
  const auto add = [&](const std::string& kind, const std::string& what, double share, const std::string& time) {
    table.add({kind == last ? "" : kind, what, percent(share), time});
    last = kind;
  };
  for (const NamedShare& one : where.stages)
    if (one.share >= .01) add("stage", one.name, one.share, "");
  std::size_t places = 0;
  for (const NamedShare& one : where.places)
    if (one.share >= .01 && places++ < 6) add("place", one.name, one.share, "");
  for (const ConditionShare& one : where.conditions) {
    const std::string level =
        one.is_range ? general_text(one.range.low, 5) + " to " + general_text(one.range.high, 5) : one.level;
    add(one.factor, level, one.share, percent(one.share_of_time));
  }
  for (const PeriodShare& one : where.frequency)
    if (one.share >= .005) add("period", period_text(one.period_min), one.share, "");
  std::string text = '\n' + table.text();
  if (where.chain.known)
    text += wrap("The displacement gap is " + size_text(where.chain.total_um) +
                     " um; with measured temperatures in the expansion sum " + size_text(where.chain.expansion_um) +
                     " um of it remains (expansion and probe), the temperatures carry " +
                     size_text(where.chain.temperature_um) + " um.",
                 width, 0);
  return text;
}

std::string calibration_table(const std::vector<CalibrationMove>& moves) {
  Table table({"calibration moved most", "from", "to", "unit", "prior sds"});
  std::size_t rows = 0;
  for (const CalibrationMove& move : moves)
    if (rows < 6 && std::abs(move.prior_sds) >= .5) {
      table.add({move.parameter, general_text(move.from, 4), general_text(move.to, 4), move.unit,
                 fixed_text(move.prior_sds, 1) + (move.pinned ? "" : " (not pinned)")});
      ++rows;
    }
  return rows ? '\n' + table.text() : "";
}

}  // namespace

std::string diagnosis_text(const Diagnosis& diagnosis) {
  std::string text = wrap(sentence(diagnosis), width, 0);
  for (const FoundEffect& found : diagnosis.effects) {
    std::vector<std::string> parameters;
    for (const Estimate& one : found.parameters)
      if (one.standard_error != 0) parameters.push_back(parameter_text(one));  // a chosen scale is no finding
    if (!parameters.empty()) text += wrap(found.effect + ": " + joined(parameters) + ".", width, 0);
  }
  Sections sections;
  if (diagnosis.unlike_sides) {
    sections.add("Data problems", data_problems(diagnosis));
    return text + sections.text + (diagnosis.gap.per_sensor.empty() ? "" : '\n' + gap_table(diagnosis));
  }
  text += remaining_text(diagnosis);
  sections.add("Suspected", suspected(diagnosis));
  sections.add("Calibrated beyond belief", moved_far(diagnosis));
  sections.add("Nearest, but not enough for a name", nearest_accounts(diagnosis));
  sections.add("Ruled out", ruled_out(diagnosis));
  sections.add("Not told apart by these data", not_told_apart(diagnosis));
  sections.add("Next experiment", next_experiment(diagnosis.next_experiment));
  sections.add("Data problems", data_problems(diagnosis));
  std::vector<std::string> claims;
  for (const WeakerClaim& one : diagnosis.weaker_claims) claims.push_back(claim_of(one));
  sections.add("Weaker claims", claims);
  text += sections.text + '\n' + gap_table(diagnosis) + transfer_table(diagnosis.gap.transfer) +
          where_table(diagnosis.where) + calibration_table(diagnosis.calibration);
  if (const std::string batches = fitted_batches_text(diagnosis.fitted_batches); !batches.empty())
    text += '\n' + batches;
  return text;
}

}  // namespace thermfit::cli
