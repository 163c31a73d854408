#include "report/check_text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/table.hpp"
#include "options/field_flags.hpp"
#include "thermfit/findings/clock_findings.hpp"
#include "thermfit/findings/finding_groups.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

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

/// Where a remark holds: "day01, day02, day03 and 3 more".
std::string places_text(const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  if (names.size() <= most + 1) return name_list(names);
  return name_list({names.begin(), names.begin() + most}) + " and " + std::to_string(names.size() - most) + " more";
}

/// Remarks, each once, with what it holds for.
class Remarks {
 public:
  void add(const std::string& where, const std::string& text) {
    for (auto& [known, places] : remarks_)
      if (known == text) {
        if (std::find(places.begin(), places.end(), where) == places.end()) places.push_back(where);
        return;
      }
    remarks_.push_back({text, {where}});
  }

  /// `  place and 3 more: text` each, folded.
  std::string text(const std::string& indent) const {
    std::string all;
    for (const auto& [text, places] : remarks_)
      all += wrap(indent + places_text(places) + ": " + text, 80, indent.size() + 2);
    return all;
  }

 private:
  std::vector<std::pair<std::string, std::vector<std::string>>> remarks_;
};

/// A batch without a clock or thermal errors may well have them, under names that do not say so.
std::string without_role(const std::vector<CheckedBatch>& checked) {
  Remarks remarks;
  for (const auto& [batch, found] : checked) {
    std::string lacks;
    if (!batch.has_time() && batch.inputs.count() > 0) lacks = "no clock (--time-column NAME)";
    if (batch.errors.count() == 0)
      lacks += (lacks.empty() ? "" : ", ") + std::string("no thermal error (--errors NAMES)");
    if (lacks.empty()) continue;
    remarks.add(batch.name, lacks + "; " +
                                (batch.inputs.count() == 0 ? "no other columns"
                                                           : "taken as inputs: " + name_list(batch.inputs.names)));
  }
  const std::string text = remarks.text("");
  return text.empty() ? text : text + '\n';
}

/// Batches a page holds; of more, those with most findings are shown.
constexpr std::size_t most_batches = 20, fewest_shown = 10;

std::string overview(const std::vector<CheckedBatch>& checked, bool all) {
  std::vector<std::size_t> shown(checked.size());
  std::iota(shown.begin(), shown.end(), std::size_t{0});
  const bool some = !all && checked.size() > most_batches;
  if (some) {
    std::stable_sort(shown.begin(), shown.end(), [&](std::size_t a, std::size_t b) {
      return checked[a].findings.size() > checked[b].findings.size();
    });
    shown.resize(fewest_shown);
    std::sort(shown.begin(), shown.end());
  }
  Table table({"batch", "rows", "min", "step s", "temperatures degC", "errors um", "findings"});
  for (const std::size_t b : shown) {
    const auto& [batch, found] = checked[b];
    table.add({batch.name, std::to_string(batch.rows()), duration_min(batch),
               batch.time_s.size() < 2 ? "-" : general_text(usual_step_s(batch), 4), range_text(batch.temperatures),
               range_text(batch.errors), found.empty() ? "-" : std::to_string(found.size())});
  }
  const std::string more = some ? "and " + std::to_string(checked.size() - shown.size()) +
                                      " more batches with fewer findings (--all tells each)\n"
                                : "";
  return table.text() + more + '\n';
}

std::string every_finding(const std::vector<CheckedBatch>& checked) {
  Table table({"batch", "channel", "rule", "rows", "figure", "limit", "unit"});
  for (const std::size_t column : {1U, 2U, 6U}) table.left(column);
  std::string notes;
  for (const auto& [batch, found] : checked)
    for (const Finding& one : found) {
      table.add({batch.name, one.channel, std::string(rule_name(one.rule)), rows_text(one, batch),
                 general_text(one.figure, 4), general_text(one.limit, 4), one.unit});
      notes += wrap("  " + batch.name + ' ' + one.channel + (one.first_row == one.last_row ? ", row " : ", rows ") +
                        rows_text(one, batch) + ": " + with_flags(one.note),
                    80, 4);
    }
  return table.text() + '\n' + notes + '\n';
}

/// A line a kind and channel: how often, and the worst of them.
std::string grouped_findings(const std::vector<CheckedBatch>& checked, const std::vector<FindingGroup>& groups) {
  const bool several = checked.size() > 1;
  std::vector<std::string> header{"channel", "rule", "times", "worst rows", "figure", "limit", "unit"};
  if (several) header.insert(header.begin() + 3, {"batches", "worst in"});
  Table table(header);
  for (const std::size_t column : {std::size_t{1}, header.size() - 1}) table.left(column);
  if (several) table.left(4);
  Remarks remarks;
  for (const FindingGroup& group : groups) {
    const Finding& worst = *group.worst().finding;
    std::vector<std::string> row{group.channel,
                                 std::string(rule_name(group.rule)),
                                 std::to_string(group.places.size()),
                                 rows_text(worst, checked[group.worst().batch].batch),
                                 general_text(worst.figure, 4),
                                 general_text(worst.limit, 4),
                                 worst.unit};
    if (several) row.insert(row.begin() + 3, {std::to_string(group.batches), checked[group.worst().batch].batch.name});
    table.add(row);
    const std::string rule(rule_name(group.rule));
    const bool of_all = group.channel == "time" || group.channel == "all";  // which the rule says already
    remarks.add(of_all ? rule : group.channel + ' ' + rule, with_flags(worst.note));
  }
  return table.text() + '\n' + remarks.text("  ") + '\n';
}

}  // namespace

std::string check_text(const std::vector<CheckedBatch>& checked, bool all) {
  CampaignFindings findings;
  std::size_t count = 0, faulty = 0;
  for (const auto& [batch, found] : checked) {
    findings.push_back(found);
    count += found.size();
    faulty += !found.empty();
  }
  const std::vector<FindingGroup> groups = grouped(findings);
  std::string text = overview(checked, all) + without_role(checked);
  if (count > 0) text += all ? every_finding(checked) : grouped_findings(checked, groups);
  const std::string faulty_of = count > 0 && checked.size() > 1 ? std::to_string(faulty) + " of " : "";
  text += plural(count, "finding", "findings") + " in " + faulty_of + plural(checked.size(), "batch", "batches");
  if (!all && groups.size() < count) text += "; --all tells each";
  return text + '\n';
}

}  // namespace thermfit::cli
