#include "commands/learning_campaign.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "options/campaign_options.hpp"
#include "thermfit/findings/finding_groups.hpp"
#include "thermfit/findings/leave_out.hpp"
#include "thermfit/findings/series_scale.hpp"
#include "thermfit/findings/transient_findings.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

/// Whether an input moves where the thermometers of its batch do: within their range, widened by itself on both sides.
bool reads_like_a_temperature(const Batch& batch, Index input) {
  const Series series(batch.inputs.values.col(input));
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (Index c = 0; c < batch.temperatures.count(); ++c)
    for (const double value : Series(batch.temperatures.values.col(c)).values) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  const SeriesScale scale = series_scale(series);
  return series.size() > 1 && scale.range() > 0 && scale.lowest >= 2 * low - high && scale.highest <= 2 * high - low;
}

/// Numbers that nobody gave a role are inputs; a thermometer among them would be lost without a word.
void note_unused_thermometers(const Campaign& campaign, const Arguments& arguments, const Console& console) {
  if (arguments.has("--inputs") || arguments.has("--temperatures")) return;
  std::vector<std::string> unused;
  const Batch& first = campaign.front();
  for (const std::string& name : first.inputs.names)
    if (std::all_of(campaign.begin(), campaign.end(), [&](const Batch& batch) {
          const Index input = batch.inputs.find(name);
          return input >= 0 && reads_like_a_temperature(batch, input);
        }))
      unused.push_back(name);
  if (unused.empty()) return;
  console.note(name_list(unused, 12) + (unused.size() == 1 ? " reads" : " read") +
               " like temperatures, but no name or option says so, and " + (unused.size() == 1 ? "is" : "are") +
               " not used; temperatures: " + name_list(first.temperatures.names, 12) +
               " (--temperatures tells others)");
}

/// Readings of a temperature from the row on that its rises count from.
Vector from_first_row(const Batch& batch, Index c) {
  const bool left_out = batch.first_degC.size() > 0;
  Vector readings(batch.rows() + (left_out ? 1 : 0));
  readings(0) = left_out ? batch.first_degC(c) : batch.temperatures.values(0, c);
  readings.tail(batch.rows()) = batch.temperatures.values.col(c);
  return readings;
}

void note_first_readings(const Campaign& campaign, const Console& console) {
  for (const Batch& batch : campaign)
    for (Index c = 0; c < batch.temperatures.count(); ++c) {
      const double off_K = first_reading_off_K(Series(from_first_row(batch, c)));
      if (off_K > 0)
        console.note(batch.source + ": " + batch.temperatures.names[static_cast<std::size_t>(c)] + " begins " +
                     fixed_text(off_K, 2) +
                     " K off the rows that follow, and every rise of the batch counts from its first row: was the "
                     "machine not at rest, or is that reading bad?");
    }
}

/// Beyond them looking for faults takes longer than the answer that is asked for.
constexpr double most_readings = 4e6;

double readings(const Campaign& campaign) {
  double count = 0;
  for (const Batch& batch : campaign)
    count += static_cast<double>(batch.rows() * (batch.temperatures.count() + batch.errors.count()));
  return count;
}

/// "spike in K05 row 21", "constant in 3 batches, worst K01".
std::string fault_text(const Campaign& campaign, const FindingGroup& group) {
  const auto& [b, finding] = group.worst();
  const Batch& batch = campaign[b];
  std::string text = std::string(rule_name(group.rule)) + " in ";
  if (group.batches > 1) text += std::to_string(group.batches) + " batches, worst ";
  text += batch.name;
  const bool whole = finding->first_row == 0 && finding->last_row + 1 >= batch.rows();
  return whole || group.rule == FindingRule::unit ? text : text + " row " + rows_text(*finding, batch);
}

/// The faults behind `reasons`, worst first, as many as a line holds.
std::string faults_text(const Campaign& campaign, const std::vector<LeaveOut::Reason>& reasons) {
  constexpr std::size_t most = 4;
  CampaignFindings findings(campaign.size());
  for (const LeaveOut::Reason& reason : reasons) findings[reason.batch].push_back(reason.finding);
  std::vector<std::pair<std::string, std::vector<std::string>>> faults;  // with the channels they are of
  for (const FindingGroup& group : grouped(findings)) {
    const std::string fault = fault_text(campaign, group);
    auto known = std::find_if(faults.begin(), faults.end(), [&](const auto& one) { return one.first == fault; });
    if (known == faults.end()) known = faults.insert(known, {fault, {}});
    if (group.channel != "all") known->second.push_back(group.channel);
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(most, faults.size()); ++i) {
    const auto& [fault, channels] = faults[i];
    text += (i ? "; " : "") + name_list(channels, 4) + (channels.empty() ? "" : " ") + fault;
  }
  return faults.size() > most ? text + "; and " + std::to_string(faults.size() - most) + " more" : text;
}

/// What is left out for the `reasons` of one kind: "3 rows", "temperatures T2, T5", "batches K03".
std::string left_text(const Campaign& campaign, const LeaveOut& left) {
  std::size_t rows = 0;
  for (const std::vector<Index>& of_batch : left.rows) rows += of_batch.size();
  std::vector<std::string> batches, parts;
  for (const std::size_t b : left.batches) batches.push_back(campaign[b].name);
  const auto part = [&](const char* kind, const std::vector<std::string>& names) {
    if (!names.empty()) parts.push_back(kind + name_list(names, 6));
  };
  part("batches ", batches);
  part("temperatures ", left.temperatures);
  part("errors ", left.errors);
  if (rows > 0) parts.push_back(std::to_string(rows) + (rows == 1 ? " row" : " rows"));
  return name_list(parts);
}

Campaign without_faults(Campaign campaign, const Console& console) {
  const LeaveOut left = leave_out(campaign, find_faults(campaign));
  if (left.nothing()) return campaign;
  console.note("left out: " + left_text(campaign, left) + ", for " + faults_text(campaign, left.reasons));
  Campaign kept = without(campaign, left);
  if (kept.empty() || kept.front().temperatures.count() == 0)
    throw Error("--leave-out", "faults everywhere: nothing is left to learn from", "a batch without faults",
                "'thermfit check' tells them");
  return kept;
}

}  // namespace

Option leave_out_option() {
  return {
      "--leave-out", "WHAT",
      "'faulty': rows, thermometers and batches that check finds at fault are left out and told (default: nothing is)",
      0, false};
}

Campaign learning_campaign(const Arguments& arguments, const Console& console, TemperatureReference reference) {
  const bool leave = arguments.choice("--leave-out", {"nothing", "faulty"}, "nothing") == "faulty";
  Campaign campaign = read_campaign(arguments, console, arguments.positionals(), false);
  note_unused_thermometers(campaign, arguments, console);
  if (leave)
    campaign = without_faults(std::move(campaign), console);
  else
    note_faults(campaign, console, "; --leave-out faulty leaves them out");
  note_first_rows(campaign, reference, console);
  return campaign;
}

void note_faults(const Campaign& campaign, const Console& console, const std::string& remedy) {
  if (readings(campaign) > most_readings)
    return console.note("faults are not looked for in so many readings; 'thermfit check' does");
  std::vector<LeaveOut::Reason> reasons;
  for (LeaveOut::Reason& reason : leave_out(campaign, find_faults(campaign)).reasons)
    if (reason.finding.rule != FindingRule::copy) reasons.push_back(std::move(reason));  // told when they are read
  if (!reasons.empty())
    console.note("faults that may change the answer: " + faults_text(campaign, reasons) +
                 " ('thermfit check' tells all" + remedy + ")");
}

void note_first_rows(const Campaign& campaign, TemperatureReference reference, const Console& console) {
  if (reference == TemperatureReference::rise) note_first_readings(campaign, console);
}

}  // namespace thermfit::cli
