#include "cli/labels.hpp"
#include "cli/table.hpp"
#include "commands/commands.hpp"
#include "commands/learning_campaign.hpp"
#include "options/campaign_options.hpp"
#include "options/error_reference.hpp"
#include "options/fit_options.hpp"
#include "options/output.hpp"
#include "thermfit/io/json/node.hpp"
#include "thermfit/number.hpp"
#include "thermfit/select/correlation.hpp"
#include "thermfit/select/fcgr.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    "Ranks the temperature points by the size of their correlation with the thermal error, batch by batch and over all "
    "rows together; the first ones are the paper's temperature-sensitive points (TMP). With --rule fcgr, what fuzzy "
    "clustering and grey relational grade choose instead.\n"
    "\n"
    "A point that does not vary has no correlation and comes last; equal ones keep the order of their columns.\n"
    "--json prints thermfit-rank/1: per batch and for \"all\", \"points\" best first with \"correlation\" for each "
    "error.";

struct Ranking {
  std::string batch;
  std::vector<Index> points;
  Matrix correlations;
};

std::vector<Ranking> rank_all(const Campaign& campaign, const Arguments& arguments, Index count) {
  const bool fcgr = arguments.choice("--rule", {"correlation", "fcgr"}, "correlation") == "fcgr";
  std::vector<Observations<>> batches = observe(campaign, temperature_reference(arguments), error_reference(arguments));
  if (batches.size() > 1) {
    batches.push_back(merged(batches));
    batches.back().name = "all";
  }
  std::vector<Ranking> rankings;
  for (const Observations<>& batch : batches)
    rankings.push_back(
        {batch.name, fcgr ? ByFcgr{}(batch, count) : ByCorrelation{}(batch, count), correlations(batch.moments)});
  return rankings;
}

Exit run_rank(const Arguments& arguments, Console& console) {
  const Campaign campaign = learning_campaign(arguments, console, temperature_reference(arguments));
  note_starts(campaign, error_reference(arguments), true, console);
  const Index count = require_points(arguments, campaign, campaign.front().temperatures.count());
  note_levels(campaign, {}, temperature_reference(arguments), error_reference(arguments), console);
  const std::vector<std::string>& names = campaign.front().temperatures.names;
  const std::vector<std::string>& errors = campaign.front().errors.names;
  const std::vector<Ranking> rankings = rank_all(campaign, arguments, count);
  if (const auto path = output_path(arguments)) console.write_to(*path);
  if (arguments.has("--json")) {
    Json document{{"format", "thermfit-rank/1"},
                  {"errors", errors},
                  {"error_reference", name(error_reference(arguments))},
                  {"batches", Json::array()}};
    for (const Ranking& ranking : rankings) {
      Json points = Json::array();
      for (const Index p : ranking.points)
        points.push_back({{"point", names[static_cast<std::size_t>(p)]},
                          {"correlation", to_json(Vector(ranking.correlations.row(p).transpose()))}});
      document["batches"].push_back({{"batch", ranking.batch}, {"points", std::move(points)}});
    }
    console.line(document.dump(1));
    return Exit::done;
  }
  const ErrorReference reference = error_reference(arguments);
  std::vector<std::string> header{"batch"};
  for (Index k = 1; k <= count; ++k) header.push_back(std::to_string(k));
  std::vector<std::string> batches;
  for (const Batch& batch : campaign) batches.push_back(batch.name);
  const Labels batch_labels(batches, 'b', 18), sensors(names, 'p', label_width(static_cast<std::size_t>(count)));
  Table table(header);
  for (std::size_t b = 0; b < rankings.size(); ++b) {
    const Ranking& ranking = rankings[b];
    if (b == batches.size()) table.rule();
    std::vector<std::string> row{b < batches.size() ? batch_labels[b] : ranking.batch};
    for (const Index p : ranking.points) {
      std::string cell = sensors[static_cast<std::size_t>(p)];
      for (Index e = 0; e < ranking.correlations.cols(); ++e) cell += ' ' + known_text(ranking.correlations(p, e), 2);
      row.push_back(cell);
    }
    table.add(row);
  }
  console.print(wrap("Temperature points, most sensitive first, with their correlation with " + name_list(errors) +
                         (reference == ErrorReference::recorded ? "" : ", " + in_words(reference)) + ":",
                     80, 0));
  if (const std::string text = legends(batch_labels, sensors); !text.empty()) console.print(text + '\n');
  console.print(table.text());
  return Exit::done;
}

}  // namespace

Command rank_command() {
  std::vector<Option> options = campaign_options();
  options.push_back(leave_out_option());
  options.push_back(absolute_option());
  options.push_back(error_reference_option());
  append(options, {{"--rule", "RULE", "'correlation' (default) or 'fcgr'", 0, false},
                   {"--points", "K", "show the first K (default: all)", 0, false},
                   {"--json", "", "thermfit-rank/1 instead of a table", 0, false},
                   output_option("the result")});
  return {"rank",
          "temperature points by how well they follow the thermal error",
          "BATCH.csv|FOLDER …",
          details,
          options,
          {{"thermfit rank data/vcenter55 --points 4", "the four best of every batch"},
           {"thermfit rank data/vcenter55/K01.csv --rule fcgr --points 2", "the baseline's choice"}},
          run_rank};
}

}  // namespace thermfit::cli
