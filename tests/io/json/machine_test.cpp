#include "thermfit/io/json/machine.hpp"

#include <filesystem>

#include "support/catch.hpp"
#include "support/example_network.hpp"
#include "support/scratch_folder.hpp"
#include "support/shared_data.hpp"
#include "thermfit/effects/catalogue.hpp"

using namespace thermfit;

namespace {

const EffectLibrary library = standard_effects();

/// The example machine with every kind of key in it.
Json document() {
  ThermalNetwork network = test::example_network();
  network.sensors[1].offset_K = 0.1 + 0.2;
  network.initial = {ThermalNetwork::Initial::Rule::given, {{1, 1.0 / 3}}};
  network.effects = {{"coolant", "head+bed", "coolant", {{"conductance_W_per_K", 12.5}, {"temperature_degC", 18}}}};
  return machine_to_json(network);
}

/// What the reader says of the document after a change.
template <class Change>
std::string complaint(Change change) {
  Json changed = document();
  change(changed);
  try {
    machine_from_json(changed, "m.json", library);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

bool contains(const std::string& text, const std::string& part) {
  INFO(text);
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a machine written and read again is the same to the last bit", "[network][json]") {
  const ThermalNetwork once = machine_from_json(document(), "m.json", library);
  const std::string text = machine_to_json(once).dump(1);
  const ThermalNetwork twice = machine_from_json(parse_json(text, "m.json"), "m.json", library);
  CHECK(machine_to_json(twice).dump(1) == text);
  CHECK(twice.sensors[1].offset_K == 0.1 + 0.2);
  CHECK(twice.initial.degC[0].second == 1.0 / 3);
  CHECK(twice.effects[0].value("scale") == 1);  // completed with the prior's mean
}

TEST_CASE("a machine saved is the machine read, and nothing is left beside it", "[network][json]") {
  const ScratchFolder folder;
  const ThermalNetwork network = machine_from_json(document(), "m.json", library);
  save_machine(network, folder.path("m.json"));
  CHECK(machine_to_json(read_machine(folder.path("m.json"), library)) == machine_to_json(network));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path("")), {}) == 1);
  CHECK_THROWS_AS(save_machine(network, folder.path("nowhere/m.json")), Error);
}

TEST_CASE("all rules for ambient, start and displacement survive the round trip", "[network][json]") {
  Json changed = document();
  for (const Json& ambient :
       {Json("T9"), Json(21.5), Json("initial"), Json{{"first_sample_of", "T9"}}, Json{{"unmeasured", true}}})
    for (const Json& initial : {Json("ambient"), Json("measured"), Json("fitted"), Json(0.25)}) {
      changed["ambient"] = ambient;
      changed["initial"] = initial;
      const Json again = machine_to_json(machine_from_json(changed, "m.json", library));
      CHECK(again["ambient"] == ambient);
      CHECK(again["initial"] == initial);
    }
  Json second = changed["displacement"];
  second["output"] = "Y";
  second["zero"] = "reference";
  changed["displacement"] = Json::array({changed["displacement"], second});
  CHECK(machine_to_json(machine_from_json(changed, "m.json", library))["displacement"] == changed["displacement"]);
}

TEST_CASE("a machine tells how its batches are written, and whether its probe is absolute", "[network][json]") {
  Json told = document();
  const std::string z = machine_from_json(told, "m.json", library).displacements[0].output;
  told["channels"] = {{z, {{"unit", "0.1 um"}, {"sign", "correction"}}}, {"T1", {{"unit", "K"}}}};
  told["displacement"]["datum"] = "absolute";
  const ThermalNetwork network = machine_from_json(told, "m.json", library);
  REQUIRE(network.channels.size() == 2);
  CHECK(network.displacements[0].absolute);
  CHECK(machine_to_json(network)["channels"] == told["channels"]);
  CHECK(machine_to_json(network)["displacement"]["datum"] == "absolute");
  const auto channel = [&](const char* name, Json value) {
    return complaint([&](Json& machine) { machine["channels"] = {{name, std::move(value)}}; });
  };
  CHECK(contains(channel("T9x", {{"unit", "K"}}),
                 "m.json: channels: no thermometer and no displacement is called 'T9x'"));
  CHECK(contains(channel("T1", {{"unit", "mm"}}), "m.json: channels.T1.unit: 'mm' is no unit of it; allowed: "));
  CHECK(contains(channel("T1", {{"sign", "error"}}), "m.json: channels.T1"));
  CHECK(contains(channel(z.c_str(), {{"sign", "minus"}}), ".sign: "));
  CHECK(contains(channel(z.c_str(), {{"unit", "-um"}}), "is no unit of it"));
  CHECK(contains(complaint([](Json& machine) { machine["displacement"]["datum"] = "mine"; }),
                 "m.json: displacement.datum: "));
}

TEST_CASE("every mistake in a machine file is told with its key path", "[network][json]") {
  CHECK(complaint([](Json&) {}) == "accepted");
  const auto check = [](const std::string& part, auto change) { CHECK(contains(complaint(change), part)); };
  check("m.json: format: 'thermfit-machine/2'", [](Json& d) { d["format"] = "thermfit-machine/2"; });
  check("unknown key 'heatsources'", [](Json& d) { d["heatsources"] = 1; });
  check("did you mean heat_sources", [](Json& d) { d["heatsources"] = 1; });
  check("key 'nodes' is missing", [](Json& d) { d.erase("nodes"); });
  check("m.json: nodes: an empty list", [](Json& d) {
    d["nodes"] = Json::array();
    d["links"] = d["heat_sources"] = Json::array();
    d["displacement"]["um_per_K"] = d["sensors"] = d["initial"] = Json::object();
    d.erase("effects");
  });
  check("nodes[3].capacity_J_per_K: a negative number", [](Json& d) { d["nodes"][3]["capacity_J_per_K"] = -5; });
  check("nodes[3].capacity_J_per_K: zero", [](Json& d) { d["nodes"][3]["capacity_J_per_K"] = 0; });
  check("nodes[0].capacity_J_per_K: found \"warm\"", [](Json& d) { d["nodes"][0]["capacity_J_per_K"] = "warm"; });
  check("nodes[0].ambient_W_per_K: a negative", [](Json& d) { d["nodes"][0]["ambient_W_per_K"] = -0.1; });
  check("nodes[1].name: 'nose' is there twice", [](Json& d) {
    d["nodes"][1]["name"] = "nose";
    d["links"] = Json::array();
    d["heat_sources"] = Json::array();
    d["displacement"]["um_per_K"] = d["sensors"] = d["initial"] = Json::object();
  });
  check("nodes[0].name: 'ambient' is reserved", [](Json& d) {
    d["nodes"][0]["name"] = "ambient";
    d["links"] = Json::array();
    d["displacement"]["um_per_K"] = Json::object();
  });
  check("there is no node 'hed'", [](Json& d) { d["links"][1]["between"][1] = "hed"; });
  check("did you mean head", [](Json& d) { d["links"][1]["between"][1] = "hed"; });
  check("links[0].between: 'nose' linked to itself", [](Json& d) { d["links"][0]["between"][1] = "nose"; });
  check("links[1].between: 'bearing' and 'nose' are linked twice", [](Json& d) {
    d["links"][1]["between"] = Json::array({"bearing", "nose"});
  });
  check("links[0].conductance_W_per_K: a negative", [](Json& d) { d["links"][0]["conductance_W_per_K"] = -2; });
  check("links[0].between: 3 names", [](Json& d) { d["links"][0]["between"].push_back("bed"); });
  check("no way for heat to leave nose", [](Json& d) {
    d["links"].erase(0);
    d["nodes"][0]["ambient_W_per_K"] = 0;
  });
  check("heat_sources[0].into: shares that add to 1.1", [](Json& d) { d["heat_sources"][0]["into"]["head"] = 0.5; });
  check("heat_sources[0].into: there is no node 'spindle'",
        [](Json& d) { d["heat_sources"][0]["into"]["spindle"] = 0.5; });
  check("heat_sources[0].scale: zero", [](Json& d) { d["heat_sources"][0]["scale"] = 0; });
  check("heat_sources[1].name: 'bearing friction' is there twice",
        [](Json& d) { d["heat_sources"][1]["name"] = "bearing friction"; });
  check("displacement.zero: 'last'", [](Json& d) { d["displacement"]["zero"] = "last"; });
  check("displacement.um_per_K: there is no node 'tail'", [](Json& d) { d["displacement"]["um_per_K"]["tail"] = 1; });
  check("sensors.T1.node: there is no node 'noze'", [](Json& d) { d["sensors"]["T1"]["node"] = "noze"; });
  check("sensors.T1: unknown key 'nod'", [](Json& d) { d["sensors"]["T1"]["nod"] = "nose"; });
  check("neither sensors nor a displacement", [](Json& d) {
    d.erase("sensors");
    d.erase("displacement");
  });
  check("initial: there is no node 'bedd'", [](Json& d) { d["initial"] = Json{{"bedd", 20}}; });
  check("initial: 'cold'", [](Json& d) { d["initial"] = "cold"; });
  check("ambient: neither a text", [](Json& d) { d["ambient"] = true; });
  check("ambient.unmeasured: false", [](Json& d) { d["ambient"] = Json{{"unmeasured", false}}; });
  check("ambient: two rules for one room", [](Json& d) {
    d["ambient"] = Json{{"unmeasured", true}, {"first_sample_of", "T9"}};
  });
  check("ambient: unknown key 'unmesured'", [](Json& d) { d["ambient"] = Json{{"unmesured", true}}; });
  check("uncertainty: unknown key 'capacities'", [](Json& d) { d["uncertainty"]["capacities"] = 1; });
  check("uncertainty.power: a negative", [](Json& d) { d["uncertainty"]["power"] = -1; });
  check("effect: 'coolent' is not known", [](Json& d) { d["effects"][0]["effect"] = "coolent"; });
  check("there is no node 'neck'", [](Json& d) { d["effects"][0]["location"] = "head+neck"; });
  check("effects[0].watts: no such parameter of coolant", [](Json& d) { d["effects"][0]["watts"] = 3; });
  check("effects[0].scale: found \"big\"", [](Json& d) { d["effects"][0]["scale"] = "big"; });
}

TEST_CASE("the machines of the reference data are read and written without loss", "[network][json]") {
  REQUIRE_SHARED_DATA(data);
  for (const char* file :
       {"/withheld/case-01/machine.json", "/withheld/case-24/machine.json", "/real/tclab/machine.json"}) {
    const Json original = read_json(data + file);
    const Json again = machine_to_json(machine_from_json(original, file, library));
    for (const auto& [key, value] : original.items()) {
      INFO(file << ": " << key);
      CHECK(again[key] == value);
    }
  }
}
