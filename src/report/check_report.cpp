#include "report/check_report.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/table.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string rows_text(const Finding& one) {
  const std::string first = std::to_string(one.first_row + 1);
  return one.first_row == one.last_row ? first : first + "-" + std::to_string(one.last_row + 1);
}

std::string range_text(const Channels& channels) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (Index c = 0; c < channels.count(); ++c)
    for (const double value : Series(channels.values.col(c)).values) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  return low > high ? "-" : fixed_text(low, 1) + " … " + fixed_text(high, 1);
}

double usual_step_s(const Batch& batch) {
  std::vector<double> steps;
  for (Index row = 1; row < batch.time_s.size(); ++row) steps.push_back(batch.time_s(row) - batch.time_s(row - 1));
  return median(steps);
}

std::string duration_min(const Batch& batch) {
  return batch.time_s.size() < 2 ? "-" : fixed_text((batch.time_s(batch.rows() - 1) - batch.time_s(0)) / 60, 1);
}

std::string plural(std::size_t count, const std::string& one, const std::string& many) {
  return count == 0 ? "no " + many : std::to_string(count) + ' ' + (count == 1 ? one : many);
}

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
                        {"first_row", found.first_row + 1},
                        {"last_row", found.last_row + 1},
                        {"figure", number(found.figure)},
                        {"limit", number(found.limit)},
                        {"unit", found.unit},
                        {"note", found.note}});
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

/// A batch without a clock or thermal errors may well have them, under names that do not say so.
std::string without_role(const std::vector<CheckedBatch>& checked) {
  std::string text;
  for (const auto& [batch, found] : checked) {
    std::string lacks;
    if (!batch.has_time() && batch.inputs.count() > 0) lacks = "no clock (--time-column NAME)";
    if (batch.errors.count() == 0)
      lacks += (lacks.empty() ? "" : ", ") + std::string("no thermal error (--errors NAMES)");
    if (lacks.empty()) continue;
    lacks +=
        "; " + (batch.inputs.count() == 0 ? "no other columns" : "taken as inputs: " + name_list(batch.inputs.names));
    text += wrap(batch.name + ": " + lacks, 80, 4);
  }
  return text.empty() ? text : text + '\n';
}

}  // namespace

std::string check_text(const std::vector<CheckedBatch>& checked) {
  Table overview({"batch", "rows", "min", "step s", "temperatures degC", "errors um", "findings"});
  Table table({"batch", "channel", "rule", "rows", "figure", "limit", "unit"});
  for (const std::size_t column : {1U, 2U}) table.left(column);
  table.left(6);
  std::size_t findings = 0, faulty = 0;
  std::string notes;
  for (const auto& [batch, found] : checked) {
    overview.add({batch.name, std::to_string(batch.rows()), duration_min(batch),
                  batch.time_s.size() < 2 ? "-" : general_text(usual_step_s(batch), 4), range_text(batch.temperatures),
                  range_text(batch.errors), found.empty() ? "-" : std::to_string(found.size())});
    findings += found.size();
    faulty += !found.empty();
    for (const Finding& one : found) {
      table.add({batch.name, one.channel, std::string(rule_name(one.rule)), rows_text(one), general_text(one.figure, 4),
                 general_text(one.limit, 4), one.unit});
      notes += wrap("  " + batch.name + ' ' + one.channel + (one.first_row == one.last_row ? ", row " : ", rows ") +
                        rows_text(one) + ": " + one.note,
                    80, 4);
    }
  }
  std::string text = overview.text() + '\n' + without_role(checked);
  if (findings > 0) text += table.text() + '\n' + notes + '\n';
  const std::string faulty_of = findings > 0 && checked.size() > 1 ? std::to_string(faulty) + " of " : "";
  return text + plural(findings, "finding", "findings") + " in " + faulty_of +
         plural(checked.size(), "batch", "batches") + '\n';
}

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
