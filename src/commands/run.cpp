#include <cmath>

#include "cli/command.hpp"
#include "cli/line_source.hpp"
#include "commands/commands.hpp"
#include "commands/live_compensation.hpp"
#include "options/compensation_options.hpp"
#include "options/error_reference.hpp"
#include "options/output.hpp"
#include "thermfit/io/json/model.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    "Reads temperatures as CSV lines from standard input and answers each line with one, at once: for pipes from MQTT, "
    "OPC UA or a data logger. The first line names the columns; those of the model are found by name (units in "
    "brackets are converted), others are passed over. One line is one step of --period seconds; where a time column "
    "(time_s, time_min, ...) tells more or less, that counts.\n"
    "\n"
    "Corrections are relative to the thermal state when the work offset was probed. A line `datum` says that it is "
    "probed now: the next lines that agree become the zero, and the offset 0 there. --state FILE keeps the zero over a "
    "power cycle. Without either the state is `no datum` and the offset 0, unless --zero first takes the first lines. "
    "Errors that count from the start of each batch (fit --error-reference start) are just what a datum makes of them; "
    "a "
    "probe's zero or a machine coordinate in a model is no error, and refused where it would be applied.\n"
    "\n"
    "A model of the method transfer runs with its lags and climate: a session begins with the first good lines (all "
    "sensors), or after a pause of 4 hours. --state keeps where the lags are, every minute and at the end; after a "
    "power "
    "cycle they go on if the time off is known, from a time column that goes on or from --off. Where it is not known "
    "there is no zero until a datum.\n"
    "\n"
    "A column `probe_` and the name of an error (probe_Z) is a probe's: a number there is the thermal error measured "
    "at "
    "that line, um, the whole of it since the zero (what is left of it, less the offset applied; plus it with --sign "
    "error). What it differs by from the demand is added from the next line on, until the next reading or --probe-age; "
    "--probe-limit and a reading far off the last one refuse it, told on stderr. A datum and a restart drop it.\n"
    "\n"
    "Answer: line number, offset of each error in um, state, status word, first sensor not used, why, where the zero "
    "is from. A line that "
    "cannot be read, or a cell that is no number, counts as readings that are missing: the offset is held, the answer "
    "still comes. --watchdog S answers also when no line came for S seconds.\n"
    "\n"
    "--shadow applies nothing: offset columns are zero, `shadow_` columns tell what would have been applied; where "
    "the input has a measured error of the same name, `remaining_` columns tell what would have been left of it, and a "
    "summary is printed on stderr at the end.\n"
    "Exit codes: 0 end of input; 2 the model or the first line could not be used, or the output is closed.";

Exit run_run(const Arguments& arguments, Console& console) {
  if (arguments.positionals().size() != 1) throw UsageError("run takes one model file");
  if (const auto state = arguments.value("--state")) require_not_read(arguments, *state);
  const TrainedModel trained = load_model(arguments.positionals()[0]);
  require_no_inputs(trained, arguments.positionals()[0]);
  LiveCompensation live(trained, compensation_wishes(arguments), arguments.has("--shadow"),
                        arguments.value_or("--state", ""), arguments.number("--off", 0, 1e9).value_or(std::nan("")));
  note_probe_levels(trained, console);
  const double watchdog_s = arguments.number("--watchdog", .001, 86400).value_or(0);

  LineSource source(0);
  std::string text;
  do {
    if (source.next(text, 0) != LineSource::Got::line)
      throw Error("standard input", "no line", "a line of column names");
  } while (!CsvLineReader::has_content(text));
  live.read_header(text, source.line_number());
  console.line(live.answer_header());
  console.flush();
  long bad_lines = 0;
  for (;;) {
    const LineSource::Got got = source.next(text, watchdog_s);
    if (got == LineSource::Got::end) break;
    if (got == LineSource::Got::line && !CsvLineReader::has_content(text)) continue;
    const bool datum = got == LineSource::Got::line && text == "datum";
    if (datum) live.take_datum();
    const bool readable = datum || (got == LineSource::Got::line && live.read_readings(text));
    if (got == LineSource::Got::line && !readable && bad_lines++ < 10)
      console.note("standard input:" + std::to_string(source.line_number()) +
                   ": not as many cells as the first line names; counts as missing readings");
    if (!readable) live.lose_readings(got == LineSource::Got::nothing ? watchdog_s : 0);
    console.line(live.answer(source.line_number()));
    for (const std::string& remark : live.remarks()) console.note(remark);
    if (!console.flush())  // nobody compensates: whoever watches this process must see it
      throw Error("standard output", "the reader of the answers is gone", "", "start it and this again");
  }
  live.finish();
  if (bad_lines > 10) console.note(std::to_string(bad_lines) + " lines could not be read");
  for (const std::string& remark : live.summary()) console.note(remark);
  return Exit::done;
}

std::vector<Option> options() {
  std::vector<Option> all{
      {"--state", "FILE", "keeps the zero over a power cycle; written when a zero is taken", 0, false},
      {"--off", "S", "how long it was off, for the lags of a kept state; default: by the time column", 0, false},
      {"--shadow", "", "tell what would be applied, apply nothing", 0, false},
      {"--watchdog", "S", "answer with missing readings when no line came for so long", 0, false}};
  for (Option& option : compensation_options()) all.push_back(std::move(option));
  return all;
}

}  // namespace

Command run_command() {
  return {"run",
          "compensate live: a line of temperatures in, a line with the offset out",
          "MODEL.json",
          details,
          options(),
          {{"thermfit run model.json --zero first --period 300 < data/vcenter55/K02.csv",
            "the answers to a recorded batch"},
           {"thermfit run model.json --shadow --zero first --period 300 --slew 0.1 < data/vcenter55/K02.csv",
            "what would have been left of the measured error"}},
          run_run};
}

}  // namespace thermfit::cli
