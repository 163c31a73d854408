#include "thermfit/diagnosis/diagnose.hpp"

#include <algorithm>

#include "commands/commands.hpp"
#include "options/campaign_options.hpp"
#include "options/output.hpp"
#include "report/diagnosis_json.hpp"
#include "report/diagnosis_text.hpp"
#include "thermfit/constants.hpp"
#include "thermfit/diagnosis/outputs/diagnose_outputs.hpp"
#include "thermfit/effects/catalogue.hpp"
#include "thermfit/io/json/machine.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    R"(Says where the gap between a simulator and the machine lies, which unmodelled effect causes it, and how far it shrinks once the effect is added: judged on batches not used for fitting.

With a machine file, the simulator is the lumped network that it describes: every effect of the catalogue is added at every place and refitted together with the calibration. --write saves the machine with the effect added; `thermfit simulate` then runs it.
With --sim, the simulator is anybody's: only its output is read, one file a batch with the same names as the measured ones. Effects then act through the traces they leave in the outputs.

First the two sides are compared: a column in another unit, with the other sign, exchanged or copied, and a clock that is off are data problems; where one is certain, it is told with what to write, and no effect is looked for. A probe that counts from another zero in some batches is told and its zero left free. Options of the batches hold for the simulator's output too, unless its own (--sim-…) are given. Single cells that are no readings are left out and told. Batches that start out of equilibrium, because the machine ran before, are told, and their starts fitted one by one; a room that nothing measures is fitted where the machine file says "ambient": {"unmeasured": true}.
The report gives one sentence first, then what is only suspected and how probable it is, what was ruled out and why, what could not be told apart, the next experiment, data problems, and tables.
Verdict unknown may come with a part of the cause: something acts there beyond doubt, but the rest of the gap has no name. Neither a part nor a suspicion is a name; --write leaves them out.
Verdicts: none (no gap), miscalibration (the simulator's own parameters close it), effect, ambiguous (several remain), unknown (real, but nothing in the catalogue closes it).
Exit codes: 0 none, miscalibration or effect; 1 ambiguous, unknown, or sides that are not written down alike; 2 could not be done.)";

std::vector<Option> options() {
  std::vector<Option> all{
      {"--sim", "PATH", "output of your own simulator: batches with the names of the measured ones", 0, true},
      {"--effects", "NAME,…", "look for these effects only", 0, true},
      {"--without", "NAME,…", "leave these effects out of the catalogue", 0, true},
      {"--write", "FILE", "save the calibrated machine with the effects found", 0, false},
      {"--ambient", "NAME", "with --sim: the temperature column of the room (default: recognised)", 0, false},
      {"--reference", "DEGC", "with --sim: reference temperature of expansion (default: 20)", 0, false},
      {"--seed", "N", "seed of resampling (default: 1)", 0, false},
      {"--threads", "N", "threads to use (default: all cores)", 0, false},
      {"--json", "", "machine-readable result, thermfit-diagnosis/1", 0, false},
      {"--output", "FILE", "write the result there instead of to stdout", 'o', false}};
  for (auto* more : {campaign_options, simulated_options})
    for (Option& option : more()) all.push_back(std::move(option));
  return all;
}

/// Names of effects, checked against the catalogue.
std::vector<std::string> effect_names(const Arguments& arguments, const std::string& option) {
  const std::vector<std::string> known = standard_effects().names();
  std::vector<std::string> names = arguments.list(option);
  for (const std::string& name : names) {
    if (std::count(known.begin(), known.end(), name) > 0) continue;
    std::string message = option + ": no effect is called '" + name + "'";
    if (const auto near = nearest(name, known)) message += "; did you mean '" + *near + "'?";
    for (std::size_t i = 0; i < known.size(); ++i) message += (i ? ", " : " Known: ") + known[i];
    throw UsageError(message);
  }
  return names;
}

unsigned seed_of(const Arguments& arguments) {
  return static_cast<unsigned>(arguments.integer("--seed", 0, 2147483647).value_or(1));
}

unsigned thread_count(const Arguments& arguments) {
  return static_cast<unsigned>(arguments.integer("--threads", 1, 1024).value_or(0));
}

Diagnosis diagnose_by_outputs(const Arguments& arguments, const Console& console) {
  OutputsOptions options;
  options.room = arguments.value_or("--ambient", "");
  options.reference_degC = arguments.number("--reference", absolute_zero_degC, 2000).value_or(20);
  options.effects = effect_names(arguments, "--effects");
  options.without = effect_names(arguments, "--without");
  options.seed = seed_of(arguments);
  options.threads = thread_count(arguments);
  options.progress = [&console](const std::string& what) { console.progress(what); };
  const Campaign real = read_campaign(arguments, console, arguments.positionals());
  const Campaign sim = read_simulated(arguments, console, arguments.values("--sim"));
  return diagnose_outputs(real, sim, standard_effects(), options);
}

Diagnosis diagnose_machine(const Arguments& arguments, const Console& console) {
  const auto& words = arguments.positionals();
  const bool first_is_machine =
      !words.empty() && words[0].size() > 5 && words[0].compare(words[0].size() - 5, 5, ".json") == 0;
  if (!first_is_machine || words.size() < 2)
    throw UsageError("diagnose takes a machine file (*.json) and measured batches, or --sim and measured batches");
  const auto output = output_path(arguments, "--write");
  const EffectLibrary library = standard_effects();
  const ThermalNetwork machine = read_machine(words[0], library);
  DiagnoseOptions options;
  options.effects = effect_names(arguments, "--effects");
  options.without = effect_names(arguments, "--without");
  options.seed = seed_of(arguments);
  options.search.threads = thread_count(arguments);
  options.search.progress = [&console](const std::string& step, double share) {
    console.progress(step + " … " + fixed_text(100 * share, 0) + " %");
  };
  const Campaign real = read_measured(arguments, console, {words.begin() + 1, words.end()}, machine);
  require_time(real);
  Diagnosis found = diagnose(machine, real, library, options);
  if (found.machine.empty()) found.machine = words[0];
  if (output && found.unlike_sides)
    console.note(*output + ": not written: the machine and the batches are not written down alike");
  else if (output)
    save_machine(found.with_effects, *output);
  return found;
}

Exit run_diagnose(const Arguments& arguments, Console& console) {
  if (const auto path = output_path(arguments)) console.write_to(*path);
  const bool paired = arguments.has("--sim");
  if (paired && arguments.has("--write"))
    throw UsageError("--write needs a machine file: with --sim there is no machine to save");
  for (const char* option : {"--ambient", "--reference"})
    if (!paired && arguments.has(option))
      throw UsageError(std::string(option) + " goes with --sim; a machine file tells it itself");
  for (const Option& option : simulated_options())
    if (!paired && arguments.has(option.name))
      throw UsageError(option.name + " goes with --sim; `channels` of a machine file tell how its batches are written");
  const Diagnosis diagnosis = paired ? diagnose_by_outputs(arguments, console) : diagnose_machine(arguments, console);
  console.progress({});
  if (arguments.has("--json"))
    console.line(diagnosis_json(diagnosis));
  else
    console.print(diagnosis_text(diagnosis));
  const bool told = diagnosis.verdict != Verdict::ambiguous && diagnosis.verdict != Verdict::unknown;
  return told ? Exit::done : Exit::negative;
}

}  // namespace

Command diagnose_command() {
  return {"diagnose",
          "where the sim-to-real gap lies, which effect causes it, how far it shrinks",
          "machine.json BATCH.csv … | --sim SIM BATCH.csv …",
          details,
          options(),
          {{"thermfit diagnose data/withheld/case-05/machine.json data/withheld/case-05/real --effects "
            "speed-shift,hysteresis",
            "the machine's own network: effects are added to it"},
           {"thermfit diagnose --sim data/withheld/case-05/sim data/withheld/case-05/real",
            "any simulator: its output beside the measurement"}},
          run_diagnose};
}

}  // namespace thermfit::cli
