#include "commands/learning_campaign.hpp"

#include <algorithm>
#include <cmath>

#include "options/campaign_options.hpp"
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
  if (arguments.has("--inputs")) return;
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
               " (--temperatures tells others, --inputs ends this remark)");
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

}  // namespace

Campaign learning_campaign(const Arguments& arguments, const Console& console, TemperatureReference reference) {
  Campaign campaign = read_campaign(arguments, console, arguments.positionals(), false);
  note_unused_thermometers(campaign, arguments, console);
  note_faults(campaign, reference, console);
  return campaign;
}

void note_faults(const Campaign& campaign, TemperatureReference reference, const Console& console) {
  if (reference == TemperatureReference::rise) note_first_readings(campaign, console);
}

}  // namespace thermfit::cli
