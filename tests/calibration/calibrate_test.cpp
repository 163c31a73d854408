#include "thermfit/calibration/calibrate.hpp"

#include "support/catch.hpp"
#include "support/example_network.hpp"
#include "thermfit/effects/catalogue.hpp"

using namespace thermfit;
using test::example_batch;
using test::example_network;

namespace {

const EffectLibrary library = standard_effects();

/// What a machine would show, with pseudo-random noise of a thermometer and a probe.
Campaign measured(const ThermalNetwork& truth, double noise_K, double noise_um) {
  Campaign campaign;
  std::uint64_t state = 7;
  for (int b = 0; b < 3; ++b) {
    Batch batch = example_batch(b, 60);
    const Matrix shown = simulate(truth, {excitation_of(truth, batch)}, library)[0].channels;
    for (Index k = 0; k < batch.rows(); ++k) {
      for (Index s = 0; s < 4; ++s)
        batch.temperatures.values(k, s) = shown(k, s) + noise_K * 1.7 * symmetric_uniform(state);
      batch.errors.values(k, 0) = shown(k, 5) + noise_um * 1.7 * symmetric_uniform(state);
    }
    campaign.push_back(batch);
  }
  return campaign;
}

/// Every number of the machine's physics off by this share, up and down in turn.
ThermalNetwork off_by(ThermalNetwork machine, double share) {
  double factor = 1 + share;
  const auto move = [&](double& value) {
    value *= factor;
    factor = 1 / factor;
  };
  for (ThermalNetwork::Node& node : machine.nodes) {
    move(node.capacity_J_per_K);
    move(node.ambient_W_per_K);
  }
  for (ThermalNetwork::Link& link : machine.links) move(link.conductance_W_per_K);
  for (ThermalNetwork::HeatSource& source : machine.heat_sources) move(source.power_W);
  for (auto& [node, um_per_K] : machine.displacements[0].um_per_K) move(um_per_K);
  return machine;
}

MapFitOptions following_prior_scale() {
  MapFitOptions options;
  options.tolerance = 0.01;
  options.most_iterations = 60;
  options.fit_prior_scale = true;
  return options;
}

}  // namespace

TEST_CASE("calibration brings a miscalibrated machine back, within its own standard errors", "[gap][calibration]") {
  const ThermalNetwork truth = example_network();
  ThermalNetwork nominal = truth;
  nominal.nodes[2].capacity_J_per_K *= 1.3;
  nominal.links[1].conductance_W_per_K *= 0.7;
  nominal.heat_sources[0].power_W *= 1.25;
  nominal.displacements[0].um_per_K[2].second *= 0.8;
  const MachineRecord seen = observations_of(nominal, measured(truth, 0.03, 0.2));
  const Calibration result = calibrate(seen, nominal, library);
  CHECK(result.fit.converged);
  CHECK(result.agreeing >= 2);
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    INFO(seen.channels[c].name);
    CHECK(rms_of(result.fit.residual[c]) < 1.15 * (seen.channels[c].displacement ? 0.2 : 0.03));
  }
  const Vector wanted = values_of(truth, result.fit.parameters);
  int within = 0;
  for (Index j = 0; j < wanted.size(); ++j) {
    const double t = result.fit.parameter(j).coordinate(wanted(j));
    within += std::abs(result.fit.coordinates(j) - t) < 3 * result.identified[static_cast<std::size_t>(j)].sd;
  }
  CHECK(within >= static_cast<int>(wanted.size()) - 1);
}

TEST_CASE("a planted effect's parameters are found with everything else free", "[gap][calibration]") {
  ThermalNetwork truth = example_network();
  truth.effects = {{"natural-convection", "head", "", {{"k", 1.0}, {"exponent", 0.5}}}};
  ThermalNetwork nominal = truth;
  nominal.effects[0].parameters = {{"k", 0.2}, {"exponent", 0.5}};
  const MachineRecord seen = observations_of(nominal, measured(truth, 0.02, 0.1));
  const Calibration result = calibrate(seen, nominal, library);
  const ThermalNetwork found = result.fit.network();
  const std::size_t k = result.fit.parameters.size() - 2;
  CHECK(std::abs(found.effects[0].value("k") - 1.0) < 3 * result.identified[k].sd * result.fit.parameters[k].sd + 1e-9);
}

TEST_CASE("what the data cannot know is said: a source that never ran, two sources that are one",
          "[gap][calibration]") {
  ThermalNetwork machine = example_network();
  machine.heat_sources.push_back({"chip conveyor", "conveyor", 1, 1, 50, {{4, 1.0}}});
  machine.heat_sources.push_back({"second friction", "spindle_rpm", 4000, 1.2, 150, {{1, 0.6}, {2, 0.4}}});
  // Heat, capacities and conductances scaled together give the same temperatures: only known ones pin the powers.
  machine.uncertainty.capacity = machine.uncertainty.ambient = machine.uncertainty.conductance = 0.02;
  Campaign campaign;
  for (Batch batch : measured(example_network(), 0.02, 0.1)) {
    batch.inputs.names.push_back("conveyor");
    batch.inputs.values.conservativeResize(Eigen::NoChange, 4);
    batch.inputs.values.col(3).setZero();
    campaign.push_back(batch);
  }
  const MachineRecord seen = observations_of(machine, campaign);
  const Calibration result = calibrate(seen, machine, library, {1, 1, 0.7, 50});
  std::size_t conveyor = 0, first = 0, second = 0;
  for (std::size_t j = 0; j < result.fit.parameters.size(); ++j) {
    const std::string& name = result.fit.parameters[j].name;
    if (name == "power of chip conveyor") conveyor = j;
    if (name == "power of bearing friction") first = j;
    if (name == "power of second friction") second = j;
  }
  CHECK_FALSE(result.identified[conveyor].pinned());
  CHECK(result.identified[conveyor].sd == Approx(1).epsilon(1e-9));
  CHECK(result.identified[first].trades_with == static_cast<Index>(second));
  CHECK(result.identified[first].correlation < -0.95);
}

TEST_CASE("missing readings and machines without a displacement are calibrated all the same", "[gap][calibration]") {
  ThermalNetwork machine = example_network();
  Campaign campaign = measured(machine, 0.02, 0.1);
  machine.displacements.clear();
  campaign[1].temperatures.values(10, 2) = std::nan("");
  campaign[2].temperatures.values.col(0).tail(20).setConstant(std::nan(""));
  const MachineRecord seen = observations_of(machine, campaign);
  REQUIRE(seen.channels.size() == 4);
  const Calibration result = calibrate(seen, machine, library, {1, 1, 0.7, 50});
  CHECK(result.fit.coordinates.allFinite());
  CHECK(rms_of(result.fit.residual[0]) < 0.025);
}

TEST_CASE("a machine that is known better than its document says is trusted as it deserves, one that is not is not",
          "[gap][calibration]") {
  const ThermalNetwork truth = example_network();
  const auto trust_if_off_by = [&](double share) {
    const ThermalNetwork nominal = off_by(truth, share);
    return map_fit(observations_of(nominal, measured(truth, 0.03, 0.2)), nominal, library, following_prior_scale())
        .prior_scale;
  };
  // The document says 30 %.
  CHECK(trust_if_off_by(0.02) < 0.35);
  CHECK(trust_if_off_by(0.09) == Approx(0.3).margin(0.15));
  CHECK(trust_if_off_by(0.45) == 1);
}

TEST_CASE("calibration swallows less of an effect where the machine is known well", "[gap][calibration]") {
  ThermalNetwork truth = example_network();
  truth.effects = {{"thermal-memory", "motor", "", {{"capacity_J_per_K", 4000}, {"conductance_W_per_K", 4}}}};
  const ThermalNetwork nominal = example_network();
  const MachineRecord seen = observations_of(nominal, measured(truth, 0.05, 0.3));
  ThermalNetwork with_effect = nominal;
  with_effect.effects = {{"thermal-memory", "motor", "", {{"capacity_J_per_K", 6300}, {"conductance_W_per_K", 2}}}};
  const auto gain = [&](const MapFitOptions& options) {
    return map_fit(seen, with_effect, library, options).log_evidence -
           map_fit(seen, nominal, library, options).log_evidence;
  };
  MapFitOptions as_documented = following_prior_scale();
  as_documented.fit_prior_scale = false;
  CHECK(gain(following_prior_scale()) > gain(as_documented) + 5);
}
