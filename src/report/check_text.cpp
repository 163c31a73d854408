#include "report/check_text.hpp"

#include <cmath>

#include "cli/table.hpp"
#include "options/field_flags.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

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

std::string duration_min(const Batch& batch) {
  return batch.time_s.size() < 2 ? "-" : fixed_text((batch.time_s(batch.rows() - 1) - batch.time_s(0)) / 60, 1);
}

std::string plural(std::size_t count, const std::string& one, const std::string& many) {
  return count == 0 ? "no " + many : std::to_string(count) + ' ' + (count == 1 ? one : many);
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

double usual_step_s(const Batch& batch) {
  std::vector<double> steps;
  for (Index row = 1; row < batch.time_s.size(); ++row) steps.push_back(batch.time_s(row) - batch.time_s(row - 1));
  return median(steps);
}

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
                        rows_text(one) + ": " + with_flags(one.note),
                    80, 4);
    }
  }
  std::string text = overview.text() + '\n' + without_role(checked);
  if (findings > 0) text += table.text() + '\n' + notes + '\n';
  const std::string faulty_of = findings > 0 && checked.size() > 1 ? std::to_string(faulty) + " of " : "";
  return text + plural(findings, "finding", "findings") + " in " + faulty_of +
         plural(checked.size(), "batch", "batches") + '\n';
}

}  // namespace thermfit::cli
