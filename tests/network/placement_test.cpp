#include "support/catch.hpp"
#include "thermfit/network/parameters.hpp"
#include "thermfit/network/simulate.hpp"

using namespace thermfit;

namespace {

ThermalNetwork bar() {
  ThermalNetwork network;
  network.nodes = {{"left", 500, 0.5}, {"middle", 600, 0.2}, {"right", 700, 0.8}};
  network.links = {{0, 1, 2.0}, {1, 2, 1.5}};
  ThermalNetwork::HeatSource source;
  source.name = "heater";
  source.input = "constant";
  source.power_W = 20;
  source.into = {{0, 1.0}};
  network.heat_sources = {source};
  ThermalNetwork::Sensor sensor;
  sensor.column = "T1";
  sensor.node = 1;
  network.sensors = {sensor};
  network.ambient.rule = ThermalNetwork::Ambient::Rule::constant;
  network.ambient.value_degC = 20;
  return network;
}

Excitation one_hour(const ThermalNetwork& network) {
  Batch batch;
  batch.name = "K01";
  batch.time_s = Vector::LinSpaced(61, 0, 3600);
  batch.temperatures.names = {"T1"};
  batch.temperatures.values = Matrix::Constant(61, 1, 20.0);
  return excitation_of(network, batch);
}

}  // namespace

TEST_CASE("a placed sensor reads its share of the way to a neighbour") {
  ThermalNetwork network = with_placements(bar());
  REQUIRE(network.sensors[0].placement.size() == 2);
  network.sensors[0].placement = {{0, 0.3}, {2, -0.2}};
  network.sensors[0].offset_K = 0.1;
  const EffectLibrary none;
  const Simulation run = simulate(network, {one_hour(network)}, none)[0];
  const Matrix& node = run.nodes_degC;
  const Vector expected =
      (node.col(1) + 0.3 * (node.col(0) - node.col(1)) - 0.2 * (node.col(2) - node.col(1))).array() + 0.1;
  CHECK((run.channels.col(0) - expected).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("sensitivities pass through the placement and reach its shares") {
  ThermalNetwork network = with_placements(bar());
  network.sensors[0].placement = {{0, 0.3}, {2, -0.2}};
  const EffectLibrary none;
  const std::vector<Parameter> parameters = calibration_parameters(network, none);
  const std::vector<Excitation> drive{one_hour(network)};
  const Simulation run = simulate(network, drive, none, parameters)[0];
  const Vector values = values_of(network, parameters);
  Index shares = 0;
  for (Index j = 0; j < values.size(); ++j) {
    const double step = 1e-5 * std::max(1.0, std::abs(values(j)));
    Vector above = values, below = values;
    above(j) += step;
    below(j) -= step;
    const Vector difference = (simulate(with_values(network, parameters, above), drive, none)[0].channels.col(0) -
                               simulate(with_values(network, parameters, below), drive, none)[0].channels.col(0)) /
                              (2 * step);
    INFO(parameters[static_cast<std::size_t>(j)].name);
    CHECK((run.jacobian.col(j) - difference).cwiseAbs().maxCoeff() <
          1e-6 * std::max(1.0, difference.cwiseAbs().maxCoeff()));
    shares += parameters[static_cast<std::size_t>(j)].kind == Parameter::Kind::placement ? 1 : 0;
  }
  CHECK(shares == 2);
}

TEST_CASE("without placements nothing but the offset of a sensor can be calibrated") {
  for (const Parameter& one : calibration_parameters(bar(), EffectLibrary{}))
    CHECK(one.kind != Parameter::Kind::placement);
}

TEST_CASE("a late reading lacks its response times the rate at which its node was changing") {
  ThermalNetwork network = bar();
  const EffectLibrary none;
  const Simulation prompt = simulate(network, {one_hour(network)}, none)[0];
  network.sensors[0].response_s = 40;
  const Simulation late = simulate(network, {one_hour(network)}, none)[0];
  CHECK(late.channels(0, 0) == prompt.channels(0, 0));  // at rest before the first sample
  for (Index k = 1; k < 61; ++k) {
    const auto degC = prompt.nodes_degC.row(k);
    const double rate = (2.0 * (degC(0) - degC(1)) + 1.5 * (degC(2) - degC(1)) + 0.2 * (20 - degC(1))) /
                        network.nodes[1].capacity_J_per_K;
    CHECK(late.channels(k, 0) == Approx(prompt.channels(k, 0) - 40 * rate).epsilon(1e-12));
  }
}

TEST_CASE("the response of a reading may move by a share of its node's time constant") {
  const ThermalNetwork network = bar();
  CHECK(network.time_constant_s(1) == Approx(600 / 3.7));
  const EffectLibrary none;
  const std::vector<Parameter> parameters = calibration_parameters(network, none);
  CHECK(parameters.back().kind == Parameter::Kind::response);
  CHECK(parameters.back().sd == Approx(0.05 * 600 / 3.7));
  ThermalNetwork insulated = network;
  insulated.links.clear();
  insulated.nodes[1].ambient_W_per_K = 0;
  CHECK(insulated.time_constant_s(1) == 0);
}
