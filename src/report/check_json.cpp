#include "report/check_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "options/field_flags.hpp"
#include "thermfit/findings/clock_findings.hpp"
#include "thermfit/findings/series_scale.hpp"

namespace thermfit::cli {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN: what is not a number is null. Zero has no sign.
Json number(double value) { return std::isfinite(value) ? Json(value + 0.) : Json(nullptr); }

Json channel_json(const std::string& name, const std::string& role, const std::string& unit,
                  const Eigen::Ref<const Vector>& column) {
  const Series series(column);
  const SeriesScale scale = series_scale(series);
  double sum = 0;
  for (const double value : series.values) sum += value;
  const bool any = series.size() > 0;
  const double none = std::nan("");
  return {{"name", name},
          {"role", role},
          {"unit", unit.empty() ? Json(nullptr) : Json(unit)},
          {"values", series.size()},
          {"missing", static_cast<std::size_t>(column.size()) - series.size()},
          {"lowest", number(any ? scale.lowest : none)},
          {"mean", number(any ? sum / static_cast<double>(series.size()) : none)},
          {"highest", number(any ? scale.highest : none)},
          {"resolution", number(scale.resolution)},
          {"noise", number(scale.noise)}};
}

Json batch_json(const CheckedBatch& one) {
  const Batch& batch = one.batch;
  Json channels = Json::array(), findings = Json::array();
  const auto add = [&](const Channels& group, const std::string& role, const std::string& unit) {
    for (Index c = 0; c < group.count(); ++c)
      channels.push_back(channel_json(group.names[static_cast<std::size_t>(c)], role, unit, group.values.col(c)));
  };
  add(batch.temperatures, "temperature", "degC");
  add(batch.errors, "error", "um");
  add(batch.inputs, "input", "");
  for (const Finding& found : one.findings)
    findings.push_back({{"rule", rule_name(found.rule)},
                        {"channel", found.channel},
                        {"first_row", batch.number_of(found.first_row)},
                        {"last_row", batch.number_of(found.last_row)},
                        {"figure", number(found.figure)},
                        {"limit", number(found.limit)},
                        {"unit", found.unit},
                        {"note", with_flags(found.note)}});
  return {{"name", batch.name},
          {"source", batch.source},
          {"sha256", batch.digest},
          {"rows", batch.rows()},
          {"dropped_rows", batch.dropped_rows},
          {"held_values", batch.held_values},
          {"first_time_s", batch.has_time() ? number(batch.time_s(0)) : Json(nullptr)},
          {"last_time_s", batch.has_time() ? number(batch.time_s(batch.rows() - 1)) : Json(nullptr)},
          {"usual_step_s", number(usual_step_s(batch))},
          {"channels", channels},
          {"findings", findings}};
}

}  // namespace

std::string check_json(const std::vector<CheckedBatch>& checked) {
  Json document = {{"format", "thermfit-check/1"}, {"findings", 0}, {"batches", Json::array()}};
  std::size_t findings = 0;
  for (const CheckedBatch& one : checked) {
    findings += one.findings.size();
    document["batches"].push_back(batch_json(one));
  }
  document["findings"] = findings;
  return document.dump(2) + '\n';
}

}  // namespace thermfit::cli
