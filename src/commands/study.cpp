#include <filesystem>

#include "commands/commands.hpp"
#include "commands/learning_campaign.hpp"
#include "options/campaign_options.hpp"
#include "options/error_reference.hpp"
#include "options/fit_options.hpp"
#include "options/output.hpp"
#include "options/transfer_options.hpp"
#include "report/study_json.hpp"
#include "report/study_text.hpp"
#include "thermfit/io/json/campaign.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    "Leads with what predicts best: every batch left out once and predicted by one model of all the others, by every "
    "method and by transfer (see fit), which chooses without the batch; S_mean and S_std over batches, beside the "
    "paper's.\n"
    "\n"
    "Then the paper's whole comparison. In every batch the temperature points most correlated with the error are "
    "chosen and "
    "a model is fitted; every model predicts every other batch; S is the residual standard deviation of one model on "
    "one batch, S_mean and S_std its mean and spread over batches. Prints the correlations and chosen points, the "
    "coefficients of every batch's model, the matrix of S, S_mean and S_std in both readings (per model: of each model "
    "over the other batches, then over models; pooled: over all pairs), the sweep over the number of points, PLS, MLR, "
    "PCR and ridge side by side with the FCGR baseline, and every batch left out once and predicted by one model of "
    "all "
    "the others.\n"
    "\n"
    "Where the batches' folder holds a campaign.json, its title, origin (measured or simulated) and published figures "
    "are shown beside.\n"
    "--json prints thermfit-study/1: \"batches\" (name, rows, correlations points x errors), \"methods\" (method, "
    "selection, \"chosen\" with batch_models, S_um models x batches, per_model, pooled, worst; \"sweep\" one entry a "
    "number of points), \"left_out\" (method, components, mean_rmse_um, pooled_rmse_um, S_mean_um, S_std_um, rmse_um "
    "by batch; transfer "
    "also what it chose for each), "
    "\"published\".\n"
    "Exit codes: 0 done; 1 S_mean or S_std exceeds the limit given; 2 could not be done.";

/// campaign.json beside the batches, when all of them lie in one folder.
void find_card(const Campaign& campaign, StudyReport& report) {
  const std::filesystem::path folder = std::filesystem::path(campaign.front().source).parent_path();
  for (const Batch& batch : campaign)
    if (batch.source.empty() || std::filesystem::path(batch.source).parent_path() != folder) return;
  const std::filesystem::path path = folder / "campaign.json";
  if (!std::filesystem::exists(path)) return;
  report.card_path = path.string();
  report.card = read_campaign_card(report.card_path);
}

/// Whether the first method stays below the limits the user set.
Exit judge(const StudyReport& report, const Arguments& arguments, Console& console) {
  const auto mean = arguments.number("--limit-s-mean", 0, 1e9), std = arguments.number("--limit-s-std", 0, 1e9);
  const SweepStep<>* step = report.study.methods.front().chosen();
  if (!step) return Exit::negative;
  Exit exit = Exit::done;
  for (std::size_t e = 0; e < report.errors.size(); ++e) {
    const MeanAndStd<>& figure = step->robustness[e].per_model;
    const auto above = [&](const char* what, double value, const std::optional<double>& limit) {
      if (!limit || value <= *limit) return;
      console.note(std::string(what) + " of " + report.errors[e] + " is " + fixed_text(value, 2) +
                   " um, above the limit of " + exact_text(*limit) + " um");
      exit = Exit::negative;
    };
    above("S_mean", figure.S_mean, mean);
    above("S_std", figure.S_std, std);
  }
  return exit;
}

/// The method transfer beside the paper's, where rises and three batches allow it.
void study_transfer(const Campaign& campaign, const TransferPlan& plan, StudyReport& report) {
  if (report.reference == TemperatureReference::absolute)
    return void(report.transfer_refusal = "transfer is of rises, not of absolute temperatures");
  try {
    const TransferData<> data = transfer_data(campaign, plan);
    report.transfer = transfer_left_out(data.batches, static_cast<Index>(report.errors.size()), data.options);
    report.transfer_lags_min = data.lags_min;
  } catch (const Error& error) {
    report.transfer_refusal = error.what();
  }
}

Exit run_study(const Arguments& arguments, Console& console) {
  StudyReport report;
  report.reference = temperature_reference(arguments);
  report.error_reference = error_reference(arguments);
  const Campaign campaign = learning_campaign(arguments, console, report.reference);
  const TransferPlan to_transfer = transfer_plan(arguments, campaign, report.error_reference);
  note_starts(campaign, report.error_reference, true, console);
  require_errors(campaign);
  const std::vector<Observations<>> batches = observe(campaign, report.reference, report.error_reference);
  note_levels(campaign, moments_of(batches), {}, report.reference, report.error_reference, console);
  StudyOptions options;
  options.points = require_points(arguments, campaign, 2);
  options.most_points = arguments.integer("--most-points", 1, 10000).value_or(0);
  options.fit = fit_options(arguments);
  options.own_batch = arguments.has("--own-batch");

  report.temperatures = campaign.front().temperatures.names;
  report.errors = campaign.front().errors.names;
  for (const Batch& batch : campaign) {
    report.batches.push_back(batch.name);
    report.rows.push_back(batch.rows());
  }
  find_card(campaign, report);
  report.study = study(batches, options);
  study_transfer(campaign, to_transfer, report);
  if (const auto path = output_path(arguments)) console.write_to(*path);
  if (arguments.has("--json"))
    console.print(study_json(report));
  else
    print_study(report, console);
  return judge(report, arguments, console);
}

}  // namespace

Command study_command() {
  std::vector<Option> options = campaign_options();
  options.push_back(leave_out_option());
  options.push_back(absolute_option());
  options.push_back(error_reference_option());
  append(options, fit_option_table());
  append(options, transfer_option_table());
  append(options, {{"--points", "K", "temperature points of every batch's model, or 'all' (default 2)", 0, false},
                   {"--most-points", "K", "the sweep stops there (default: all points)", 0, false},
                   {"--own-batch", "", "a model's own batch counts in S_mean and S_std", 0, false},
                   {"--limit-s-mean", "UM", "exit 1 when S_mean of PLS is above", 0, false},
                   {"--limit-s-std", "UM", "exit 1 when S_std of PLS is above", 0, false},
                   {"--json", "", "thermfit-study/1 instead of tables", 0, false},
                   output_option("the result")});
  return {"study",
          "the whole comparison: selection, models, S across batches, methods side by side",
          "BATCH.csv|FOLDER …",
          details,
          options,
          {{"thermfit study data/vcenter55", "every table on the example campaign"},
           {"thermfit study data/vcenter55 --points 3 --json -o study.json", "the same with three points, as JSON"}},
          run_study};
}

}  // namespace thermfit::cli
