#include "thermfit/effects/place.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

/// a - b - c - d in a row.
ThermalNetwork row() {
  ThermalNetwork network;
  network.nodes = {{"a", 1, 1}, {"b", 1, 1}, {"c", 1, 1}, {"d", 1, 1}};
  network.links = {{0, 1, 1.0}, {2, 1, 1.0}, {2, 3, 1.0}};
  return network;
}

using Places = std::vector<std::string>;

}  // namespace

TEST_CASE("one step from a node is its neighbour, or both") { CHECK(places_beside(row(), "a") == Places{"b", "a+b"}); }

TEST_CASE("one step from a set of nodes takes in a neighbour or leaves out one of its own") {
  CHECK(places_beside(row(), "b+c") == Places{"a+b+c", "c", "b", "b+c+d"});
  CHECK(places_beside(row(), "all") == Places{"b+c+d", "a+c+d", "a+b+d", "a+b+c"});
}

TEST_CASE("one step from a pair moves one end to a neighbour, named as the network names the link") {
  CHECK(places_beside(row(), "a-c") == Places{"c-b", "a-b", "a-d"});
}

TEST_CASE("sources, sensors and outputs have no place beside them") {
  CHECK(places_beside(row(), "spindle friction").empty());
  CHECK(places_beside(row(), "displacement").empty());
}

TEST_CASE("all nodes together are called all") {
  CHECK(place_of(row(), {0, 1, 2, 3}) == "all");
  CHECK(place_of(row(), {1, 3}) == "b+d");
}
