#include "thermfit/effects/catalogue.hpp"

#include <set>

#include "support/catch.hpp"
#include "support/example_network.hpp"
#include "thermfit/network/simulate.hpp"

using namespace thermfit;
using test::example_batch;
using test::example_network;

namespace {

/// A candidate with parameters well away from where it vanishes, inside their bounds.
ThermalNetwork::AddedEffect strong(ThermalNetwork::AddedEffect added, const ThermalNetwork& network,
                                   const EffectLibrary& library) {
  for (const EffectParameter& p : library.at(added.effect).parameters(network, added)) {
    if (p.fixed) continue;
    const double value = p.logarithmic ? p.mean * std::exp(0.4 * p.sd) : p.mean + 0.4 * p.sd;
    for (auto& [name, number] : added.parameters)
      if (name == p.name) number = value;
  }
  return added;
}

}  // namespace

TEST_CASE("the catalogue holds the effects of the contract, each once and in the order of the chain", "[effects]") {
  const std::vector<std::string> names{
      "heat-source",        "friction-law",        "coolant",           "ambient-drift", "forced-convection",
      "natural-convection", "radiation",           "joint-conductance", "missing-link",  "thermal-memory",
      "missing-expansion",  "nonlinear-expansion", "speed-shift",       "hysteresis",    "initial-gradient",
      "sensor-offset",      "sensor-gain",         "sensor-drift",      "sensor-lag",    "probe-drift",
      "clock-offset"};
  CHECK(standard_effects().names() == names);
}

TEST_CASE("every effect says what it means, each something else", "[effects]") {
  const EffectLibrary library = standard_effects();
  std::set<std::string> meanings;
  for (const auto& effect : library.all()) meanings.insert(effect->meaning());
  CHECK(meanings.size() == library.all().size());
  CHECK(meanings.count("") == 0);
}

TEST_CASE("an effect asks for the schedule that shows it", "[effects]") {
  const EffectLibrary library = standard_effects();
  const auto block = [&](const std::string& effect, const std::string& location, const std::string& driver) {
    return library.at(effect).shown_by({effect, location, driver, {}}, 4);
  };
  for (const std::string fault : {"sensor-offset", "sensor-gain", "sensor-drift", "sensor-lag"}) {
    CHECK(block(fault, "T3", "").kind == ScheduleKind::sensor_swap);
    CHECK(block(fault, "T3", "").subject == "T3");
  }
  CHECK(block("coolant", "head", "pump").kind == ScheduleKind::toggle);
  CHECK(block("coolant", "head", "pump").subject == "pump");
  CHECK(block("heat-source", "head", "feed").subject == "feed");
  CHECK(block("heat-source", "head", "constant").kind == ScheduleKind::cool_down);
  CHECK(block("friction-law", "bearing", "speed").kind == ScheduleKind::speed_stair);
  CHECK(block("ambient-drift", "ambient", "").kind == ScheduleKind::idle_day);
  CHECK(block("initial-gradient", "head", "").kind == ScheduleKind::repeat);
}

TEST_CASE("an offset is what calibration moves too, a clock and a start are no places of the network", "[effects]") {
  const EffectLibrary library = standard_effects();
  for (const auto& effect : library.all()) {
    INFO(effect->name());
    CHECK(effect->calibration_does_the_same() == (effect->name() == "sensor-offset"));
    const std::string place = effect->disturbs({effect->name(), "somewhere", "", {}});
    CHECK(place == (effect->name() == "clock-offset"       ? "clock"
                    : effect->name() == "initial-gradient" ? "start"
                                                           : "somewhere"));
  }
}

TEST_CASE("every effect acts on the example machine, with complete parameters and places that can be read back",
          "[effects]") {
  const EffectLibrary library = standard_effects();
  ThermalNetwork network = example_network();
  network.ambient.rule = ThermalNetwork::Ambient::Rule::initial;
  const Setting setting = setting_of(network, {example_batch(0), example_batch(1)});
  CHECK(setting.inputs == std::vector<std::string>{"spindle_rpm", "feed_mm_min", "coolant"});
  std::set<std::string> acting;
  for (ThermalNetwork::AddedEffect& added : library.candidates(setting)) {
    acting.insert(added.effect);
    network.effects = {added};
    INFO(added.effect << " at " << added.location << " by " << added.driver);
    CHECK(with_complete_effects(network, library).effects[0].parameters.size() == added.parameters.size());
  }
  CHECK(acting.size() == library.all().size());
}

TEST_CASE("sensitivities with any effect at any place agree with central differences", "[effects]") {
  const EffectLibrary library = standard_effects();
  ThermalNetwork network = example_network();
  const bool measured_ambient = GENERATE(true, false);
  if (!measured_ambient) network.ambient = {ThermalNetwork::Ambient::Rule::initial, "", 0};
  const Campaign campaign{example_batch(0, 25)};
  const std::vector<Excitation> drive = excitations_of(network, campaign);
  for (const auto& candidate : library.candidates(setting_of(network, campaign))) {
    network.effects = {strong(candidate, network, library)};
    const std::vector<Parameter> parameters = calibration_parameters(network, library);
    const Simulation exact = simulate(network, drive, library, parameters).front();
    const Vector values = values_of(network, parameters);
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      const Index column = static_cast<Index>(j);
      const double step = 3e-5 * (parameters[j].logarithmic ? values(column) : parameters[j].sd);
      Vector above = values, below = values;
      above(column) += step;
      below(column) -= step;
      const Matrix difference = (simulate(with_values(network, parameters, above), drive, library)[0].channels -
                                 simulate(with_values(network, parameters, below), drive, library)[0].channels) /
                                (2 * step);
      const Vector tangent = exact.jacobian.col(column);
      const Eigen::Map<const Matrix> same_shape(tangent.data(), difference.rows(), difference.cols());
      INFO(candidate.effect << " at " << candidate.location << " by " << candidate.driver << ": "
                            << parameters[j].name);
      const double error =
          (same_shape - difference).cwiseAbs().maxCoeff() / std::max(1e-12, difference.cwiseAbs().maxCoeff());
      if (error > 2e-6) CHECK(error <= 2e-6);
    }
  }
}

TEST_CASE("an effect whose parameters are null changes nothing", "[effects]") {
  const EffectLibrary library = standard_effects();
  const ThermalNetwork plain = example_network();
  const Campaign campaign{example_batch(0)};
  const std::vector<Excitation> drive = excitations_of(plain, campaign);
  const Matrix expected = simulate(plain, drive, library)[0].channels;
  for (ThermalNetwork::AddedEffect added : library.candidates(setting_of(plain, campaign))) {
    bool has_null = true;
    for (const EffectParameter& p : library.at(added.effect).parameters(plain, added)) {
      has_null = has_null && !p.logarithmic;
      for (auto& [name, number] : added.parameters)
        if (name == p.name && !p.shapes && !p.fixed) number = p.null;
    }
    if (!has_null) continue;
    ThermalNetwork network = plain;
    network.effects = {added};
    INFO(added.effect << " at " << added.location << " by " << added.driver);
    CHECK((simulate(network, drive, library)[0].channels - expected).cwiseAbs().maxCoeff() < 1e-10);
  }
}

TEST_CASE("unknown effects, places, drivers and parameters are named in the error", "[effects]") {
  const EffectLibrary library = standard_effects();
  ThermalNetwork network = example_network();
  const auto complaint = [&](ThermalNetwork::AddedEffect added) {
    network.effects = {std::move(added)};
    try {
      const ThermalNetwork complete = with_complete_effects(network, library);
      simulate(complete, {excitation_of(complete, example_batch())}, library);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(complaint({"head-source", "bed", "constant", {}}).find("'head-source' is not known") != std::string::npos);
  CHECK(complaint({"heat-source", "bad", "constant", {}}).find("there is no node 'bad'") != std::string::npos);
  CHECK(complaint({"heat-source", "bed", "hydraulics", {}}).find("there is no input column 'hydraulics'") !=
        std::string::npos);
  CHECK(complaint({"heat-source", "bed", "constant", {{"watts", 3}}}).find("no such parameter") != std::string::npos);
  CHECK(complaint({"joint-conductance", "nose-bed", "", {}}).find("are not linked") != std::string::npos);
  CHECK(complaint({"sensor-lag", "T77", "", {}}).find("there is no sensor 'T77'") != std::string::npos);
  CHECK(complaint({"probe-drift", "Z", "moon", {}}).find("time, ambient") != std::string::npos);
  CHECK(complaint({"joint-conductance", "bearing-nose", "", {}}) == "accepted");  // either order
}
