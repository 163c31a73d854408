#include "report/diagnosis_json.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/diagnosis_words.hpp"
#include "report/fitted_batches_json.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Six significant digits: more would be noise to a reader and differ between compilers. Non-finite reads `null`.
OrderedJson figure(double value) {
  if (!std::isfinite(value)) return nullptr;
  return parse_number(general_text(value, 6)).value_or(0.0);
}

OrderedJson figures(Interval interval) { return {figure(interval.low), figure(interval.high)}; }

OrderedJson figures(const std::array<double, 3>& values) {
  return {figure(values[0]), figure(values[1]), figure(values[2])};
}

/// `convert` applied to each item, as an array.
template <class Items, class Convert>
OrderedJson array_of(const Items& items, Convert convert) {
  OrderedJson array = OrderedJson::array();
  for (const auto& item : items) array.push_back(convert(item));
  return array;
}

void add_stages(OrderedJson& object, const GapLevels& rms) {
  object["as_simulated"] = figure(rms.as_simulated);
  object["calibrated"] = figure(rms.calibrated);
  object["with_effect"] = figure(rms.with_effect);
  object["noise"] = figure(rms.noise);
}

/// Effect, place and driver of a found effect or a rival.
template <class Named>
OrderedJson named_json(const Named& one) {
  OrderedJson object{{"effect", one.effect}, {"location", one.location}};
  if (!one.driver.empty()) object["driver"] = one.driver;
  return object;
}

OrderedJson effect_json(const FoundEffect& found) {
  OrderedJson object = named_json(found);
  object["confidence"] = figure(found.confidence);
  OrderedJson& parameters = object["parameters"] = OrderedJson::object();
  for (const Estimate& estimate : found.parameters)
    parameters[estimate.name] = {
        {"value", figure(estimate.value)},
        {"unit", estimate.unit},
        {"standard_error", estimate.standard_error < 0 ? OrderedJson(nullptr) : figure(estimate.standard_error)}};
  object["alternatives"] = array_of(found.alternatives, [](const Rival& rival) {
    OrderedJson one = named_json(rival);
    one["confidence"] = figure(rival.confidence);
    return one;
  });
  object["same_place"] = found.same_place;
  return object;
}

OrderedJson gap_json(const Gap& gap) {
  OrderedJson object{{"output", output_name(gap)}, {"unit", gap.unit}};
  add_stages(object, gap.rms);
  object["held_out"] = gap.held_out;
  object["shrink_percent"] = figure(gap.shrink_percent);
  object["shrink_ci95_percent"] = figures(gap.shrink_ci95_percent);
  object["shrink_of_explainable_percent"] = figure(gap.shrink_of_explainable_percent);
  if (!gap.transfer.points.empty()) {
    object["transfer_points"] = gap.transfer.points;
    object["S_mean"] = figures(gap.transfer.S_mean);
    object["S_std"] = figures(gap.transfer.S_std);
  }
  object["per_batch"] = array_of(gap.per_batch, [](const BatchGap& one) {
    OrderedJson row{{"batch", one.batch}};
    add_stages(row, one.rms);
    return row;
  });
  OrderedJson& sensors = object["per_sensor"] = OrderedJson::object();
  for (const ChannelGap& one : gap.per_sensor) {
    OrderedJson& row = sensors[one.channel] = OrderedJson{{"unit", one.unit}};
    add_stages(row, one.rms);
  }
  return object;
}

OrderedJson condition_json(const ConditionShare& one) {
  OrderedJson object{{"factor", one.factor}};
  if (one.is_range)
    object["range"] = figures(one.range);
  else
    object["level"] = one.level;
  object["share"] = figure(one.share);
  object["share_of_time"] = figure(one.share_of_time);
  object["rms"] = figure(one.rms);
  return object;
}

OrderedJson where_json(const Where& where) {
  const auto named = [](const char* key) {
    return [key](const NamedShare& one) { return OrderedJson{{key, one.name}, {"share", figure(one.share)}}; };
  };
  OrderedJson object;
  object["stages"] = array_of(where.stages, named("stage"));
  object["places"] = array_of(where.places, named("place"));
  object["conditions"] = array_of(where.conditions, condition_json);
  object["frequency"] = array_of(where.frequency, [](const PeriodShare& one) {
    return OrderedJson{{"period_min", figures(one.period_min)}, {"share", figure(one.share)}};
  });
  if (where.chain.known)
    object["chain"] = {{"total_um", figure(where.chain.total_um)},
                       {"temperature_um", figure(where.chain.temperature_um)},
                       {"expansion_um", figure(where.chain.expansion_um)},
                       {"um_per_K_sensed", figure(where.chain.um_per_K_sensed)}};
  object["views_agree"] = where.agrees;
  if (!where.agrees) object["difference"] = difference_of(where);
  return object;
}

/// `unexplained_um` only where the gap is one in um; `unexplained` with its unit always.
OrderedJson remaining_json(const Remaining& remaining, const std::string& unit) {
  OrderedJson object{{"white", remaining.white}};
  if (unit == "um") object["unexplained_um"] = figure(remaining.unexplained);
  object["looks_like"] = looks_of(remaining, unit);
  object["unexplained"] = figure(remaining.unexplained);
  object["unit"] = unit;
  return object;
}

OrderedJson next_experiment_json(const NextExperiment& next) {
  return {{"separates", array_of(next.separates, name_of)},
          {"plan", array_of(next.plan,
                            [](const PlannedBlock& block) {
                              return OrderedJson{{"schedule", schedule_of(block)},
                                                 {"how", settings_of(block)},
                                                 {"machine_hours", figure(block.machine_hours)}};
                            })},
          {"expected_confidence", figure(next.expected_confidence)},
          {"confusion_before", figure(next.confusion_before)},
          {"confusion_after", figure(next.confusion_after)},
          {"why", remark_of(next)}};
}

OrderedJson document_of(const Diagnosis& diagnosis) {
  OrderedJson document{{"format", "thermfit-diagnosis/1"},
                       {"mode", diagnosis.simulator == SimulatorKind::network ? "network" : "paired"},
                       {"machine", diagnosis.machine},
                       {"batches", diagnosis.batches},
                       {"verdict", word_of(diagnosis.verdict)}};
  document["effects"] = array_of(diagnosis.effects, effect_json);
  const auto with_share = [](const FoundEffect& found) {
    OrderedJson object = effect_json(found);
    object["closes"] = figure(found.closes);
    return object;
  };
  document["parts"] = array_of(diagnosis.parts, with_share);
  document["suspected"] = array_of(diagnosis.suspected, with_share);
  document["gap"] = gap_json(diagnosis.gap);
  document["where"] = where_json(diagnosis.where);
  document["remaining"] = remaining_json(diagnosis.remaining, diagnosis.gap.unit);
  document["next_experiment"] = next_experiment_json(diagnosis.next_experiment);
  document["ruled_out"] = OrderedJson::array();
  for (const RuledOut& one : diagnosis.ruled_out)
    if (one.by != RuledOutBy::remains)
      document["ruled_out"].push_back(
          {{"effect", one.effect}, {"location", one.location}, {"reason", reason_of(one, diagnosis.gap.held_out)}});
  const Support& support = diagnosis.support;
  document["grounds"] = {
      {"candidates", support.candidates},       {"nearest", array_of(support.nearest, named_json<Rival>)},
      {"gain_nats", figure(support.gain_nats)}, {"rival", figure(support.rival)},
      {"closes", figure(support.closes)},       {"leaves", figure(support.leaves)}};
  document["calibration"] = array_of(diagnosis.calibration, [](const CalibrationMove& one) {
    return OrderedJson{{"parameter", one.parameter},         {"unit", one.unit},
                       {"from", figure(one.from)},           {"to", figure(one.to)},
                       {"prior_sds", figure(one.prior_sds)}, {"pinned", one.pinned}};
  });
  if (!diagnosis.fitted_batches.empty())
    document["of_batches"] = fitted_batches_json<OrderedJson>(diagnosis.fitted_batches, diagnosis.with_effects);
  document["data_problems"] = array_of(diagnosis.data_problems, [&](const DataProblem& one) {
    OrderedJson problem{{"place", place_of(one)}, {"what", what_of(one)}};
    if (one.kind >= DataProblem::Kind::unit) problem["certain"] = one.certain;
    if (const std::string remedy = remedy_of(one, diagnosis.simulator); !remedy.empty()) problem["remedy"] = remedy;
    return problem;
  });
  document["weaker_claims"] = array_of(diagnosis.weaker_claims, claim_of);
  OrderedJson& judged_by = document["judged_by"] = OrderedJson::object();
  for (const auto& [name, value] : diagnosis.judged_by) judged_by[name] = figure(value);
  return document;
}

}  // namespace

std::string diagnosis_json(const Diagnosis& diagnosis) { return document_of(diagnosis).dump(1); }

}  // namespace thermfit::cli
