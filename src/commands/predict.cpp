#include <algorithm>
#include <cmath>

#include "cli/labels.hpp"
#include "cli/table.hpp"
#include "commands/commands.hpp"
#include "commands/learning_campaign.hpp"
#include "options/campaign_options.hpp"
#include "options/error_reference.hpp"
#include "options/fit_options.hpp"
#include "options/output.hpp"
#include "thermfit/io/csv/writer.hpp"
#include "thermfit/io/files/atomic_file.hpp"
#include "thermfit/io/json/model.hpp"
#include "thermfit/io/nearest.hpp"
#include "thermfit/model/probe.hpp"
#include "thermfit/number.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    "Predicts the thermal error of every row and says which rows lie outside the model's training domain. Columns are "
    "matched by name; a missing one is refused. The temperature reference (rise or absolute) is the model's own.\n"
    "\n"
    "Prints CSV: batch, row (from 1), time_min where there is a time, <error>_predicted in um, <error>_residual "
    "(prediction minus measurement) where the error was measured, hotelling_T2, SPE, and domain: inside, beyond95, "
    "beyond99. "
    "With --summary one line a batch instead: S where measured, and the share of foreign rows.\n"
    "--probe-every and --probe show what a probe on the machine would bring: the measured error of a row, less the "
    "predicted one, is added to all later predictions until the next reading. A reading more than six standard "
    "deviations of training off the last is taken only when the next one agrees.\n"
    "--json prints thermfit-prediction/1: per batch \"S_um\", \"beyond95\", \"beyond99\" (shares) and the rows.\n"
    "Exit codes: 0 done; 1 with --limit, when S of a batch exceeds it; 2 could not be done.";

/// One batch predicted.
struct Predicted {
  const Batch* batch;
  BatchPrediction prediction;
};

/// Whether a batch holds measured errors.
bool any_measured(const std::vector<Predicted>& all) {
  return std::any_of(all.begin(), all.end(), [](const Predicted& one) { return one.prediction.residuals.cols() > 0; });
}

double largest(const Vector& residuals) {
  double most = 0;
  for (Index row = 0; row < residuals.size(); ++row)
    if (std::isfinite(residuals(row))) most = std::max(most, std::abs(residuals(row)));
  return most;
}

std::string domain_word(const TrainedModel& model, const DomainDistance<>& distance) {
  if (outside_limits(model.domain, distance, 99).any()) return "beyond99";
  return outside_limits(model.domain, distance, 95).any() ? "beyond95" : "inside";
}

std::string rows_text(const TrainedModel& model, const std::vector<Predicted>& all) {
  const bool timed = all.front().batch->has_time(), measured = any_measured(all);
  std::string header = timed ? "batch,row,time_min" : "batch,row";
  for (const std::string& error : model.errors) header += ',' + csv_field(error + "_predicted");
  for (const std::string& error : model.errors) header += measured ? ',' + csv_field(error + "_residual") : "";
  std::string text = header + ",hotelling_T2,SPE,domain\n";
  for (const auto& [batch, p] : all)
    for (Index i = 0; i < p.errors.rows(); ++i) {
      std::string row = csv_field(batch->name) + ',' + std::to_string(batch->number_of(i));
      if (timed) row += ',' + exact_text(batch->time_s(i) / 60);
      for (Index e = 0; e < p.errors.cols(); ++e) row += ',' + fixed_text(p.errors(i, e), 4);
      for (Index e = 0; e < model.model.errors() && measured; ++e)
        row +=
            ',' + (p.residuals.cols() > 0 && std::isfinite(p.residuals(i, e)) ? fixed_text(p.residuals(i, e), 4) : "");
      const DomainDistance<>& d = p.distances[static_cast<std::size_t>(i)];
      text += row + ',' + general_text(d.t2, 6) + ',' + general_text(d.spe, 6) + ',' + domain_word(model, d) + '\n';
    }
  return text;
}

void print_summary(const TrainedModel& model, const std::vector<Predicted>& all, Console& console) {
  std::vector<std::string> header{"batch", "rows"};
  const bool measured = any_measured(all);
  for (const std::string& error : model.errors)
    if (measured) header.insert(header.end(), {"S " + error, "largest " + error});
  header.insert(header.end(), {"beyond 95 %", "beyond 99 %"});
  std::vector<std::string> names;
  for (const Predicted& one : all) names.push_back(one.batch->name);
  const Labels labels(names, 'b', 18);
  if (const std::string legend = labels.legend(); !legend.empty()) console.print(legend + '\n');
  Table table(header);
  for (std::size_t b = 0; b < all.size(); ++b) {
    const auto& [batch, p] = all[b];
    std::vector<std::string> row{labels[b], std::to_string(batch->rows())};
    for (Index e = 0; e < model.model.errors() && measured; ++e) {
      const bool own = p.residuals.cols() > 0;
      row.push_back(own ? known_text(p.S_um(e), 2) : "-");
      row.push_back(own ? fixed_text(largest(p.residuals.col(e)), 2) : "-");
    }
    row.push_back(fixed_text(100 * p.share_beyond(model.domain, 95), 1) + " %");
    row.push_back(fixed_text(100 * p.share_beyond(model.domain, 99), 1) + " %");
    table.add(row);
  }
  console.print(table.text());
  if (measured && model.error_reference != ErrorReference::recorded)
    console.print(wrap("S of errors " + in_words(model.error_reference) + ".", 80, 0));
}

/// Says which batches a model on errors as recorded misses mostly by where their errors start.
void note_zeros(TrainedModel model, const std::vector<Predicted>& all, Console& console) {
  model.error_reference = ErrorReference::start;
  std::vector<Vector> S_from_start;
  for (const auto& [batch, p] : all) S_from_start.push_back(p.S_um.size() > 0 ? predict(model, *batch).S_um : Vector());
  for (std::size_t e = 0; e < model.errors.size(); ++e) {
    const auto error = static_cast<Index>(e);
    std::vector<std::string> batches;
    double recorded = 0, from_start = 0;
    for (std::size_t b = 0; b < all.size(); ++b) {
      const auto& [batch, p] = all[b];
      if (p.S_um.size() == 0) continue;
      const double own = S_from_start[b](error);
      if (!(own * own < p.S_um(error) * p.S_um(error) / 2)) continue;
      batches.push_back(batch->name);
      if (p.S_um(error) < recorded) continue;
      recorded = p.S_um(error);
      from_start = own;
    }
    if (!batches.empty())
      console.note(name_list(batches, 6) + ": where " + model.errors[e] +
                   " starts is most of what the model leaves of " + "it, S " + fixed_text(recorded, 1) +
                   " um, from its start " + fixed_text(from_start, 1) +
                   " um: was the probe set to zero anew? --error-reference start");
  }
}

Json to_document(const TrainedModel& model, const std::vector<Predicted>& all) {
  Json document{{"format", "thermfit-prediction/1"},
                {"errors", model.errors},
                {"error_reference", name(model.error_reference)},
                {"batches", Json::array()}};
  for (const auto& [batch, p] : all) {
    Json one{{"batch", batch->name}, {"rows", batch->rows()}, {"predicted_um", to_json(p.errors)}};
    if (p.residuals.cols() > 0) one["S_um"] = to_json(p.S_um);
    one["beyond95"] = p.share_beyond(model.domain, 95);
    one["beyond99"] = p.share_beyond(model.domain, 99);
    document["batches"].push_back(std::move(one));
  }
  return document;
}

/// Says which batches start in a climate that the model was not trained in, and what follows.
void note_climates(const Campaign& campaign, const TrainedModel& model, const Console& console) {
  if (model.blocks.empty()) return;
  const bool in_model = std::any_of(model.features.begin(), model.features.end(),
                                    [](const Feature& feature) { return feature.kind == FeatureKind::climate; });
  for (const Batch& batch : campaign) {
    const double climate = model_climate_degC(model, batch), beyond_K = model.climate.beyond_K(climate);
    if (!(beyond_K > 0)) continue;
    std::string text = batch.source + ": starts at " + fixed_text(climate, 1) + " degC, " + fixed_text(beyond_K, 1) +
                       " K beyond the climates of training (" + fixed_text(model.climate.lowest, 1) + " to " +
                       fixed_text(model.climate.highest, 1) + " degC), ";
    if (!in_model) {
      console.note(text + "and nothing in the model depends on the climate");
      continue;
    }
    text += "and counts as the nearest of them: were the climate's part to go on, predictions would move further, by";
    const Vector most_um = beyond_climate_um(model, batch);
    for (Index e = 0; e < most_um.size(); ++e)
      text +=
          (e ? ", " : " ") + model.errors[static_cast<std::size_t>(e)] + " up to " + fixed_text(most_um(e), 2) + " um";
    console.note(text);
  }
}

/// Corrects every prediction by the measured errors that --probe and --probe-every take, and says what they brought.
void correct_by_probe(const TrainedModel& model, const Arguments& arguments, std::vector<Predicted>& all,
                      const Console& console) {
  const std::optional<Index> every = arguments.integer("--probe-every", 1, 1000000000);
  const std::string column = arguments.value_or("--probe", "");
  if (every && !column.empty()) throw UsageError("--probe and --probe-every both say when the probe is read");
  if (!every && column.empty()) {
    for (const char* option : {"--probe-limit", "--probe-age"})
      if (arguments.has(option)) throw UsageError(std::string(option) + " goes with --probe or --probe-every");
    return;
  }
  if (model.error_reference == ErrorReference::batch)
    throw UsageError("a probe's readings count from the start of a batch, not from its mean: --error-reference start");
  ProbeLimits<> limits;
  limits.largest_um = arguments.number("--probe-limit", 0, 1e9).value_or(HUGE_VAL);
  limits.longest_s = 60 * arguments.number("--probe-age", 0, 1e9).value_or(HUGE_VAL);
  constexpr double outlier = 6;  // standard deviations of training; a second reading that agrees is none
  const Vector jump_um = model.degrees_of_freedom > 0 ? Vector(outlier * model.residual_deviation_um)
                                                      : Vector::Constant(model.model.errors(), HUGE_VAL);
  Index taken = 0, refused = 0;
  for (Predicted& one : all) {
    const Batch& batch = *one.batch;
    if (std::isfinite(limits.longest_s) && !batch.has_time())
      throw Error(batch.source, "no clock, which --probe-age needs", "a time column");
    std::vector<Index> rows;
    for (Index row = 1; every && row < batch.rows(); ++row)
      if (row % *every == 0) rows.push_back(row);
    const Index input = column.empty() ? -1 : batch.inputs.find(column);
    if (!column.empty() && input < 0)
      throw Error(batch.source, "no column '" + column + "' of numbers", name_list(batch.inputs.names));
    for (Index row = 0; input >= 0 && row < batch.rows(); ++row)
      if (batch.inputs.values(row, input) > 0) rows.push_back(row);
    ProbedPrediction probed = hold_readings(std::move(one.prediction), batch, rows, limits, jump_um);
    one.prediction = std::move(probed.prediction);
    taken += probed.taken, refused += probed.refused;
  }
  console.note("corrected by " + std::to_string(taken) + " readings of the probe, each held to the next" +
               (refused > 0 ? "; " + std::to_string(refused) +
                                  " were not taken: not measured, too large, or far off without a second that agrees"
                            : ""));
}

Exit run_predict(const Arguments& arguments, Console& console) {
  const auto& words = arguments.positionals();
  if (words.size() < 2) throw UsageError("predict takes a model file and at least one batch");
  if (!begins_as_json(words[0]) && std::any_of(words.begin() + 1, words.end(), begins_as_json))
    throw UsageError("'" + words[0] + "' is no model file; MODEL.json comes first, then the batches");
  TrainedModel model = load_model(words[0]);
  model.error_reference = error_reference(arguments, model.error_reference);
  CsvOptions options = csv_options(arguments);
  if (options.temperatures.empty()) options.temperatures = model.temperatures;
  if (options.errors.empty()) options.errors = model.errors;
  options.errors_may_lack = options.inputs_may_lack = true;
  if (!options.inputs) options.inputs = std::vector<std::string>{};
  for (const std::string& input : model.known_inputs)
    if (std::find(options.inputs->begin(), options.inputs->end(), input) == options.inputs->end())
      options.inputs->push_back(input);
  if (arguments.has("--probe") && std::find(options.inputs->begin(), options.inputs->end(),
                                            arguments.value_or("--probe", "")) == options.inputs->end())
    options.inputs->push_back(arguments.value_or("--probe", ""));
  const Campaign campaign = read_files(options, console, {words.begin() + 1, words.end()}).batches;
  note_faults(campaign, console);
  note_first_rows(campaign, model.reference, console);
  note_starts(campaign, model.error_reference, false, console);
  note_climates(campaign, model, console);
  std::vector<Predicted> all;
  for (const Batch& batch : campaign) all.push_back({&batch, predict(model, batch)});
  if (model.error_reference == ErrorReference::recorded) note_zeros(model, all, console);
  correct_by_probe(model, arguments, all, console);
  const bool by_rows = !arguments.has("--json") && !arguments.has("--summary");
  std::vector<std::string> names;
  for (const Predicted& one : all) names.push_back(one.batch->name);
  const std::vector<std::string> paths =
      by_rows ? outputs_in_folder(arguments, names, ".csv") : std::vector<std::string>();
  if (paths.empty())
    if (const auto path = output_path(arguments)) console.write_to(*path);
  for (std::size_t b = 0; b < paths.size(); ++b) write_atomically(paths[b], rows_text(model, {all[b]}));
  if (arguments.has("--json"))
    console.line(to_document(model, all).dump(1));
  else if (arguments.has("--summary"))
    print_summary(model, all, console);
  else if (paths.empty())
    console.print(rows_text(model, all));
  const auto limit = arguments.number("--limit", 0, 1e9);
  Exit exit = Exit::done;
  for (const auto& [batch, p] : all)
    for (Index e = 0; limit && e < p.S_um.size(); ++e)
      if (!(p.S_um(e) <= *limit)) {
        console.note("S of " + model.errors[static_cast<std::size_t>(e)] + " on " + batch->name + " is " +
                     fixed_text(p.S_um(e), 2) + " um, above the limit of " + exact_text(*limit) + " um");
        exit = Exit::negative;
      }
  return exit;
}

}  // namespace

Command predict_command() {
  std::vector<Option> options = campaign_options();
  options.push_back(error_reference_option());
  append(options, {{"--summary", "", "one line a batch instead of every row", 0, false},
                   {"--probe-every", "N", "correct by the measured error every N rows, held to the next", 0, false},
                   {"--probe", "COLUMN", "the same in the rows where COLUMN is above 0", 0, false},
                   {"--probe-limit", "UM", "a larger correction is not taken", 0, false},
                   {"--probe-age", "MIN", "an older one no longer counts", 0, false},
                   {"--limit", "UM", "exit 1 when S of a batch is above", 0, false},
                   {"--json", "", "thermfit-prediction/1 instead of CSV", 0, false},
                   {"--output", "FILE",
                    "the result goes to FILE, whole or not at all; a folder, or DIR/: rows of each batch to a file",
                    'o', false}});
  return {"predict",
          "thermal errors from temperatures, and which rows are foreign to the model",
          "MODEL.json BATCH.csv|FOLDER …",
          details,
          options,
          {{"thermfit predict model.json data/vcenter55/K08.csv", "every row of a summer batch"},
           {"thermfit predict model.json data/vcenter55 --summary", "one line a batch"}},
          run_predict};
}

}  // namespace thermfit::cli
