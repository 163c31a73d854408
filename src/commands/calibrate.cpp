#include <algorithm>

#include "cli/command.hpp"
#include "commands/commands.hpp"
#include "options/campaign_options.hpp"
#include "options/output.hpp"
#include "report/calibration_json.hpp"
#include "report/calibration_text.hpp"
#include "report/diagnosis_words.hpp"
#include "thermfit/calibration/batch_numbers.hpp"
#include "thermfit/calibration/shortcomings.hpp"
#include "thermfit/calibration/start_tolerance.hpp"
#include "thermfit/diagnosis/search/screen.hpp"
#include "thermfit/diagnosis/sides/bad_cells.hpp"
#include "thermfit/diagnosis/sides/compare_machine.hpp"
#include "thermfit/diagnosis/sides/free_datum.hpp"
#include "thermfit/diagnosis/sides/unlike_sides.hpp"
#include "thermfit/diagnosis/sides/warm_side.hpp"
#include "thermfit/effects/catalogue.hpp"
#include "thermfit/io/json/machine.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    "Moves every number of the machine file - capacities, conductances, powers, expansions, sensor offsets and "
    "placements, by how much its parts start off the room, and the parameters of its effects - to the values most "
    "probable after the batches, each held by what was known of it before (`uncertainty` in the file). Channels are "
    "weighted by their own residual, and correlated residuals count as the few independent ones that they are.\n"
    "\n"
    "Prints each channel's rms before and after, what moved and by how many prior standard deviations, and what these "
    "data cannot tell: numbers they do not pin, and numbers they know only together. -o writes the calibrated "
    "machine.\n"
    "Begins with what failed: a machine that fits no better than before, channels far beyond their noise, parameters "
    "beyond belief or moved although the data do not know them; then what the machine may lack. Nothing is written "
    "where parameters are beyond belief, at a bound, or no better than before, unless --keep-failed. Batches that are "
    "not written down as "
    "the "
    "machine file is (units, signs, clocks, exchanged columns) are told and not fitted.\n"
    "Batches that start out of equilibrium are told, and their starts fitted one by one; so is a room that nothing "
    "measures where the machine file says \"ambient\": {\"unmeasured\": true}.\n"
    "A gap that remains afterwards is not miscalibration: see `thermfit diagnose`.\n"
    "Exit codes: 0 done; 1 failed, or stopped before it converged; 2 could not be done.";

std::vector<Option> options() {
  std::vector<Option> all{
      {"--output", "FILE", "write the calibrated machine there", 'o', false},
      {"--keep-failed", "", "write it even where the calibration is not to be believed", 0, false},
      {"--json", "", "machine-readable result, thermfit-calibration/1", 0, false},
      {"--all", "", "show every parameter, not only those that moved", 0, false},
      {"--starts", "N", "fits from different points, the best is kept; 1 to 100 (default: 3)", 0, false},
      {"--seed", "N", "of the points drawn (default: 1)", 0, false},
      {"--fixed-placement", "", "every sensor reads exactly its node, and every node starts where the file says", 0,
       false}};
  for (Option& option : campaign_options()) all.push_back(std::move(option));
  return all;
}

/// Gain of each effect where it promises most by one linear step together with calibration, most first: only what is
/// worth a suspicion.
std::vector<Candidate> promising(const MapFit& fit, const MachineRecord& seen, const Campaign& campaign,
                                 const EffectLibrary& effects) {
  constexpr double worth_nats = 5;  // a suspicion, no name
  const ScreeningBase<> base(seen, fit, effects, fit.prior.effects.size());
  std::vector<Candidate> result;
  for (Candidate& one : screen(base, effects, effects.candidates(setting_of(fit.prior, campaign)), 0))
    if (one.gain > worth_nats && std::none_of(result.begin(), result.end(), [&](const Candidate& other) {
          return other.added.effect == one.added.effect;
        }))
      result.push_back(std::move(one));
  return result;
}

/// What a machine may lack where its own numbers do not suffice: effects that promise something even after calibration,
/// at the places where the machine as given lacks them most. A failed calibration has bent its numbers to hide what is
/// missing, so that it is no good for the place.
std::vector<ThermalNetwork::AddedEffect> suspects(const Calibration& calibration, const ThermalNetwork& machine,
                                                  const MachineRecord& seen, const Campaign& campaign,
                                                  const EffectLibrary& effects) {
  const std::vector<Candidate> left = promising(calibration.fit, seen, campaign, effects);
  if (left.empty()) return {};
  MapFitOptions as_given;
  as_given.most_iterations = 0;
  std::vector<ThermalNetwork::AddedEffect> result;
  for (const Candidate& one : promising(map_fit(seen, machine, effects, as_given), seen, campaign, effects))
    if (result.size() < 3 && std::any_of(left.begin(), left.end(), [&](const Candidate& other) {
          return other.added.effect == one.added.effect;
        }))
      result.push_back(one.added);
  return result;
}

Exit run(const Arguments& arguments, Console& console) {
  std::vector<std::string> files = arguments.positionals();
  if (files.size() < 2) throw UsageError("calibrate takes a machine file and batches");
  const auto output = output_path(arguments);
  const EffectLibrary effects = standard_effects();
  ThermalNetwork network = read_machine(files.front(), effects);
  files.erase(files.begin());
  const bool fixed = arguments.has("--fixed-placement");
  if (fixed)
    network.uncertainty.sensor_response = 0;
  else
    network = with_placements(std::move(network));
  WithoutBadCells clean =
      without_bad_cells(read_measured(arguments, console, files, network), DataProblem::Side::measured);
  MachineRecord seen = observations_of(network, clean.campaign);
  for (DataProblem& one : warm_start_problem(network, seen.excitations)) {
    network = with_fitted_start(std::move(network));
    seen = observations_of(network, clean.campaign);
    one.rule = starts_were_fitted;
    console.note(place_of(one) + ": " + what_of(one) + "; " + remedy_of(one, SimulatorKind::network));
  }
  if (!fixed) network.uncertainty.start_share = start_share_sd(network, seen);
  for (const DataProblem& one : clean.left_out) console.note(place_of(one) + ": " + what_of(one));
  network = with_batch_numbers(std::move(network), seen);
  const std::vector<DataProblem> problems = compare_machine(network, clean.campaign, effects);
  for (const DataProblem& one : problems)
    console.note(place_of(one) + ": " + what_of(one) + "; " + remedy_of(one, SimulatorKind::network));
  if (sides_unlike(problems)) {
    console.note("not calibrated: the machine and the batches are not written down alike");
    return Exit::negative;
  }
  free_datums(network, clean.campaign, problems);
  seen = observations_of(network, clean.campaign);
  CalibrationOptions how;
  how.starts = static_cast<int>(arguments.integer("--starts", 1, 100).value_or(how.starts));
  how.seed = static_cast<std::uint64_t>(arguments.integer("--seed", 0, 1L << 53).value_or(1));
  console.progress("calibrating …");
  network = with_batch_numbers_that_pay(network, seen, effects);
  const Calibration calibration = calibrate(seen, network, effects, how);
  CalibrationVerdict verdict;
  verdict.shortcomings = shortcomings(calibration, seen);
  if (!verdict.shortcomings.empty()) verdict.suspects = suspects(calibration, network, seen, clean.campaign, effects);
  console.progress("");
  if (output && verdict.spoilt() && !arguments.has("--keep-failed"))
    console.note(*output + ": not written: the calibrated machine is not to be believed");
  else if (output)
    save_machine(with_own_datums(calibration.fit.network()), *output);
  if (arguments.has("--json"))
    console.print(calibration_json(calibration, seen, verdict));
  else
    print_calibration(calibration, seen, verdict, arguments.has("--all"), console);
  return calibration.fit.converged && !verdict.failed() ? Exit::done : Exit::negative;
}

}  // namespace

Command calibrate_command() {
  return {"calibrate",
          "fit the numbers of a machine file to batches, each under what is known of it",
          "machine.json BATCH.csv …",
          details,
          options(),
          {{"thermfit calibrate machine.json real -o calibrated.json", "all parameters, all batches"},
           {"thermfit calibrate machine.json K0[1-6].csv --all", "some batches, every parameter shown"}},
          run};
}

}  // namespace thermfit::cli
