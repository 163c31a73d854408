#include "thermfit/network/simulate.hpp"

#include <set>

#include "cli/command.hpp"
#include "commands/commands.hpp"
#include "options/campaign_options.hpp"
#include "options/output.hpp"
#include "report/diagnosis_words.hpp"
#include "thermfit/diagnosis/sides/warm_side.hpp"
#include "thermfit/effects/catalogue.hpp"
#include "thermfit/io/csv/writer.hpp"
#include "thermfit/io/files/atomic_file.hpp"
#include "thermfit/io/json/machine.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    "Runs the machine of a thermfit-machine/1 file on the inputs, clock and ambient temperature of each batch. What "
    "the "
    "batches measured otherwise is not looked at, except first readings where the machine file asks for them "
    "(\"initial\": \"measured\" or \"fitted\", \"ambient\": {\"unmeasured\": true}). Batches that start out of "
    "equilibrium "
    "although the file says nothing of it are told.\n"
    "\n"
    "Prints CSV: time_s, the machine's sensors and displacements, then the inputs. Inputs hold their value to the next "
    "sample, ambient is linear between samples, and each step is solved exactly, so that the result does not depend "
    "on how often was sampled. Several batches go to one folder, a file each, or one below the other with a "
    "column `batch`.\n"
    "Exit codes: 0 done; 2 could not be done.";

std::vector<Option> options() {
  std::vector<Option> all{
      {"--output", "FILE", "write the result there instead of to stdout; a folder, or DIR/: one file for each batch",
       'o', false},
      {"--output-folder", "DIR", "one file for each batch, as -o DIR/", 0, false},
      {"--decimals", "N", "digits after the point; 0 to 17 (default: 4)", 0, false},
      {"--nodes", "", "temperatures of all nodes instead of the sensors'", 0, false}};
  for (Option& option : campaign_options()) all.push_back(std::move(option));
  return all;
}

/// The simulated batch: the machine's channels in place of the measured ones.
Batch simulated_batch(const ThermalNetwork& network, const Batch& batch, const Simulation& simulation, bool nodes) {
  Batch result;
  result.name = batch.name;
  result.time_s = batch.time_s;
  result.inputs = batch.inputs;
  if (nodes) {
    for (const auto& node : network.nodes) result.temperatures.names.push_back(node.name);
    result.temperatures.values = simulation.nodes_degC.leftCols(network.node_count());
  } else {
    for (const auto& sensor : network.sensors) result.temperatures.names.push_back(sensor.column);
    result.temperatures.values = simulation.channels.leftCols(result.temperatures.count());
  }
  for (const auto& output : network.displacements) result.errors.names.push_back(output.output);
  result.errors.values = simulation.channels.rightCols(result.errors.count());
  return result;
}

/// `text` with a first column that names the batch; the header only where it is the first.
std::string with_batch_column(const std::string& text, const std::string& batch, bool first) {
  std::string result;
  for (std::size_t begin = 0, line = 0; begin < text.size(); ++line) {
    const std::size_t end = text.find('\n', begin) + 1;
    if (line > 0 || first) result += (line == 0 ? "batch" : csv_field(batch)) + ',' + text.substr(begin, end - begin);
    begin = end;
  }
  return result;
}

Exit run(const Arguments& arguments, Console& console) {
  std::vector<std::string> files = arguments.positionals();
  if (files.size() < 2) throw UsageError("simulate takes a machine file and batches");
  if (arguments.has("--output") && arguments.has("--output-folder"))
    throw UsageError("--output and --output-folder exclude each other");
  const EffectLibrary effects = standard_effects();
  const ThermalNetwork network = read_machine(files.front(), effects);
  files.erase(files.begin());
  const Campaign campaign = read_campaign(arguments, console, files);
  const int decimals = static_cast<int>(arguments.integer("--decimals", 0, 17).value_or(4));
  const std::vector<Excitation> excitations = excitations_of(network, campaign);
  const std::vector<Simulation> simulations = simulate(network, excitations, effects);
  for (const DataProblem& one : warm_start_problem(network, excitations))
    console.note(place_of(one) + ": " + what_of(one) + ", the simulation starts at the room; " +
                 remedy_of(one, SimulatorKind::network));
  if (network.ambient.rule == ThermalNetwork::Ambient::Rule::unmeasured)
    console.note("nothing measures the room: it is held where the colder parts start; calibrate and diagnose fit it");

  std::set<std::string> left_out;
  for (const std::string& name : campaign.front().temperatures.names) left_out.insert(name);
  for (const auto& sensor : network.sensors) left_out.erase(sensor.column);
  if (!left_out.empty())
    console.note("the machine has no sensor for " + name_list({left_out.begin(), left_out.end()}) + "; left out");

  std::vector<std::string> names;
  for (const Batch& batch : campaign) names.push_back(batch.name);
  const std::vector<std::string> paths = outputs_in_folder(arguments, names, ".csv");
  if (paths.empty())
    if (const auto path = output_path(arguments)) console.write_to(*path);
  for (std::size_t b = 0; b < campaign.size(); ++b) {
    const std::string text =
        write_csv(simulated_batch(network, campaign[b], simulations[b], arguments.has("--nodes")), decimals);
    if (!paths.empty())
      write_atomically(paths[b], text);
    else
      console.print(campaign.size() == 1 ? text : with_batch_column(text, campaign[b].name, b == 0));
  }
  return Exit::done;
}

}  // namespace

Command simulate_command() {
  return {"simulate",
          "run the machine's thermal network on the inputs of batches",
          "machine.json BATCH.csv …",
          details,
          options(),
          {{"thermfit simulate machine.json K01.csv -o K01-simulated.csv", "one batch"},
           {"thermfit simulate machine.json real -o sim/", "a campaign, a file for each batch"}},
          run};
}

}  // namespace thermfit::cli
