#include "thermfit/io/json/node.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

std::string message(const std::string& text) {
  try {
    const Json json = parse_json(text, "m.json");
    const JsonNode node(json, "m.json");
    node.require_keys({"name", "nodes"});
    for (std::size_t i = 0; i < node.at("nodes").size(3); ++i) node.at("nodes").item(i).at("capacity").positive();
    node.at("name").choice({"spindle", "column"});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a correct document passes every check", "[io]") {
  CHECK(message(R"({"name": "spindle", "nodes": [{"capacity": 1.5}]})").empty());
}

TEST_CASE("a syntax error names line and column", "[io]") {
  CHECK(message("{\n  \"name\": oops }") == "m.json:2:11: not JSON here; allowed: JSON (RFC 8259); mend the syntax");
  CHECK(message("{\"name\": ") ==
        "m.json:1:10: the document ends too early; allowed: complete JSON; is the file cut off?");
}

TEST_CASE("an unknown key is refused with the nearest one that exists", "[io]") {
  CHECK(message(R"({"nmae": 1})") ==
        "m.json: unknown key 'nmae'; allowed: name, nodes; remove or rename it; did you mean name?");
}

TEST_CASE("a wrong value is refused with its key path", "[io]") {
  CHECK(message(R"({"name": "spindle", "nodes": [{"capacity": 1}, {"capacity": -2}]})") ==
        "m.json: nodes[1].capacity: value -2; allowed: a number above 0");
  CHECK(message(R"({"nodes": [{"capacity": "1"}]})") == "m.json: nodes[0].capacity: found \"1\"; allowed: a number");
  CHECK(message(R"({"nodes": [{}]})") == "m.json: nodes[0]: key 'capacity' is missing");
  CHECK(message(R"({"nodes": [1,2,3,4]})") == "m.json: nodes: a list of 4 entries; allowed: at most 3");
  CHECK(message(R"({"nodes": [], "name": "spindel"})") ==
        "m.json: name: 'spindel'; allowed: spindle, column; change it; did you mean spindle?");
}

TEST_CASE("a key given twice, deep nesting and numbers beyond a double are refused", "[io]") {
  CHECK(message(R"({"name": "spindle", "name": "column"})") ==
        "m.json: key 'name' is given twice in one object; remove one");
  CHECK(message(std::string(100, '[')).find("deeper than 64") != std::string::npos);
  CHECK(message(R"({"nodes": [{"capacity": 1e999}]})").find("m.json") == 0);
  CHECK(message("{\"name\": \"\xff\"}").find("m.json:1:") == 0);
}

TEST_CASE("a document of another format or major version is named as such", "[io]") {
  const Json json{{"format", "thermfit-model/2"}};
  CHECK_THROWS_WITH(JsonNode(json, "m.json").require_format("thermfit-model", 1),
                    "m.json: format: 'thermfit-model/2'; allowed: 'thermfit-model/1'; it was written by another "
                    "version of thermfit");
}
