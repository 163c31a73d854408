#pragma once

/// The options by which every command reads batches, and the reading itself.

#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/console.hpp"
#include "thermfit/batch/temperature_rise.hpp"
#include "thermfit/io/csv/reader.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit::cli {

/// Roles of columns, dialect, missing values: to be appended to a command's own options.
std::vector<Option> campaign_options();

/// What the dialects that have a name set, one a paragraph.
std::string dialects_help();

/// `--absolute`, for commands that fit or compare temperatures; temperature_reference() reads it.
Option absolute_option();
TemperatureReference temperature_reference(const Arguments& arguments);

/// Roles, clock and units of the simulator's output, for commands that read one.
std::vector<Option> simulated_options();

/// Whose files are read.
enum class CampaignSide {
  measured,  ///< the batches
  simulated  ///< the simulator's output: simulated_options() come before those of the batches
};

/// What the options say about CSV files. Throws UsageError on a value that is not allowed.
CsvOptions csv_options(const Arguments& arguments, CampaignSide side = CampaignSide::measured);

/// Files, folders (their *.csv and *.csv.gz, else *.txt, *.asc, *.lvm, *.dat and *.tsv), quoted globs and `-` as a list
/// of files; folders and globs in order of name, digits compared as numbers. Throws Error when one of them is not there
/// or holds nothing.
std::vector<std::string> find_files(const std::vector<std::string>& paths);

/// Reads the batches of all `paths` and says on stderr what was not plain about them. Throws UsageError without paths.
CsvReading read_files(const CsvOptions& options, const Console& console, const std::vector<std::string>& paths);
/// For who needs no inputs, their cells may be empty.
Campaign read_campaign(const Arguments& arguments, const Console& console, const std::vector<std::string>& paths,
                       bool needs_inputs = true);
/// The output of a simulator.
Campaign read_simulated(const Arguments& arguments, const Console& console, const std::vector<std::string>& paths);
/// Batches of a machine, whose file says how they are written where they and the options do not.
Campaign read_measured(const Arguments& arguments, const Console& console, const std::vector<std::string>& paths,
                       const ThermalNetwork& machine);

/// Whether a plain file begins as a JSON document does.
bool begins_as_json(const std::string& path);

/// Says which batches hold the numbers of another.
void note_copies(const Campaign& campaign, const Console& console);

/// Throws Error, with the columns there are, when batches have no thermal error to be fitted or compared.
void require_errors(const Campaign& campaign);

/// Throws Error when a batch has no clock, as simulation needs.
void require_time(const Campaign& campaign);

}  // namespace thermfit::cli
