#include "options/error_reference.hpp"

#include <algorithm>
#include <cmath>

#include "thermfit/fit/batch_levels.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/model/probe_level.hpp"
#include "thermfit/moments/observations.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

std::vector<Moments<>> moments_seen(const Campaign& campaign, const std::vector<Index>& points,
                                    TemperatureReference temperatures, ErrorReference reference) {
  std::vector<Moments<>> batches;
  for (const Batch& batch : campaign) {
    const Moments<> all = observe(batch, temperatures, reference).moments;
    batches.push_back(points.empty() ? all : all.subset(points));
  }
  return batches;
}

std::string um(double variance) { return fixed_text(std::sqrt(std::max(0., variance)), 1) + " um"; }

/// "-134.1 … 167.0 um".
std::string starts_of(const Campaign& campaign, Index error) {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const Batch& batch : campaign) {
    const ErrorStart start = error_start(batch.errors.values.col(error));
    if (start.row < 0) continue;
    lowest = std::min(lowest, start.value_um);
    highest = std::max(highest, start.value_um);
  }
  return fixed_text(lowest, 1) + " … " + fixed_text(highest, 1) + " um";
}

}  // namespace

Option error_reference_option() {
  return {
      "--error-reference", "WHAT",
      "what thermal errors count from: 'recorded' (the probe's zero; default), 'start' (each batch's first reading: "
      "the change since a datum), or 'batch' (an own intercept for each batch)",
      0, false};
}

ErrorReference error_reference(const Arguments& arguments, ErrorReference otherwise) {
  const std::string word = arguments.choice("--error-reference", {"recorded", "start", "batch"}, name(otherwise));
  for (const ErrorReference one : {ErrorReference::start, ErrorReference::batch})
    if (word == name(one)) {
      if (arguments.has("--absolute"))
        throw UsageError("--error-reference " + word +
                         " takes the level of each batch off its errors, and --absolute leaves it in its temperatures; "
                         "say one of them");
      return one;
    }
  return ErrorReference::recorded;
}

std::string in_words(ErrorReference reference) {
  switch (reference) {
    case ErrorReference::start:
      return "relative to the start of each batch";
    case ErrorReference::batch:
      return "about each batch's own intercept";
    case ErrorReference::recorded:
      break;
  }
  return "as recorded";
}

void note_starts(const Campaign& campaign, ErrorReference reference, bool learning, const Console& console) {
  for (const Batch& batch : campaign) {
    if (reference == ErrorReference::recorded || batch.rows() == 0) continue;
    const std::vector<std::string> lacking = lacks_first_reading(batch);
    const bool moved = learning && reference == ErrorReference::start && batch.first_degC.size() > 0;
    if (moved || !lacking.empty())
      console.note(batch.source + ": rises and errors count from row " + std::to_string(batch.number_of(0)) +
                   ", the first that is whole" +
                   (lacking.empty() ? "" : ": " + name_list(lacking) + " has no reading in the first row"));
    for (Index e = 0; reference == ErrorReference::start && e < batch.errors.count(); ++e) {
      const ErrorStart start = error_start(batch.errors.values.col(e));
      if (start.off_um > 0)
        console.note(batch.source + ": the first reading of " + batch.errors.names[static_cast<std::size_t>(e)] +
                     " is " + fixed_text(start.off_um, 1) +
                     " um off the rows that follow, and no zero: it counts from " + fixed_text(start.value_um, 1) +
                     " um, where they come from; --error-reference batch needs no zero");
    }
  }
}

void note_levels(const Campaign& campaign, const std::vector<Index>& points, TemperatureReference temperatures,
                 ErrorReference reference, const Console& console) {
  if (campaign.size() < 2 || reference == ErrorReference::batch) return;
  note_levels(campaign, moments_seen(campaign, points, temperatures, reference), points, temperatures, reference,
              console);
}

void note_levels(const Campaign& campaign, const std::vector<Moments<>>& counted, const std::vector<Index>& points,
                 TemperatureReference temperatures, ErrorReference reference, const Console& console) {
  if (campaign.size() < 2 || reference == ErrorReference::batch) return;
  const BatchLevels<> seen = batch_levels(counted);
  const bool may_start = reference == ErrorReference::recorded && temperatures == TemperatureReference::rise;
  const BatchLevels<> from_start =
      may_start ? batch_levels(moments_seen(campaign, points, temperatures, ErrorReference::start)) : seen;
  for (Index e = 0; e < seen.total.size(); ++e) {
    const bool mostly = seen.share(e) > .5, start_helps = may_start && from_start.common(e) < seen.common(e) / 2;
    if (!mostly && !start_helps) continue;
    const std::string& name = campaign.front().errors.names[static_cast<std::size_t>(e)];
    const auto percent = [](double share) { return fixed_text(std::floor(100 * share), 0) + " %"; };
    std::string text = mostly ? "batch means explain " + percent(seen.share(e)) + " of " + name +
                                    ", the temperatures do not: they leave " + um(seen.common(e)) +
                                    ", with an intercept for each batch " + um(seen.own(e))
                              : "where batches start explains " + percent(1 - from_start.common(e) / seen.common(e)) +
                                    " of what temperatures leave of " + name + ": " + um(seen.common(e)) +
                                    ", from each start " + um(from_start.common(e));
    if (reference == ErrorReference::start) {
      console.note(text + "; are first readings bad? --error-reference batch needs none");
      continue;
    }
    text += "; " + name + " starts at " + starts_of(campaign, e) + ": was the probe set to zero anew in each batch? ";
    text += start_helps ? "--error-reference start" : "--error-reference batch";
    console.note(text + (temperatures == TemperatureReference::rise ? "" : ", without --absolute"));
  }
}

void note_probe_levels(const TrainedModel& model, const Console& console) {
  for (Index e = 0; e < model.model.errors(); ++e)
    if (const double level = probe_level_um(model, e); level != 0)
      console.note(
          model.errors[static_cast<std::size_t>(e)] + " stands at " + fixed_text(level, 1) +
          " um, far beyond all that it and its temperatures moved: a machine coordinate or the probe's zero, no "
          "thermal error, and never to be compensated; --error-reference start takes it off");
}

}  // namespace thermfit::cli
