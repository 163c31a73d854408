#include "export/export.hpp"

#include "cli/command.hpp"
#include "commands/commands.hpp"
#include "export/reserved_words.hpp"
#include "export/source_text.hpp"
#include "options/compensation_options.hpp"
#include "options/error_reference.hpp"
#include "options/output.hpp"
#include "thermfit/io/json/model.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    "Writes a model as source for what runs in a machine. Unit and sign of the offset stand in every target.\n"
    "\n"
    "  c         C99 header: initialise, start, step, test vectors and a self-test; no heap\n"
    "  cpp       C++17 header: constexpr model and settings for thermfit/controller\n"
    "  st        IEC 61131-3 Structured Text: a function block and a second one that tests it\n"
    "  linuxcnc  HAL component (.comp) for external offsets: halcompile --install FILE\n"
    "  onnx      the bare model without guard; input: one row a sample, as the model sees temperatures\n"
    "  card      how to enter the compensation at a control: --control NAME\n"
    "\n"
    "c, cpp, st and linuxcnc hold the whole compensator: sensor checks, hold, substitute for a lost sensor, training "
    "domain, clamp, slew limit, status word. Of a model of the method transfer also its lags, the climate of the "
    "session, and both over a power cycle, if it is told how long that was; onnx and card have no memory and take "
    "none. "
    "--probe adds what a probe measures now and then.\n"
    "Exit codes: 0 done; 2 could not be done.";

struct Target {
  const char* name;
  ControllerSource (*write)(const ExportRequest&);
};
const Target targets[] = {{"c", export_c},       {"cpp", export_cpp},  {"st", export_st}, {"linuxcnc", export_linuxcnc},
                          {"onnx", export_onnx}, {"card", export_card}};

std::string default_unit(const std::string& target, const std::string& control) {
  if (target == "linuxcnc") return "mm";
  return target == "card" ? card_unit(control) : "um";
}

Exit run_export(const Arguments& arguments, Console& console) {
  if (arguments.positionals().size() != 1) throw UsageError("export takes one model file");
  std::vector<std::string> names;
  for (const Target& target : targets) names.push_back(target.name);
  const std::string target = arguments.choice("--target", names, "");
  if (target.empty()) throw UsageError("--target is missing; one of c, cpp, st, linuxcnc, onnx, card");

  ExportRequest request;
  request.control = arguments.choice("--control", card_controls(), "");
  if (target == "card" && request.control.empty())
    throw UsageError("--target card needs --control; one of sinumerik, twincat, heidenhain, fanuc");
  if (target != "card" && !request.control.empty()) throw UsageError("--control belongs to --target card");
  request.source = arguments.positionals()[0];
  request.trained = load_model(request.source);
  require_no_inputs(request.trained, request.source);
  request.source = request.source.substr(request.source.rfind('/') + 1);
  request.name = arguments.value_or("--name", "thermal");
  if (identifiers({request.name})[0] != request.name || upper_case(request.name) == request.name)
    throw UsageError("--name is '" + request.name +
                     "'; allowed: up to 20 letters, digits and single underscores, "
                     "a letter first, one of them small");
  if (const std::string languages = reserved_in(request.name); !languages.empty())
    throw UsageError("--name is '" + request.name + "', a word of " + languages + "; try " +
                     identifiers({"thermal_" + request.name})[0]);
  request.wishes = compensation_wishes(arguments);
  request.wishes.probe = arguments.has("--probe");
  if (request.control == "fanuc" && !arguments.has("--sign")) request.wishes.sign = OutputSign::error;
  request.single_precision = arguments.choice("--scalar", {"float", "double"}, "double") == "float";
  request.unit = offset_unit(arguments.choice("--unit", {"um", "mm", "0.1um"}, default_unit(target, request.control)));
  for (const Target& known : targets)
    if (known.name == target) console.print(known.write(request));
  note_probe_levels(request.trained, console);
  if (const auto path = output_path(arguments)) console.write_to(*path);
  return Exit::done;
}

std::vector<Option> options() {
  std::vector<Option> all{{"--target", "TARGET", "c, cpp, st, linuxcnc, onnx, card", 0, false},
                          {"--control", "NAME", "for a card: sinumerik, twincat, heidenhain, fanuc", 0, false},
                          {"--output", "FILE", "write there instead of stdout", 'o', false},
                          {"--name", "NAME", "prefix of all that is exported; default thermal", 0, false},
                          {"--scalar", "TYPE", "float or double (default)", 0, false},
                          {"--probe", "", "with a function, pins or inputs for a probe's measured errors", 0, false},
                          {"--unit", "UNIT",
                           "of the offset: um, mm, 0.1um; default um, mm for linuxcnc, the control's "
                           "own for a card",
                           0, false}};
  for (Option& option : compensation_options()) all.push_back(std::move(option));
  return all;
}

}  // namespace

Command export_command() {
  return {"export",
          "write a model as source for a controller, or as a card for a control",
          "MODEL.json",
          details,
          options(),
          {{"thermfit export model.json --target c --scalar float -o thermal.h", "a C99 header with a self-test"},
           {"thermfit export model.json --target card --control sinumerik", "what to enter at a SINUMERIK"}},
          run_export};
}

}  // namespace thermfit::cli
