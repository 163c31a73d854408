#include "cli/command.hpp"
#include "cli/table.hpp"
#include "commands/commands.hpp"
#include "report/model_text.hpp"
#include "thermfit/io/json/model.hpp"

namespace thermfit::cli {
namespace {

const char* const details =
    "Tells what a model file holds: equation, points, training data, domain, substitutes for lost sensors. "
    "With --diff, two model files: every field that differs, one a line, or nothing.\n"
    "\n"
    "A file that is cut, edited or foreign is refused: its digest covers every digit.\n"
    "--json prints the model document itself (thermfit-model/1), or with --diff a list of "
    "{\"field\", \"a\", \"b\"}.\n"
    "Exit codes: 0 done, and with --diff the models are equal; 1 they differ; 2 could not be done.";

/// Fields that differ, with their values, as {"field", "a", "b"}.
void compare(const Json& a, const Json& b, const std::string& path, Json& differences) {
  if (a == b) return;
  if (a.is_object() && b.is_object()) {
    const std::string prefix = path.empty() ? "" : path + '.';
    for (const auto& [key, value] : a.items())
      compare(value, b.contains(key) ? b[key] : Json(), prefix + key, differences);
    for (const auto& [key, value] : b.items())
      if (!a.contains(key)) compare(Json(), value, prefix + key, differences);
  } else if (a.is_array() && b.is_array() && a.size() == b.size()) {
    for (std::size_t i = 0; i < a.size(); ++i) compare(a[i], b[i], path + '[' + std::to_string(i) + ']', differences);
  } else {
    differences.push_back({{"field", path}, {"a", a}, {"b", b}});
  }
}

Exit print_differences(const std::string& first, const std::string& second, bool json, Console& console) {
  Json differences = Json::array();
  compare(model_to_json(load_model(first)), model_to_json(load_model(second)), "", differences);
  if (json) {
    console.line(differences.dump(1));
  } else if (!differences.empty()) {
    const auto shown = [](const Json& value) {
      const std::string text = value.dump();
      return text.size() <= 24 ? text : text.substr(0, 23) + "…";
    };
    Table table({"field", "a", "b"});
    for (const Json& difference : differences)
      table.add({difference["field"].get<std::string>(), shown(difference["a"]), shown(difference["b"])});
    console.print(table.text());
  }
  return differences.empty() ? Exit::done : Exit::negative;
}

Exit run_inspect(const Arguments& arguments, Console& console) {
  const auto& files = arguments.positionals();
  const bool diff = arguments.has("--diff"), json = arguments.has("--json");
  if (files.size() != (diff ? 2U : 1U))
    throw UsageError(std::string("inspect takes ") + (diff ? "two model files with --diff" : "one model file"));
  if (diff) return print_differences(files[0], files[1], json, console);
  const TrainedModel model = load_model(files[0]);
  if (json)
    console.line(model_to_json(model).dump(1));
  else
    print_model(model, console);
  return Exit::done;
}

}  // namespace

Command inspect_command() {
  return {"inspect",
          "tell what a model file holds, or how two differ",
          "MODEL.json [OTHER.json]",
          details,
          {{"--diff", "", "compare two model files; exit 1 when they differ", 0, false},
           {"--json", "", "print the document instead of words", 0, false}},
          {{"thermfit inspect model.json", "the model in words"},
           {"thermfit inspect --diff old.json new.json", "what changed between two fits"}},
          run_inspect};
}

}  // namespace thermfit::cli
