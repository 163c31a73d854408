#include <functional>

#include "cli/table.hpp"
#include "commands/commands.hpp"
#include "commands/learning_campaign.hpp"
#include "options/campaign_options.hpp"
#include "options/error_reference.hpp"
#include "options/fit_options.hpp"
#include "options/output.hpp"
#include "options/transfer_options.hpp"
#include "report/model_text.hpp"
#include "report/transfer_text.hpp"
#include "thermfit/fit/jackknife.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/io/json/model.hpp"
#include "thermfit/number.hpp"
#include "thermfit/robustness/transfer_left_out.hpp"
#include "thermfit/select/correlation.hpp"
#include "thermfit/select/fcgr.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    "Fits one model to all batches together and prints it: equation, coefficients, training domain, substitutes for "
    "lost sensors and, from three batches on, how far each coefficient moves when a batch is left out (jackknife, 95 % "
    "interval). -o saves it as thermfit-model/1 for predict, run and export.\n"
    "\n"
    "Points are the --points most sensitive ones (see rank), or all that --temperatures names with --points all. "
    "--each-batch fits every batch by itself and saves one model a batch in the folder of -o. Nearly dependent "
    "temperatures make MLR refuse the fast way over moments; --row-wise goes over the rows by QR.\n"
    "--method transfer fits what carries over to the next batch: the rises of all points, the same through a "
    "first-order "
    "lag, and those times the climate (how warm the machine is where a batch starts), by ridge with a penalty for "
    "each. "
    "Penalties and lag are chosen by leaving batches out, and what does not pay vanishes; predict takes such a model. "
    "--error-reference start goes well with it. --features adds known inputs (a column such as spindle_rpm: its change "
    "since the first row, and through the lag from 0) and differences (T3-T5), each kind with a penalty of its own; a "
    "model "
    "keeps them in um per unit of the column, and predict then needs the column.\n"
    "--json prints the model document instead of words.";

std::vector<Index> chosen_points(const Campaign& campaign, const Arguments& arguments, TrainingPlan& plan,
                                 Index fallback = 2) {
  const Index count = require_points(arguments, campaign, fallback);
  const std::string rule = arguments.choice("--rule", {"correlation", "fcgr"}, "correlation");
  if (count == campaign.front().temperatures.count()) {
    plan.selection = arguments.has("--temperatures") ? "given" : "all";
    return {};
  }
  plan.selection = rule;
  const Observations<> all = merged(observe(campaign, plan.reference, plan.error_reference));
  return rule == "fcgr" ? ByFcgr{}(all, count) : ByCorrelation{}(all, count);
}

void print_jackknife(const Campaign& campaign, const TrainedModel& model, const TrainingPlan& plan, Console& console) {
  if (campaign.size() < 3) return;
  std::vector<Moments<>> batches;
  for (const Observations<>& batch : observe(campaign, plan.reference, plan.error_reference))
    batches.push_back(plan.points.empty() ? batch.moments : batch.moments.subset(plan.points));
  const FitOptions same = settled(plan.options, model);
  const CoefficientSpread<> spread = jackknife(batches, [&](const Moments<>& m) { return fit(plan.method, m, same); });
  const Matrix half = spread.half_width(.95), p = spread.p_values();
  console.line("\nCoefficients with 95 % intervals from leaving batches out, um/K:");
  std::vector<std::string> header{"point"};
  for (const std::string& error : model.errors) header.insert(header.end(), {error, "+-", "p"});
  Table table(header);
  for (Index i = 0; i < half.rows(); ++i) {
    std::vector<std::string> row{model.temperatures[static_cast<std::size_t>(i)]};
    for (Index e = 0; e < half.cols(); ++e) {
      row.push_back(fixed_text(model.model.coefficients(i, e), 3));
      row.push_back(fixed_text(half(i, e), 3));
      row.push_back(p(i, e) < .001 ? "<.001" : fixed_text(p(i, e), 3));
    }
    table.add(row);
  }
  console.print(table.text(2));
}

/// What was asked for and could not be had, or says nothing.
void note_limits(const TrainedModel& model, const TrainingPlan& plan, const std::string& name, const Console& console) {
  if (model.degrees_of_freedom == 0)
    console.note(name + "no degrees of freedom are left, so that its S says nothing: fit more rows or fewer points");
  const Index wanted = plan.options.components.kind == ComponentRule::Kind::fixed ? plan.options.components.count : 0;
  if (model.components > 0 && model.components < wanted)
    console.note(name + std::to_string(wanted) + " latent variables were asked for, " +
                 std::to_string(model.components) + " are used: its points have no more independent directions");
}

Exit fit_each(const Campaign& campaign, const Arguments& arguments, TrainingPlan plan, Console& console) {
  std::vector<std::pair<std::string, TrainedModel>> models;
  for (const Batch& batch : campaign) {
    plan.points = chosen_points({batch}, arguments, plan);
    if (plan.method == Method::ridge && !arguments.has("--ridge-lambda"))
      throw UsageError("--each-batch with ridge needs --ridge-lambda: one batch cannot choose a penalty");
    models.emplace_back(batch.name, train({batch}, plan));
  }
  std::vector<std::string> names;
  for (const auto& [name, model] : models) names.push_back(name);
  const std::vector<std::string> paths = outputs_in_folder(arguments, names, ".json");
  if (paths.empty() && arguments.has("--output"))
    throw UsageError("--each-batch writes a file for each batch: -o FOLDER/");
  for (std::size_t b = 0; b < models.size(); ++b) {
    const auto& [name, model] = models[b];
    note_limits(model, plan, name + ": ", console);
    note_probe_levels(model, console);
    if (!paths.empty()) save_model(model, paths[b]);
    for (Index e = 0; e < model.model.errors(); ++e)
      console.print(wrap(name + ": " + model_equation(model, e) + "   (S " +
                             (model.degrees_of_freedom > 0 ? fixed_text(model.residual_deviation_um(e), 2) : "-") +
                             " um)",
                         80, 4));
  }
  return Exit::done;
}

/// Prints the model, or saves it, as the options say.
void deliver(const TrainedModel& model, const Arguments& arguments, const std::optional<std::string>& output,
             const std::function<void()>& print, Console& console) {
  if (arguments.has("--json"))
    console.line(model_to_json(model).dump(1));
  else
    print();
  if (!output) return;
  save_model(model, *output);
  console.note("model written to " + *output);
}

Exit fit_to_transfer(const Campaign& campaign, const Arguments& arguments, TrainingPlan& points_of,
                     const std::optional<std::string>& output, Console& console) {
  for (const char* option : {"--absolute", "--row-wise", "--each-batch", "--components", "--ridge-lambda"})
    if (arguments.has(option)) throw UsageError(std::string(option) + " does not go with --method transfer");
  TransferPlan plan = transfer_plan(arguments, campaign, points_of.error_reference);
  plan.points = chosen_points(campaign, arguments, points_of, campaign.front().temperatures.count());
  plan.selection = points_of.selection;
  note_lacking_blocks(arguments, campaign, plan, console);
  const TransferData<> data = transfer_data(campaign, plan);
  const TrainedModel model = train_transfer(campaign, plan, data);
  note_limits(model, points_of, "", console);
  deliver(
      model, arguments, output,
      [&] {
        print_model(model, console);
        if (campaign.size() < 3) return;
        const auto errors = static_cast<Index>(model.errors.size());
        const TransferLeftOut<> left_out = transfer_left_out(data.batches, errors, data.options);
        console.line("\nEach batch predicted by a model of the others, all chosen without it:");
        for (std::size_t e = 0; e < model.errors.size(); ++e)
          console.line("  " + model.errors[e] + ": " + in_words(left_out.figure(e)));
      },
      console);
  return Exit::done;
}

Exit run_fit(const Arguments& arguments, Console& console) {
  const auto output = arguments.has("--each-batch") ? std::nullopt : output_path(arguments);
  TrainingPlan plan;
  plan.options = fit_options(arguments);
  plan.reference = temperature_reference(arguments);
  plan.error_reference = error_reference(arguments);
  const Campaign campaign = learning_campaign(arguments, console, plan.reference);
  note_starts(campaign, plan.error_reference, true, console);
  plan.row_wise = arguments.has("--row-wise");
  const std::string method = arguments.choice("--method", {"pls", "mlr", "pcr", "ridge", "transfer"}, "pls");
  if (method == "transfer") return fit_to_transfer(campaign, arguments, plan, output, console);
  for (const char* option : {"--features", "--lag"})
    if (arguments.has(option)) throw UsageError(std::string(option) + " goes with --method transfer");
  for (const Method one : {Method::pls, Method::mlr, Method::pcr, Method::ridge})
    if (method == name(one)) plan.method = one;
  if (arguments.has("--each-batch")) return fit_each(campaign, arguments, plan, console);
  if (arguments.has("--output-folder"))
    throw UsageError("--output-folder goes with --each-batch; one model goes to -o");

  plan.points = chosen_points(campaign, arguments, plan);
  note_levels(campaign, plan.points, plan.reference, plan.error_reference, console);
  const TrainedModel model = train(campaign, plan);
  note_probe_levels(model, console);
  note_limits(model, plan, "", console);
  deliver(
      model, arguments, output,
      [&] {
        print_model(model, console);
        print_jackknife(campaign, model, plan, console);
      },
      console);
  return Exit::done;
}

}  // namespace

Command fit_command() {
  std::vector<Option> options = campaign_options();
  options.push_back(leave_out_option());
  options.push_back(absolute_option());
  options.push_back(error_reference_option());
  append(options, {{"--method", "M", "pls (default), mlr, pcr, ridge or transfer", 0, false}});
  append(options, fit_option_table());
  append(options, transfer_option_table());
  append(options, {{"--points", "K", "how many temperature points, or 'all' (default 2; of transfer: all)", 0, false},
                   {"--rule", "RULE", "how they are chosen: 'correlation' (default) or 'fcgr'", 0, false},
                   {"--row-wise", "", "QR and NIPALS over the rows instead of moments", 0, false},
                   {"--each-batch", "", "one model a batch instead of one of all", 0, false},
                   {"--output-folder", "DIR", "where --each-batch saves <batch>.json, as -o DIR/", 0, false},
                   {"--json", "", "the model document instead of words", 0, false},
                   {"--output", "FILE", "save the model, whole or not at all", 'o', false}});
  return {
      "fit",
      "a model of the thermal error: PLS, MLR, PCR, ridge or transfer",
      "BATCH.csv|FOLDER …",
      details,
      options,
      {{"thermfit fit data/vcenter55 -o model.json", "one PLS model on the two most sensitive points"},
       {"thermfit fit data/vcenter55 --method mlr --temperatures T1,T6,T8 --points all", "MLR on points of one's own"},
       {"thermfit fit data/vcenter55 --method transfer -o model.json", "one that carries over to the next batch"}},
      run_fit};
}

}  // namespace thermfit::cli
