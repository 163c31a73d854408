#pragma once

/// A diagnosis as the document `thermfit-diagnosis/1`.

#include <nlohmann/json.hpp>

#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/number.hpp"

namespace thermfit {

namespace detail {

using OrderedJson = nlohmann::ordered_json;

/// Six significant digits: more would be noise to a reader and differ between compilers. Non-finite reads `null`.
inline OrderedJson figure(double value) {
  if (!std::isfinite(value)) return nullptr;
  return parse_number(general_text(value, 6)).value_or(0.0);
}

inline OrderedJson figures(Interval interval) { return {figure(interval.low), figure(interval.high)}; }

inline OrderedJson figures(const std::array<double, 3>& values) {
  return {figure(values[0]), figure(values[1]), figure(values[2])};
}

/// `convert` applied to each item, as an array.
template <class Items, class Convert>
OrderedJson array_of(const Items& items, Convert convert) {
  OrderedJson array = OrderedJson::array();
  for (const auto& item : items) array.push_back(convert(item));
  return array;
}

inline void add_stages(OrderedJson& object, const GapLevels& rms) {
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

inline OrderedJson effect_json(const FoundEffect& found) {
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

inline OrderedJson gap_json(const Gap& gap) {
  OrderedJson object{{"output", gap.output}, {"unit", gap.unit}};
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

inline OrderedJson condition_json(const ConditionShare& one) {
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

inline OrderedJson where_json(const Where& where) {
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
  if (!where.difference.empty()) object["difference"] = where.difference;
  return object;
}

inline OrderedJson next_experiment_json(const NextExperiment& next) {
  return {{"separates", next.separates},
          {"plan", array_of(next.plan,
                            [](const PlannedBlock& block) {
                              return OrderedJson{{"schedule", block.schedule},
                                                 {"how", block.how},
                                                 {"machine_hours", figure(block.machine_hours)}};
                            })},
          {"expected_confidence", figure(next.expected_confidence)},
          {"confusion_before", figure(next.confusion_before)},
          {"confusion_after", figure(next.confusion_after)},
          {"why", next.why}};
}

}  // namespace detail

/// The document `thermfit-diagnosis/1`: keys in the order of the format, added keys after them; figures with six
/// significant digits, `null` where a figure does not exist.
inline nlohmann::ordered_json diagnosis_to_json(const Diagnosis& diagnosis) {
  using detail::OrderedJson;
  OrderedJson document{{"format", "thermfit-diagnosis/1"},
                       {"mode", diagnosis.mode},
                       {"machine", diagnosis.machine},
                       {"batches", diagnosis.batches},
                       {"verdict", word_of(diagnosis.verdict)}};
  document["effects"] = detail::array_of(diagnosis.effects, detail::effect_json);
  document["gap"] = detail::gap_json(diagnosis.gap);
  document["where"] = detail::where_json(diagnosis.where);
  document["remaining"] = {{"white", diagnosis.remaining.white},
                           {"unexplained_um", detail::figure(diagnosis.remaining.unexplained_um)},
                           {"looks_like", diagnosis.remaining.looks_like}};
  document["next_experiment"] = detail::next_experiment_json(diagnosis.next_experiment);
  document["ruled_out"] = detail::array_of(diagnosis.ruled_out, [](const RuledOut& one) {
    return OrderedJson{{"effect", one.effect}, {"location", one.location}, {"reason", one.reason}};
  });
  const Support& grounds = diagnosis.grounds;
  document["grounds"] = {{"candidates", grounds.candidates},
                         {"nearest", detail::array_of(grounds.nearest, detail::named_json<Rival>)},
                         {"gain_nats", detail::figure(grounds.gain_nats)},
                         {"closes", detail::figure(grounds.closes)},
                         {"leaves", detail::figure(grounds.leaves)}};
  document["calibration"] = detail::array_of(diagnosis.calibration, [](const CalibrationMove& one) {
    return OrderedJson{{"parameter", one.parameter},
                       {"unit", one.unit},
                       {"from", detail::figure(one.from)},
                       {"to", detail::figure(one.to)},
                       {"prior_sds", detail::figure(one.prior_sds)},
                       {"pinned", one.pinned}};
  });
  document["data_problems"] = detail::array_of(diagnosis.data_problems, [](const DataProblem& one) {
    return OrderedJson{{"place", one.place}, {"what", one.what}};
  });
  document["weaker_claims"] = diagnosis.weaker_claims;
  return document;
}

}  // namespace thermfit
