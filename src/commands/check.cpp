#include <algorithm>

#include "commands/commands.hpp"
#include "commands/learning_campaign.hpp"
#include "options/campaign_options.hpp"
#include "options/output.hpp"
#include "report/check_json.hpp"
#include "report/check_text.hpp"
#include "thermfit/findings/campaign_findings.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    R"(Reads batches and says what is suspicious about them before anything is fitted. An overview gives rows, duration, usual time step and ranges; then a line a kind and channel tells how often, in how many batches, and of the worst its rows, figure and the limit of the rule that it breaks, worst first (--all: every finding):

  time-gap    rows are missing: a time step too long for the clock and its scatter
  time-back   time that repeats or goes back
  missing     cells without a value
  constant    a temperature or thermal error that never moves
  stuck       one value for many rows, while other points say that it moved
  saturated   the same, at the largest or smallest thermal error
  stale       a thermal error that is read less often than it is written down
  spike       readings off those before and after: one, a few in a row, every second
  jump        a lasting step, of one row or a few, that no input and no other channel explains
  collinear   a point that others give more closely than rounding allows
  unit        values that make sense in another unit only
  range       a temperature that starts hot, an error far from zero: right where it is so, or another unit or zero
  impossible  a number that no machine can have: what an instrument writes without a reading
  copy        the numbers of another batch once more
  level       a thermal error that starts further apart in its batches than it moves in one: the probe's zero
  step        another time step than in most batches

From four batches on, each temperature is predicted by the others as the other batches say:

  drift       it leaves slowly what they say
  gain        it moves more, or less
  dead        it does not respond, though it should
  swapped     it reads what another should
  disagrees   it does not go with them, in no way that has a name
  sign        a thermal error of opposite sign to what the other batches say

Limits are multiples of each channel's own noise and resolution, or follow from its scatter over batches and a rate of one false alarm in a thousand campaigns. Rows count from 1 at the first row of the batch. What cannot be read at all is an error, told with file:line:column.
Exit codes: 0 nothing found; 1 findings; 2 could not be read.)";

std::vector<Option> options() {
  std::vector<Option> all{{"--all", "", "every finding, a line each, instead of a line a kind and channel", 0, false},
                          {"--json", "", "machine-readable result, thermfit-check/1", 0, false},
                          {"--output", "FILE", "write the result there instead of to stdout", 'o', false}};
  for (Option& option : campaign_options()) {
    if (option.name == "--missing")
      option.help = "drop or hold missing values before the checks (default: report them)";
    all.push_back(std::move(option));
  }
  return all;
}

Exit run(const Arguments& arguments, Console& console) {
  if (const auto path = output_path(arguments)) console.write_to(*path);
  CsvOptions reading = csv_options(arguments);
  if (!arguments.has("--missing")) reading.missing = MissingValues::keep;
  reading.increasing_time = false;
  std::vector<CheckedBatch> checked;
  Campaign campaign = read_files(reading, console, arguments.positionals()).batches;
  note_first_rows(campaign, TemperatureReference::rise, console);
  CampaignFindings findings = find_faults(campaign);
  for (std::size_t b = 0; b < campaign.size(); ++b) checked.push_back({std::move(campaign[b]), std::move(findings[b])});
  console.print(arguments.has("--json") ? check_json(checked) : check_text(checked, arguments.has("--all")));
  const bool clean = std::all_of(checked.begin(), checked.end(), [](const auto& one) { return one.findings.empty(); });
  return clean ? Exit::done : Exit::negative;
}

}  // namespace

Command check_command() {
  return {"check",
          "find faults in batches before fitting: gaps, stuck sensors, spikes, units",
          "BATCH.csv …",
          details,
          options(),
          {{"thermfit check data/vcenter55", "the campaign that ships with thermfit: nothing is found"},
           {"thermfit check --json data/vcenter55/K01.csv", "the same for one batch, for a program"}},
          run};
}

}  // namespace thermfit::cli
