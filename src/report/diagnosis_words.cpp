#include "report/diagnosis_words.hpp"

#include <algorithm>
#include <cmath>

#include "thermfit/calibration/warm_start.hpp"
#include "thermfit/diagnosis/sides/reading.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

std::string whole_percent(double share) {
  return std::to_string(static_cast<int>(std::lround(100 * std::clamp(share, 0.0, 1.0)))) + " %";
}

std::string look_of(const RemainingLook& look, const std::string& unit) {
  using Kind = RemainingLook::Kind;
  switch (look.kind) {
    case Kind::too_few:
      return "too few samples to say";
    case Kind::noise:
      return "noise";
    case Kind::louder_noise:
      return "noise larger than the noise estimate of " + fixed_text(look.noise, 2) + " " + unit;
    case Kind::slow_unrecorded:
      return "slow changes that follow nothing recorded";
    case Kind::shaped:
      break;
  }
  std::vector<std::string> parts;
  if (look.offset_share > 0)
    parts.push_back("an offset per batch (" + fixed_text(100 * look.offset_share, 0) + " % of it)");
  if (look.trend_share > 0) parts.push_back("a slow drift (" + fixed_text(100 * look.trend_share, 0) + " %)");
  if (!look.follows.empty())
    parts.push_back("it follows " + look.follows + " (correlation " + fixed_text(look.correlation, 2) +
                    (look.lag_min > 0 ? ", " + fixed_text(look.lag_min, 0) + " min later)" : ")"));
  return joined(parts, "; ");
}

/// Settings of a schedule of the menu, whose levels are known.
std::string menu_settings(const PlannedBlock& block) {
  const std::string level = general_text(block.level, 5), own = block.subject + " at ";
  switch (block.kind) {
    case ScheduleKind::speed_stair:
      return own + "25, 50, 75 and 100 % of " + level + ", then 0";
    case ScheduleKind::single_high_speed:
      return own + level + " from cold";
    case ScheduleKind::cool_down:
      return own + level + ", then 0 for twice as long";
    case ScheduleKind::toggle:
      return block.beside + " at half of " + level + ", " + block.subject + " on and off in six equal pieces";
    case ScheduleKind::only:
      return own + level + ", everything else off, then a pause";
    case ScheduleKind::idle_day:
      return "everything off while the room swings by 6 K";
    case ScheduleKind::repeat:
      return "batch " + block.batch + " once more";
    case ScheduleKind::sensor_swap:
      return "exchange " + block.subject + " and " + block.beside + ", then batch " + block.batch +
             " once more: a faulty thermometer takes its fault along";
  }
  return {};
}

/// " of pump", or nothing where the input is left open.
std::string of_subject(const PlannedBlock& block) { return block.subject.empty() ? "" : " of " + block.subject; }

/// Settings of a schedule that shows an effect by itself, locates a gap or pins a parameter.
std::string general_settings(const PlannedBlock& block) {
  const bool locates = block.purpose == SchedulePurpose::locates;
  switch (block.kind) {
    case ScheduleKind::speed_stair:
      return "each level" + of_subject(block) + " held until the machine settles";
    case ScheduleKind::single_high_speed:
      return "the highest level" + of_subject(block) + " from cold";
    case ScheduleKind::cool_down:
      return "the highest level" + of_subject(block) + ", then off for twice as long" +
             (block.purpose == SchedulePurpose::pins ? ": capacities and conductances separate" : "");
    case ScheduleKind::toggle:
      return locates ? "hold everything else, step only " + block.subject + " on and off, twice, long enough to settle"
                     : "only " + block.subject + " on and off, twice, everything else held";
    case ScheduleKind::only:
      return "only " + block.subject + ", everything else off, then a pause";
    case ScheduleKind::idle_day:
      return locates ? "everything off, room logged: what remains then is driven by no input"
                     : "everything off, room logged";
    case ScheduleKind::repeat:
      return "the first batch again, after a night at rest";
    case ScheduleKind::sensor_swap:
      return "exchange " + block.subject + " with a trusted thermometer, then repeat a batch";
  }
  return {};
}

}  // namespace

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
  return text;
}

std::string output_name(const Gap& gap) { return gap.output.empty() ? "temperatures" : gap.output; }

std::string name_of(const Rival& rival) {
  return rival.effect + (rival.location.empty() ? "" : " at " + rival.location);
}

std::string reason_of(const RuledOut& one, bool held_out) {
  const std::string where = held_out ? " on batches not used for fitting" : "";
  switch (one.by) {
    case RuledOutBy::no_shrink:
      return "does not shrink the gap" + where;
    case RuledOutBy::share:
      return "closes " + whole_percent(one.value) + " of the gap" + where +
             (std::isfinite(one.best) ? ", the best " + whole_percent(one.best) : "");
    case RuledOutBy::calibration:
      return "no better than calibration (" + fixed_text(std::max(0., one.value), 0) + " nats)";
    case RuledOutBy::evidence:
      return fixed_text(one.value, 0) + " nats behind the best";
    case RuledOutBy::strength:
      return "fits only with a strength of " + fixed_text(one.value, 1) + " instead of 1";
    case RuledOutBy::sign:
      return "the sensors respond with the wrong sign";
    case RuledOutBy::elsewhere:
      return "other sensors than its own respond most";
    case RuledOutBy::same_sign:
      return "both ends respond with the same sign";
    case RuledOutBy::remains:
      if (std::isfinite(one.best))
        return "closes " + whole_percent(one.value) + " of the gap" + where +
               ", no less than what is named, with less evidence";
      return (one.value > 0 ? "closes " + whole_percent(one.value) + " of the gap" + where + ", but "
                            : "comes nearest" + where + ", but ") +
             "leaves too much";
  }
  return {};
}

std::string difference_of(const Where& where) {
  if (where.agrees) return {};
  return "without assuming an effect, " + where.free_place + " explains the gap best; the effect acts at " +
         where.effect_place + ": neighbours, spread effects and nodes without a sensor look alike in this view";
}

std::string looks_of(const Remaining& remaining, const std::string& unit) {
  std::vector<std::string> parts;
  for (const RemainingLook& one : remaining.looks)
    parts.push_back((one.channel.empty() ? "" : one.channel + ": ") + look_of(one, unit));
  return joined(parts, "; ");
}

std::string schedule_of(const PlannedBlock& block) {
  switch (block.kind) {
    case ScheduleKind::speed_stair:
      return block.subject.empty() ? "stair" : block.subject + " stair";
    case ScheduleKind::single_high_speed:
      return block.subject.empty() ? "highest level" : block.subject + " at its highest";
    case ScheduleKind::cool_down:
      return "cool-down";
    case ScheduleKind::toggle:
      return block.subject + " toggle";
    case ScheduleKind::only:
      return block.subject + " only";
    case ScheduleKind::idle_day:
      return "idle day";
    case ScheduleKind::repeat:
      return "repeat";
    case ScheduleKind::sensor_swap:
      return "sensor swap";
  }
  return {};
}

std::string settings_of(const PlannedBlock& block) {
  return (block.purpose == SchedulePurpose::separates ? menu_settings(block) : general_settings(block)) +
         (block.times > 1 ? ", " + std::to_string(block.times) + " times" : "");
}

std::string remark_of(const NextExperiment& next) {
  using Remark = NextExperiment::Remark;
  switch (next.remark) {
    case Remark::none:
      return {};
    case Remark::nothing_separates:
      return "no schedule of the menu separates " + name_of(next.separates[0]) + " from " + name_of(next.separates[1]) +
             " well; a sensor at the place in question would";
    case Remark::not_foreseeable:
      return "without the network the probability of confusion after the plan cannot be given";
    case Remark::thermometer_near:
      return "add a temperature sensor near " + next.subject + ", where the gap lies most";
    case Remark::not_pinned:
      return next.subject + " is not pinned by these data";
  }
  return {};
}

namespace {

std::string side_of(const DataProblem& problem) {
  return problem.side == DataProblem::Side::simulated ? "simulated " : "measured ";
}

std::string other_side_of(const DataProblem& problem) {
  return problem.side == DataProblem::Side::simulated ? "measured" : "simulated";
}

/// " in K03", or nothing where it is so in all batches.
std::string where_in(const DataProblem& problem) {
  return problem.batches.empty() ? "" : " (in " + joined(problem.batches) + ")";
}

std::string times_text(double factor) { return factor < 100 ? general_text(factor, 2) : fixed_text(factor, 0); }

/// Which unit of time was taken for which.
std::string mistaken_clock(double factor) {
  const double size = factor > 1 ? factor : 1 / factor;
  const char* small = size > 9000 || std::abs(size - 1000) < 1 ? "milliseconds" : "seconds";
  const char* large = size > 9000 || size < 100 ? "minutes" : size < 2000 ? "seconds" : "hours";
  return std::string(factor > 1 ? small : large) + " read as " + (factor > 1 ? large : small);
}

/// What is different between the sides.
std::string difference_of(const DataProblem& problem) {
  using Kind = DataProblem::Kind;
  const std::string names = joined(problem.names);
  const bool many = problem.names.size() > 1;
  switch (problem.kind) {
    case Kind::unit: {
      std::string text = side_of(problem) + names + (many ? " seem" : " seems") + " to be in " + problem.unit;
      const double ratio = problem.side == DataProblem::Side::simulated ? problem.figure : 1 / problem.figure;
      if (problem.figure > 0)
        text += ": it moves " + times_text(ratio > 1 ? ratio : 1 / ratio) +
                (ratio > 1 ? " times less" : " times more") + " than the " + other_side_of(problem) + " one";
      else if (problem.unit == "K")
        text += std::string(": ") + (many ? "they stand" : "it stands") + " 273.15 above what is " +
                (problem.side == DataProblem::Side::simulated ? "measured" : "expected");
      return text;
    }
    case Kind::factor:
      return "measured " + names + " moves " + times_text(problem.figure > 1 ? problem.figure : 1 / problem.figure) +
             (problem.figure > 1 ? " times more" : " times less") +
             " than simulated, which is no unit: counts on one side?";
    case Kind::sign:
      return "measured " + names + " has the opposite sign of simulated " + names +
             ": one is the error, the other the correction?";
    case Kind::swapped:
      return "the columns " + joined(problem.names, " and ") + " seem to be exchanged" +
             (problem.side == DataProblem::Side::measured ? " in the batches" : " on one side");
    case Kind::copied:
      return side_of(problem) + problem.names[1] + " holds " + problem.names[0] + " once more, to the last digit";
    case Kind::clock_unit:
      return (problem.side == DataProblem::Side::simulated  ? "the times of the simulator's output are "
              : problem.side == DataProblem::Side::measured ? "the times of the batches are "
                                                            : "the times of one side are wrong: those of the "
                                                              "simulator's output are, beside those of the batches, ") +
             times_text(problem.figure > 1 ? problem.figure : 1 / problem.figure) +
             (problem.figure > 1 ? " times too long: " : " times too short: ") + mistaken_clock(problem.figure) + "?";
    case Kind::clock_offset:
      return problem.note == "start"
                 ? std::string("the clocks of the two sides have no time in common: another start?")
                 : "everything measured comes " + general_text(std::abs(problem.figure) / 60, 3) + " min " +
                       (problem.figure > 0 ? "later" : "earlier") + " than simulated: clocks apart, or another start?";
    default:
      return {};
  }
}

}  // namespace

std::string place_of(const DataProblem& problem) {
  using Kind = DataProblem::Kind;
  switch (problem.kind) {
    case Kind::not_measured:
    case Kind::not_modelled:
      return "sensors";
    case Kind::not_simulated:
    case Kind::not_paired:
    case Kind::resampled:
      return "pairing";
    case Kind::warm_start:
      return "start";
    case Kind::finding:
      return problem.batch + " " + problem.channel;
    case Kind::left_out:
      return (problem.side == DataProblem::Side::simulated ? "simulated " : "") + problem.batch + " " + problem.channel;
    case Kind::unit:
    case Kind::factor:
    case Kind::sign:
    case Kind::swapped:
    case Kind::copied:
    case Kind::clock_unit:
    case Kind::clock_offset:
      return problem.certain ? "certain" : "suspected";
    case Kind::datum:
      return "datum";
  }
  return {};
}

std::string what_of(const DataProblem& problem) {
  using Kind = DataProblem::Kind;
  switch (problem.kind) {
    case Kind::not_measured:
      return "the batches lack " + joined(problem.names) + "; the machine file has them";
    case Kind::not_modelled:
      return "the machine file lacks " + joined(problem.names) + "; left out";
    case Kind::not_simulated:
      return joined(problem.names) + ": measured but not simulated; left out";
    case Kind::not_paired:
      return "batch " + joined(problem.names) + " has no simulated counterpart; left out";
    case Kind::resampled:
      return "sampling differs: simulated values are read off linearly at measured times";
    case Kind::finding:
      return problem.rule + (problem.note.empty() ? "" : ": " + problem.note);
    case Kind::left_out:
      return (problem.note.find_first_of("-,") == std::string::npos ? "row " : "rows ") + problem.note + ": " +
             problem.rule + ", no reading; left out (read off between its neighbours)";
    case Kind::datum:
      return side_of(problem) + joined(problem.names) + " counts from another zero in " + problem.note + "; left free";
    case Kind::warm_start:
      return joined(problem.batches) + (problem.batches.size() > 1 ? " start" : " starts") + " out of equilibrium (" +
             problem.channel + " of " + problem.batch + " reads " + fixed_text(std::abs(problem.figure), 1) +
             (problem.figure > 0 ? " K above" : " K below") + " the room first): the machine ran before" +
             (problem.rule == starts_were_fitted ? "; starts are fitted batch by batch" : "");
    default:
      return difference_of(problem) + where_in(problem);
  }
}

namespace {

/// "'T1=K,T2=K'", as --units takes it.
std::string units_for(const DataProblem& problem, const std::string& unit) {
  std::string text;
  for (const std::string& name : problem.names) text += (text.empty() ? "'" : ",") + name + "=" + unit;
  return text + "'";
}

/// "--units WRONG", where the simulator's output is not written like that; of its own options where it is that side.
std::string on_side(const DataProblem& problem, SimulatorKind simulator, const std::string& option,
                    const std::string& wrong, const std::string& right) {
  if (problem.side == DataProblem::Side::simulated) return "--sim-" + option + " " + wrong;
  return "--" + option + " " + wrong +
         (simulator == SimulatorKind::outputs ? " --sim-" + option + " " + right : std::string());
}

/// In what unit columns are that seem to be in `unit`, as find_unit() knows it.
std::string own_unit(const DataProblem& problem) {
  const bool length = std::any_of(length_units.begin(), length_units.end(),
                                  [&](const LengthUnit& one) { return problem.unit == one.name; });
  return length ? "um" : "degC";
}

/// A header line or a machine file instead of an option.
std::string or_in_file(const DataProblem& problem, SimulatorKind simulator, const std::string& unit) {
  std::string text = ", or name it in the header: " + problem.names[0] + " [" + unit + "]";
  if (simulator == SimulatorKind::network)
    text += ", or in the machine file: \"channels\": {\"" + problem.names[0] + "\": {\"unit\": \"" + unit + "\"}}";
  return text;
}

std::string unit_remedy(const DataProblem& problem, SimulatorKind simulator) {
  const std::string of = problem.batches.empty() ? "" : " of " + joined(problem.batches);
  if (!of.empty()) return "name the unit in the header" + of + ": " + problem.names[0] + " [" + problem.unit + "]";
  if (problem.side == DataProblem::Side::simulated && simulator == SimulatorKind::network) {
    if (own_unit(problem) == "um" && problem.figure > 0)
      for (const LengthUnit& one : length_units)
        if (problem.unit == one.name)
          return "the machine file's um_per_K of " + problem.names[0] + " are in " + problem.unit +
                 " per K: multiply them by " + general_text(one.um, 6);
    return "write the temperatures of the machine file in degC";
  }
  return on_side(problem, simulator, "units", units_for(problem, problem.unit), units_for(problem, own_unit(problem))) +
         or_in_file(problem, simulator, problem.unit);
}

std::string sign_remedy(const DataProblem& problem, SimulatorKind simulator) {
  const std::string correction = units_for(problem, "-" + (problem.unit.empty() ? "um" : problem.unit));
  if (simulator == SimulatorKind::outputs)
    return "errors are compared with errors: where the measured ones are corrections --units " + correction +
           " --sim-units " + units_for(problem, "um") + ", where the simulator's are --sim-units " + correction;
  return "errors are compared with errors: --units " + correction + ", or in the machine file: \"channels\": {\"" +
         problem.names[0] + "\": {\"sign\": \"correction\"}}";
}

/// The unit of time that was meant, and the one that was read.
std::pair<std::string, std::string> clock_units(double factor) {
  const double size = factor > 1 ? factor : 1 / factor;
  const std::string small = size > 9000 || std::abs(size - 1000) < 1 ? "ms" : "s";
  const std::string large = size > 9000 || size < 100 ? "min" : size < 2000 ? "s" : "h";
  return factor > 1 ? std::make_pair(small, large) : std::make_pair(large, small);
}

std::string clock_remedy(DataProblem problem, SimulatorKind simulator) {
  const auto [meant, read] = clock_units(problem.figure);
  const auto of_title = [](const std::string& unit) { return "'TITLE=" + unit + "'"; };
  const auto options = [&, meant = meant, read = read](bool titled) {
    return titled ? on_side(problem, simulator, "units", of_title(meant), of_title(read))
                  : on_side(problem, simulator, "time-unit", meant, read);
  };
  if (problem.side != DataProblem::Side::either)
    return options(false) + "; where the clock's title names another unit, " + options(true);
  problem.side = DataProblem::Side::simulated;
  return "where it is the simulator's clock, " + options(false) + "; else the clock of the batches is in " +
         clock_units(1 / problem.figure).first + ": --time-unit and --sim-time-unit say so";
}

}  // namespace

std::string remedy_of(const DataProblem& problem, SimulatorKind simulator) {
  using Kind = DataProblem::Kind;
  const bool paired = simulator == SimulatorKind::outputs;
  switch (problem.kind) {
    case Kind::unit:
      return unit_remedy(problem, simulator);
    case Kind::factor: {
      const std::string um = general_text(1 / problem.figure, 3);
      return "say how many um one count is, some " + um + " if the simulator is right: --units " +
             units_for(problem, um + "um") + (paired ? " --sim-units " + units_for(problem, "um") : "");
    }
    case Kind::sign:
      return sign_remedy(problem, simulator);
    case Kind::swapped: {
      const std::string names = joined(problem.names, " and ");
      const std::string header = "exchange the names " + names + " in the header of the batches";
      return paired ? header + ", or of the simulator's output if it is that side"
                    : header + ", or their nodes in `sensors` of the machine file";
    }
    case Kind::copied:
      return "leave " + problem.names[1] + " out" +
             (problem.side == DataProblem::Side::simulated ? " of the simulator's output" : "") +
             ", or read what it should hold";
    case Kind::clock_unit:
      return clock_remedy(problem, simulator);
    case Kind::clock_offset:
      if (paired && problem.batches.empty())
        return "let both clocks begin with the same sample: --sim-time-shift " + general_text(problem.figure, 12);
      return "let " + std::string(paired ? "both clocks" : "readings and inputs") + " begin with the same sample";
    case Kind::datum:
      if (paired) return "if the probe kept its zero, something else moved it there";
      return "if the probe kept its zero, write \"datum\": \"absolute\" into `displacement` of the machine file";
    case Kind::warm_start:
      return std::string("write ") + says_fitted_start + " in the machine file";
    default:
      return {};
  }
}

std::string claim_of(const WeakerClaim& claim) {
  using Kind = WeakerClaim::Kind;
  switch (claim.kind) {
    case Kind::one_batch:
      return "One batch only: nothing can be judged on data not used for fitting. Every figure is that of the fit "
             "itself, and a wrong effect may look right.";
    case Kind::few_batches:
      return "Only " + std::to_string(claim.batches) +
             " batches: figures of batches not used for fitting rest on few data and the interval of the shrink is "
             "wide.";
    case Kind::constant_input:
      return "Input " + claim.subject + " never changes: effects that it drives cannot be told from calibration.";
    case Kind::lone_input:
      return "Input " + claim.subject + " is on in batch " + claim.batch +
             " alone: what it drives cannot be judged on batches not used for fitting, and that batch judges nothing.";
    case Kind::no_network:
      return "without the network no power in W, no node between the sensors, and no machine with the effect can be "
             "given; a place is the sensor that responds";
    case Kind::no_ambient:
      return "no ambient temperature is known (--ambient NAME): effects of the room cannot be told apart";
    case Kind::no_displacement:
      return "no displacement is paired: expansion and probe effects were not looked for";
    case Kind::gap_beside:
      return "beside it a gap without a name remains in " + joined(claim.names);
  }
  return {};
}

}  // namespace thermfit::cli
