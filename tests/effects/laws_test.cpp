#include <cmath>

#include "support/catch.hpp"
#include "support/example_network.hpp"
#include "thermfit/effects/catalogue.hpp"
#include "thermfit/network/simulate.hpp"

using namespace thermfit;
using test::example_batch;
using test::example_network;

namespace {

const EffectLibrary library = standard_effects();

/// One lump of 1000 J/K and 2 W/K in a room at 20 degC, starting at 20 degC, read by T1, expanding 3 um/K.
ThermalNetwork lump(ThermalNetwork::AddedEffect added) {
  ThermalNetwork network;
  network.ambient = {ThermalNetwork::Ambient::Rule::constant, "", 20};
  network.nodes = {{"lump", 1000, 2}};
  network.displacements = {{"Z", true, {{0, 3.0}}}};
  network.sensors.resize(1);
  network.sensors[0].column = "T1";
  network.effects = {std::move(added)};
  return network;
}

/// 13 samples, 5 min apart, with a speed of 6000 and coolant on throughout.
Batch hour() {
  Batch batch;
  batch.name = "hour";
  batch.time_s = Vector::LinSpaced(13, 0, 3600);
  batch.inputs.names = {"n", "c"};
  batch.inputs.values = Vector::Ones(13) * Eigen::RowVector2d(6000, 1);
  return batch;
}

Matrix run(const ThermalNetwork& network, const Batch& batch = hour()) {
  return simulate(network, {excitation_of(network, batch)}, library)[0].channels;
}

ThermalNetwork hot(ThermalNetwork network, double degC) {
  network.initial = {ThermalNetwork::Initial::Rule::given, {}};
  for (Index i = 0; i < network.node_count(); ++i) network.initial.degC.emplace_back(i, degC);
  return network;
}

/// The same simulation with every step cut into `parts`, the inputs held.
Batch refined(const Batch& coarse, Index parts) {
  Batch fine = coarse;
  const Index rows = parts * (coarse.rows() - 1) + 1;
  fine.time_s.resize(rows);
  fine.inputs.values.resize(rows, coarse.inputs.values.cols());
  fine.temperatures.values.resize(rows, coarse.temperatures.values.cols());
  for (Index k = 0; k < rows; ++k) {
    const Index a = k / parts, b = std::min(a + 1, coarse.rows() - 1);
    const double f = static_cast<double>(k % parts) / static_cast<double>(parts);
    fine.time_s(k) = (1 - f) * coarse.time_s(a) + f * coarse.time_s(b);
    fine.inputs.values.row(k) = coarse.inputs.values.row(a);
    for (Index c = 0; c < coarse.temperatures.values.cols(); ++c)
      fine.temperatures.values(k, c) =
          (1 - f) * coarse.temperatures.values(a, c) + f * coarse.temperatures.values(b, c);
  }
  return fine;
}

}  // namespace

TEST_CASE("held heat and conductances are exact: heat source, friction law, coolant, forced convection", "[effects]") {
  const auto after = [](double heat_W, double W_per_K, double rest_degC) {
    return rest_degC + heat_W / W_per_K + (20 - rest_degC - heat_W / W_per_K) * std::exp(-3600 * W_per_K / 1000);
  };
  CHECK(run(lump({"heat-source", "lump", "n", {{"power_W", 8}, {"scale", 4000}}}))(12, 0) ==
        Approx(after(12, 2, 20)).epsilon(1e-12));
  CHECK(run(lump({"heat-source", "lump", "constant", {{"power_W", 8}}}))(12, 0) ==
        Approx(after(8, 2, 20)).epsilon(1e-12));
  CHECK(run(lump({"coolant", "lump", "c", {{"conductance_W_per_K", 3}, {"temperature_degC", 10}}}))(12, 0) ==
        Approx(after(0, 5, 14)).epsilon(1e-12));
  ThermalNetwork sourced = lump({"friction-law", "drive", "", {{"power_W", 4}, {"exponent", 2}}});
  sourced.heat_sources = {{"drive", "n", 3000, 1, 5, {{0, 1.0}}}};
  CHECK(run(sourced)(12, 0) == Approx(after(5 * 2 + 4 * 4, 2, 20)).epsilon(1e-12));
  ThermalNetwork blown = hot(lump({"forced-convection", "lump", "n", {{"k", 0.5}, {"scale", 3000}}}), 50);
  CHECK(run(blown)(12, 0) ==
        Approx(20 + 30 * std::exp(-3600 * 2 * (1 + 0.5 * std::pow(2, 0.8)) / 1000)).epsilon(1e-12));
}

TEST_CASE("natural convection of exponent one follows its closed form", "[effects]") {
  // y' = -a y (1 + k y / 10): y = y0 e / (1 + k y0 (1 - e) / 10), e = exp(-a t).
  const double k = 0.8, a = 2.0 / 1000, y0 = 25;
  const Matrix result = run(hot(lump({"natural-convection", "lump", "", {{"k", k}, {"exponent", 1}}}), 20 + y0));
  for (Index i = 0; i < 13; ++i) {
    const double e = std::exp(-a * 300 * static_cast<double>(i));
    CHECK(result(i, 0) - 20 == Approx(y0 * e / (1 + k * y0 * (1 - e) / 10)).margin(0.01));
  }
}

TEST_CASE("state-dependent laws agree with tiny steps far within the noise of a thermometer", "[effects]") {
  const auto added =
      GENERATE(ThermalNetwork::AddedEffect{"natural-convection", "all", "", {{"k", 1.5}, {"exponent", 0.33}}},
               ThermalNetwork::AddedEffect{"radiation", "all", "", {{"share", 1}}},
               ThermalNetwork::AddedEffect{"joint-conductance", "head-bed", "", {{"k", 0.3}}},
               ThermalNetwork::AddedEffect{"joint-conductance", "bearing-head", "", {{"k", 0.3}}});
  ThermalNetwork network = example_network();
  const Matrix plain = run(network, example_batch());
  network.effects = {added};
  const Matrix coarse = run(network, example_batch());
  const Matrix fine = run(network, refined(example_batch(), 100));
  double worst_K = 0, size_K = 0;
  for (Index k = 0; k < coarse.rows(); ++k) {
    worst_K = std::max(worst_K, (coarse.row(k) - fine.row(100 * k)).head(5).cwiseAbs().maxCoeff());
    size_K = std::max(size_K, (coarse.row(k) - plain.row(k)).head(5).cwiseAbs().maxCoeff());
  }
  INFO(added.effect << " at " << added.location << ": error " << worst_K << " K of an effect of " << size_K << " K");
  CHECK(size_K > 0.3);
  CHECK(worst_K < 0.003);
}

TEST_CASE("the state-dependent integrator is of second order", "[effects]") {
  ThermalNetwork network = example_network();
  network.effects = {{"natural-convection", "all", "", {{"k", 4}, {"exponent", 1}}}};
  const Batch batch = example_batch();
  const Matrix reference = run(network, refined(batch, 512));
  const auto error = [&](Index parts) {
    const Matrix result = run(network, refined(batch, parts));
    double worst = 0;
    for (Index k = 0; k < batch.rows(); ++k)
      worst = std::max(worst, (result.row(parts * k) - reference.row(512 * k)).head(5).cwiseAbs().maxCoeff());
    return worst;
  };
  // Fine enough that each step is one substep, so that halving the step shows the order.
  const double ratio = error(32) / error(64);
  CHECK(ratio > 3.3);
  CHECK(ratio < 5);
}

TEST_CASE("radiation adds its share of the ambient conductance at 20 degC", "[effects]") {
  const Matrix radiating = run(hot(lump({"radiation", "lump", "", {{"share", 0.5}}}), 20.1));
  CHECK(radiating(12, 0) - 20 == Approx(0.1 * std::exp(-3600 * 3.0 / 1000)).epsilon(1e-3));
}

TEST_CASE("a sensor lag is the exact first-order response, and does not disturb its node", "[effects]") {
  ThermalNetwork network = hot(lump({"sensor-lag", "T1", "", {{"lag_s", 200}}}), 40);
  const Simulation result = simulate(network, {excitation_of(network, hour())}, library)[0];
  const double a = 2.0 / 1000, b = 1.0 / 200;
  for (Index i = 0; i < 13; ++i) {
    const double t = 300 * static_cast<double>(i), body = std::exp(-a * t);
    CHECK(result.nodes_degC(i, 0) == Approx(20 + 20 * body).epsilon(1e-6));
    CHECK(result.channels(i, 0) == Approx(20 + 20 * (b * body - a * std::exp(-b * t)) / (b - a)).epsilon(1e-6));
  }
}

TEST_CASE("offset, gain and drift act on the reading alone", "[effects]") {
  const Matrix plain = run(hot(lump({"sensor-offset", "T1", "", {{"offset_K", 0}}}), 40));
  CHECK(run(hot(lump({"sensor-offset", "T1", "", {{"offset_K", 1.5}}}), 40))(5, 0) == Approx(plain(5, 0) + 1.5));
  CHECK(run(hot(lump({"sensor-gain", "T1", "", {{"gain", 1.1}}}), 40))(5, 0) == Approx(20 + 1.1 * (plain(5, 0) - 20)));
  CHECK(run(hot(lump({"sensor-drift", "T1", "", {{"rate_K_per_h", 0.6}}}), 40))(5, 0) ==
        Approx(plain(5, 0) + 0.6 * 25 / 60));
  CHECK(run(hot(lump({"sensor-gain", "T1", "", {{"gain", 1.1}}}), 40)).col(1) == plain.col(1));
}

TEST_CASE("a displacement logged late shows where the machine was, exactly, between samples too", "[effects]") {
  const ThermalNetwork network = hot(lump({"clock-offset", "displacement", "", {{"late_s", 100}}}), 40);
  const Matrix result = run(network);
  const Matrix refined_plain =
      run(hot(lump({"sensor-offset", "T1", "", {{"offset_K", 0}}}), 40), refined(hour(), 3));  // 100 s apart
  CHECK(result(0, 1) == 0);
  for (Index k = 1; k < 13; ++k) CHECK(result(k, 1) == Approx(refined_plain(3 * k - 1, 1)).epsilon(1e-10));
  for (Index k = 0; k < 13; ++k) CHECK(result(k, 0) == Approx(refined_plain(3 * k, 0)).epsilon(1e-10));
}

TEST_CASE("play keeps the displacement until it is pushed by its half-width", "[effects]") {
  ThermalNetwork network = lump({"hysteresis", "displacement", "", {{"half_width_um", 2}}});
  network.heat_sources = {{"heater", "h", 1, 1, 40, {{0, 1.0}}}};
  Batch batch = hour();
  batch.inputs.names = {"h", "c"};
  for (Index k = 0; k < 13; ++k) batch.inputs.values(k, 0) = k < 6 ? 1 : 0;
  network.effects.push_back({"sensor-offset", "T1", "", {{"offset_K", 0}}});
  const Matrix result = run(network, batch);
  double w = 0;
  for (Index k = 0; k < 13; ++k) {
    const double z = 3 * (result(k, 0) - 20);
    w = std::min(std::max(w, z - 2), z + 2);
    CHECK(result(k, 1) == Approx(w).margin(1e-9));
  }
}

TEST_CASE("displacement laws: missing and nonlinear expansion, speed shift, probe drift", "[effects]") {
  ThermalNetwork network = hot(lump({"nonlinear-expansion", "lump", "", {{"um_per_K2", 0.2}}}), 40);
  const auto rise = [](double t) { return 20 * std::exp(-2 * t / 1000); };
  CHECK(run(network)(12, 1) == Approx(3 * (rise(3600) - 20) + 0.2 * (rise(3600) * rise(3600) - 400)).epsilon(1e-12));
  network.displacements[0].um_per_K.clear();
  network.effects = {{"missing-expansion", "lump", "", {{"um_per_K", 7}}}};
  CHECK(run(network)(12, 1) == Approx(7 * (rise(3600) - 20)).epsilon(1e-12));
  Batch batch = hour();
  batch.inputs.values.block(0, 0, 4, 1).setZero();
  network = lump({"speed-shift", "displacement", "n", {{"shift_um", 4}, {"scale", 3000}}});
  CHECK(run(network, batch)(3, 1) == 0);
  CHECK(run(network, batch)(4, 1) == Approx(16));
  CHECK(run(lump({"probe-drift", "displacement", "time", {{"rate_um_per_h", 1.2}}}))(12, 1) == Approx(1.2));
}

namespace {

/// The lump in a room that warms by `K_per_h` from 20 degC, as the column Troom shows.
ThermalNetwork lump_in_measured_room(ThermalNetwork::AddedEffect added) {
  ThermalNetwork network = lump(std::move(added));
  network.ambient = {ThermalNetwork::Ambient::Rule::column, "Troom", 20};
  network.sensors.resize(2);
  network.sensors[1].column = "Troom";
  network.sensors[1].node = ThermalNetwork::ambient_node;
  return network;
}

Batch warming(double K_per_h) {
  Batch batch = hour();
  batch.temperatures.names = {"Troom"};
  batch.temperatures.values = 20 + batch.time_s.array() * (K_per_h / 3600);
  return batch;
}

}  // namespace

TEST_CASE("a probe drifts with the room as its fixture feels it: the exact lagged ramp", "[effects]") {
  const double lag_s = GENERATE(0., 600.);
  const ThermalNetwork network =
      lump_in_measured_room({"probe-drift", "displacement", "ambient", {{"um_per_K", 2}, {"lag_s", lag_s}}});
  ThermalNetwork still = network;
  still.effects.clear();
  const Vector drift = (run(network, warming(6)) - run(still, warming(6))).rightCols(1);
  for (Index i = 0; i < 13; ++i) {
    const double t = 300 * static_cast<double>(i), lag = 1 + lag_s;
    CHECK(drift(i) == Approx(2 * 6. / 3600 * (t - lag * (1 - std::exp(-t / lag)))).margin(1e-9));
  }
}

TEST_CASE("walls that never follow the room hold a radiating part where it started", "[effects]") {
  ThermalNetwork network = lump_in_measured_room({"radiation", "lump", "", {{"share", 1e4}, {"lag_s", 1e9}}});
  network.nodes[0].capacity_J_per_K = 1e5;
  CHECK(run(network, warming(6))(12, 0) == Approx(20).margin(0.002));
  network.effects[0].parameters[1].second = 0;
  CHECK(run(network, warming(6))(12, 0) == Approx(26).margin(0.05));
}

TEST_CASE("a hidden mass keeps the heat of the whole", "[effects]") {
  ThermalNetwork network =
      hot(lump({"thermal-memory", "lump", "", {{"capacity_J_per_K", 5000}, {"conductance_W_per_K", 4}}}), 20);
  network.nodes[0].ambient_W_per_K = 0;
  network.heat_sources = {{"heater", "constant", 1, 1, 50, {{0, 1.0}}}};
  const Simulation result = simulate(network, {excitation_of(network, hour())}, library)[0];
  REQUIRE(result.nodes_degC.cols() == 2);
  for (Index k = 0; k < 13; ++k)
    CHECK(1000 * (result.nodes_degC(k, 0) - 20) + 5000 * (result.nodes_degC(k, 1) - 20) ==
          Approx(50 * 300 * static_cast<double>(k)).margin(1e-6));
}

TEST_CASE("a machine without a measured room follows it when the effect says so", "[effects]") {
  ThermalNetwork told = example_network();
  ThermalNetwork blind = told;
  blind.ambient = {ThermalNetwork::Ambient::Rule::initial, "", 0};
  const Matrix expected = run(told, example_batch());
  CHECK((run(blind, example_batch()) - expected).cwiseAbs().maxCoeff() > 0.5);
  blind.effects = {{"ambient-drift", "ambient", "", {{"share", 1}}}};
  CHECK((run(blind, example_batch()) - expected).cwiseAbs().maxCoeff() < 0.01);  // the effect smooths the reading
}

TEST_CASE("a start read from the thermometers is taken over batch by batch", "[effects]") {
  ThermalNetwork network = lump({"initial-gradient", "lump", "measured", {{"share", 0.5}}});
  for (const double first : {23.0, 18.0}) {
    Batch batch = hour();
    batch.temperatures.names = {"T1"};
    batch.temperatures.values = Matrix::Constant(batch.rows(), 1, first);
    const Excitation drive = excitation_of(network, batch);
    CHECK(simulate(network, {drive}, library)[0].nodes_degC(0, 0) ==
          Approx(drive.ambient_degC(0) + 0.5 * (first - drive.ambient_degC(0))));
  }
  network.sensors.clear();
  CHECK_THROWS_WITH(simulate(network, {excitation_of(network, hour())}, library),
                    Catch::Matchers::Contains("no thermometer"));
}
