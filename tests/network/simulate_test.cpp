#include "thermfit/network/simulate.hpp"

#include "support/catch.hpp"
#include "support/example_network.hpp"

using namespace thermfit;
using test::example_batch;
using test::example_network;

namespace {

const EffectLibrary no_effects;

/// One lump that starts at ambient, with a constant source.
ThermalNetwork one_lump() {
  ThermalNetwork network;
  network.ambient = {ThermalNetwork::Ambient::Rule::constant, "", 20};
  network.nodes = {{"lump", 500, 2}};
  network.heat_sources = {{"heater", "constant", 1, 1, 10, {{0, 1.0}}}};
  network.displacements = {{"Z", false, {{0, 3.0}}}};
  network.sensors = {{"T1", 0}};
  return network;
}

Batch clock_only(std::initializer_list<double> times) {
  Batch batch;
  batch.name = "clock";
  batch.time_s.resize(static_cast<Index>(times.size()));
  std::copy(times.begin(), times.end(), batch.time_s.data());
  return batch;
}

double relative_difference(const Matrix& a, const Matrix& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(1e-300, b.cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("one lump under constant heat follows the exponential at any sampling", "[network]") {
  const ThermalNetwork network = one_lump();
  const Batch batch = clock_only({0, 1, 7.5, 100, 101, 5000});
  const Simulation result = simulate(network, {excitation_of(network, batch)}, no_effects).front();
  for (Index k = 0; k < batch.time_s.size(); ++k) {
    const double rise = 10.0 / 2 * (1 - std::exp(-batch.time_s(k) * 2 / 500));
    CHECK(result.channels(k, 0) == Approx(20 + rise).epsilon(1e-13));
    CHECK(result.channels(k, 1) == Approx(3 * rise).margin(1e-11));
  }
}

TEST_CASE("a lump in a room that warms steadily lags by its time constant", "[network]") {
  ThermalNetwork network = one_lump();
  network.heat_sources.clear();
  network.ambient = {ThermalNetwork::Ambient::Rule::column, "room", 0};
  Batch batch = clock_only({0, 300, 700, 5000});
  batch.inputs.names = {"room"};
  batch.inputs.values = (20 + 0.01 * batch.time_s.array()).matrix();
  const Simulation result = simulate(network, {excitation_of(network, batch)}, no_effects).front();
  const double tau = 250;
  for (Index k = 0; k < 4; ++k) {
    const double t = batch.time_s(k);
    CHECK(result.channels(k, 0) == Approx(20 + 0.01 * (t - tau * (1 - std::exp(-t / tau)))).epsilon(1e-13));
  }
}

TEST_CASE("two lumps exchange heat with the two known time constants", "[network]") {
  ThermalNetwork network = one_lump();
  network.heat_sources.clear();
  network.nodes = {{"a", 100, 1}, {"b", 100, 1}};
  network.links = {{0, 1, 3}};
  network.initial = {ThermalNetwork::Initial::Rule::given, {{0, 40.0}, {1, 30.0}}};
  const Batch batch = clock_only({0, 5, 11, 50});
  const Simulation result = simulate(network, {excitation_of(network, batch)}, no_effects).front();
  for (Index k = 0; k < 4; ++k) {
    const double t = batch.time_s(k);
    const double mean = 15 * std::exp(-t * 1 / 100), half = 5 * std::exp(-t * 7 / 100);
    CHECK(result.nodes_degC(k, 0) == Approx(20 + mean + half).epsilon(1e-13));
    CHECK(result.nodes_degC(k, 1) == Approx(20 + mean - half).epsilon(1e-13));
  }
}

TEST_CASE("at steady state the heat that enters leaves to ambient", "[network]") {
  ThermalNetwork network = example_network();
  network.ambient = {ThermalNetwork::Ambient::Rule::constant, "", 20};
  Batch batch = clock_only({0, 1e7, 2e7});
  batch.inputs.names = {"spindle_rpm"};
  batch.inputs.values = Vector::Constant(3, 6000);
  const Simulation result = simulate(network, {excitation_of(network, batch)}, no_effects).front();
  double out_W = 0;
  for (Index i = 0; i < 5; ++i)
    out_W += network.nodes[static_cast<std::size_t>(i)].ambient_W_per_K * (result.nodes_degC(2, i) - 20);
  CHECK(out_W == Approx(150 * std::pow(1.5, 1.2) + 80 * 1.5).epsilon(1e-10));
}

TEST_CASE("stored heat is the heat brought in minus the heat lost", "[network]") {
  ThermalNetwork network = example_network();
  for (auto& node : network.nodes) node.ambient_W_per_K = 0;  // simulate() itself does not ask for a way out
  Batch batch = example_batch();
  const Simulation result = simulate(network, {excitation_of(network, batch)}, no_effects).front();
  double brought_J = 0;
  for (Index k = 0; k + 1 < batch.rows(); ++k) {
    const double u = batch.inputs.values(k, 0) / 4000;
    brought_J += (150 * std::pow(u, 1.2) + 80 * u) * (batch.time_s(k + 1) - batch.time_s(k));
  }
  double stored_J = 0;
  for (Index i = 0; i < 5; ++i)
    stored_J += network.nodes[static_cast<std::size_t>(i)].capacity_J_per_K *
                (result.nodes_degC(batch.rows() - 1, i) - result.nodes_degC(0, i));
  CHECK(stored_J == Approx(brought_J).epsilon(1e-10));
}

TEST_CASE("twice as many samples under the same inputs give the same temperatures", "[network]") {
  const ThermalNetwork network = example_network();
  const Batch coarse = example_batch();
  Batch fine = coarse;
  const Index rows = coarse.rows();
  fine.time_s.resize(2 * rows - 1);
  fine.inputs.values.resize(2 * rows - 1, 3);
  fine.temperatures.values.resize(2 * rows - 1, 5);
  for (Index k = 0; k < 2 * rows - 1; ++k) {
    const Index a = k / 2, b = (k + 1) / 2;
    fine.time_s(k) = (coarse.time_s(a) + coarse.time_s(b)) / 2;
    fine.inputs.values.row(k) = coarse.inputs.values.row(a);
    fine.temperatures.values.row(k) = (coarse.temperatures.values.row(a) + coarse.temperatures.values.row(b)) / 2;
  }
  const Matrix one = simulate(network, {excitation_of(network, coarse)}, no_effects).front().channels;
  const Matrix two = simulate(network, {excitation_of(network, fine)}, no_effects).front().channels;
  for (Index k = 0; k < rows; ++k) CHECK((one.row(k) - two.row(2 * k)).cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("the share of the first readings in the start leads from ambient to measured", "[network]") {
  ThermalNetwork network = example_network();
  for (ThermalNetwork::Sensor& sensor : network.sensors) sensor.offset_K = 0;
  Batch batch = example_batch();
  for (Index column = 0; column < batch.temperatures.count(); ++column)
    batch.temperatures.values(0, column) += static_cast<double>(column);
  const auto start = [&] {
    return Vector(simulate(network, {excitation_of(network, batch)}, no_effects).front().nodes_degC.row(0));
  };
  const Vector ambient = start();
  network.initial.share = 1;
  const Vector all = start();
  network.initial.share = 0.25;
  CHECK((start() - (ambient + 0.25 * (all - ambient))).cwiseAbs().maxCoeff() < 1e-12);
  network.initial = {ThermalNetwork::Initial::Rule::measured, {}, 0};
  CHECK((start() - all).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((all - ambient).cwiseAbs().maxCoeff() > 0.5);
}

TEST_CASE("sensitivities of every parameter agree with central differences", "[network]") {
  ThermalNetwork network = example_network();
  const int start = GENERATE(0, 1, 2);
  if (start == 1) network.initial.rule = ThermalNetwork::Initial::Rule::measured;
  if (start == 2) {
    network.initial.share = 0.4;
    network.uncertainty.start_share = 1;
  }
  const std::vector<Excitation> drive = excitations_of(network, {example_batch(0), example_batch(1)});
  const std::vector<Parameter> parameters = calibration_parameters(network, no_effects);
  REQUIRE(parameters.size() == 5 + 5 + 4 + 2 + 4 + 4 + 4 + (start == 2 ? 1 : 0));
  const std::vector<Simulation> exact = simulate(network, drive, no_effects, parameters);
  const Vector values = values_of(network, parameters);
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const Index column = static_cast<Index>(j);
    const double step = 1e-5 * (parameters[j].logarithmic ? values(column) : 1.0);
    Vector above = values, below = values;
    above(column) += step;
    below(column) -= step;
    const auto up = simulate(with_values(network, parameters, above), drive, no_effects);
    const auto down = simulate(with_values(network, parameters, below), drive, no_effects);
    for (std::size_t b = 0; b < drive.size(); ++b) {
      const Matrix difference = (up[b].channels - down[b].channels) / (2 * step);
      const Vector tangent = exact[b].jacobian.col(column);
      INFO(parameters[j].name << " in batch " << b);
      CHECK(relative_difference(Eigen::Map<const Matrix>(tangent.data(), difference.rows(), difference.cols()),
                                difference) < 1e-6);
    }
  }
}

TEST_CASE("asking for sensitivities does not change the simulation", "[network]") {
  const ThermalNetwork network = example_network();
  const std::vector<Excitation> drive = excitations_of(network, {example_batch()});
  const auto parameters = calibration_parameters(network, no_effects);
  CHECK(simulate(network, drive, no_effects, parameters)[0].channels ==
        simulate(network, drive, no_effects)[0].channels);
}
