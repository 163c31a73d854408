#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/error.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/network/impl/smooth_level.hpp"
#include "thermfit/network/thermal_network.hpp"

namespace thermfit {

/// What drives one batch, as the simulator needs it: a clock, held inputs, the ambient temperature and where it starts.
struct Excitation {
  std::string batch;                     ///< name of the batch
  Index number = -1;                     ///< place in ThermalNetwork::batches; -1: it has no numbers of its own
  Vector time_s;                         ///< since the first sample; strictly increasing
  std::vector<std::string> input_names;  ///< columns of `inputs`
  Matrix inputs;                         ///< samples x inputs, held until the next sample
  Vector ambient_degC;                   ///< at the samples, linear between them
  Vector measured_ambient_degC;          ///< of the ambient sensor, its noise smoothed; empty where there is none
  Vector first_reading_degC;             ///< of every sensor of the network; NaN where the batch has none
  Vector start_degC;  ///< of every node, as read: the simulation takes the mean of the sensors' offsets off
  std::vector<std::vector<Index>> start_sensors;  ///< for each node, the sensors its start was read from
  std::vector<char> starts_at_ambient;            ///< for each node, whether it starts wherever ambient does
  /// Steps for heat that depends on temperatures, in units of its time constant; errors grow with the square. The
  /// default is exact to about 1e-5 K.
  double state_step = 0.03;

  /// How many there are.
  Index samples() const { return time_s.size(); }

  /// Column of `inputs` of this name, or -1. Does not allocate.
  Index find_input(const std::string& name) const {
    for (std::size_t i = 0; i < input_names.size(); ++i)
      if (input_names[i] == name) return static_cast<Index>(i);
    return -1;
  }
};

/// What a machine file says where nothing measures the room.
constexpr const char* says_unmeasured = "\"ambient\": {\"unmeasured\": true}";

namespace detail {

/// The column `name` of a batch, wherever it is; throws Error where it is absent or has a missing value in its first
/// `rows` samples.
template <typename Scalar = double>
VectorX<Scalar> batch_column(const Lazy<Batch, Scalar>& batch, const std::string& name, const std::string& purpose,
                             Index rows) {
  const std::string place = batch.source.empty() ? "batch " + batch.name : batch.source;
  for (const Channels* channels : {&batch.temperatures, &batch.inputs, &batch.errors}) {
    const Index j = channels->find(name);
    if (j < 0) continue;
    const MatrixX<Scalar>& all = channels->values;
    const VectorX<Scalar> values = all.col(j);
    for (Index i = 0; i < rows; ++i)
      if (!std::isfinite(values(i)))
        throw Error(place, "column '" + name + "' has no value in sample " + std::to_string(i + 1),
                    "complete values: it is " + purpose,
                    "use CsvOptions::missing = hold or CsvOptions::missing = drop");
    return values;
  }
  std::string known;
  for (const Channels* channels : {&batch.inputs, &batch.temperatures})
    for (const std::string& column : channels->names) known += (known.empty() ? "" : ", ") + column;
  throw Error(place, "there is no column '" + name + "', which is " + purpose, known,
              purpose.find("ambient") == std::string::npos
                  ? "name the column in the machine file as it is named in the data"
                  : std::string("name the column in the machine file as it is named in the data, or, where nothing "
                                "measures the room, write ") +
                        says_unmeasured + ": it is fitted batch by batch");
}

inline const ThermalNetwork::Sensor* ambient_sensor(const ThermalNetwork& network, const Batch& batch) {
  for (const ThermalNetwork::Sensor& sensor : network.sensors)
    if (sensor.node == ThermalNetwork::ambient_node && batch.temperatures.find(sensor.column) >= 0) return &sensor;
  return nullptr;
}

/// What the parts read first, in increasing order.
template <typename Scalar = double>
std::vector<double> first_of_parts(const ThermalNetwork& network, const Batch& batch) {
  std::vector<double> result;
  for (const ThermalNetwork::Sensor& sensor : network.sensors)
    if (const Index column = batch.temperatures.find(sensor.column); sensor.node >= 0 && column >= 0)
      if (const double degC = batch.temperatures.values(0, column); std::isfinite(degC)) result.push_back(degC);
  std::sort(result.begin(), result.end());
  return result;
}

/// The room where nothing measures it, before the data are looked at: where the colder parts start (their lower
/// quartile), since what ran is warmer than the room.
template <typename Scalar = double>
double room_by_parts(const ThermalNetwork& network, const Batch& batch) {
  const std::vector<double> parts = first_of_parts<Scalar>(network, batch);
  return parts.empty() ? network.reference_degC : parts[(parts.size() - 1) / 4];
}

/// Steady temperatures between those that are known: every node of which `known` is false gets what the links and the
/// conductances to ambient make of its neighbours.
template <typename Scalar = double>
void fill_between(const ThermalNetwork& network, double ambient_degC, const std::vector<char>& known,
                  VectorX<Scalar>& degC) {
  const Index n = degC.size();
  MatrixX<Scalar> weights = MatrixX<Scalar>::Identity(n, n);
  VectorX<Scalar> right = degC;
  const auto open = [&](Index node) { return !known[static_cast<std::size_t>(node)]; };
  for (Index i = 0; i < n; ++i)
    if (open(i)) {
      weights(i, i) = network.nodes[static_cast<std::size_t>(i)].ambient_W_per_K;
      right(i) = weights(i, i) * ambient_degC;
    }
  for (const ThermalNetwork::Link& link : network.links)
    for (const auto& [a, b] : {std::pair(link.a, link.b), std::pair(link.b, link.a)})
      if (open(a)) {
        weights(a, a) += link.conductance_W_per_K;
        weights(a, b) -= link.conductance_W_per_K;
      }
  for (Index i = 0; i < n; ++i)
    if (weights(i, i) <= 0) weights(i, i) = 1, right(i) = ambient_degC;
  degC = weights.partialPivLu().solve(right);
}

template <typename Scalar = double>
VectorX<Scalar> ambient_of(const ThermalNetwork& network, const Batch& batch) {
  using Rule = ThermalNetwork::Ambient::Rule;
  const ThermalNetwork::Ambient& ambient = network.ambient;
  const Index rows = batch.rows();
  if (ambient.rule == Rule::unmeasured) {
    if (const ThermalNetwork::Sensor* sensor = ambient_sensor(network, batch))
      throw Error(batch.source.empty() ? "batch " + batch.name : batch.source,
                  "column '" + sensor->column + "' measures the room, which the machine file calls unmeasured",
                  "one of the two", "write \"ambient\": \"" + sensor->column + "\", or map that sensor elsewhere");
    return VectorX<Scalar>::Constant(rows, room_by_parts<Scalar>(network, batch));
  }
  if (ambient.rule == Rule::constant) return VectorX<Scalar>::Constant(rows, ambient.value_degC);
  if (ambient.rule == Rule::column)
    return batch_column<Scalar>(batch, ambient.column, "the machine's ambient temperature", rows);
  std::string column = ambient.column;
  if (ambient.rule == Rule::initial) {
    const ThermalNetwork::Sensor* sensor = ambient_sensor(network, batch);
    if (!sensor)
      throw Error(batch.source.empty() ? "batch " + batch.name : batch.source,
                  "the ambient temperature is unknown: the machine's rule is \"initial\" and no sensor is mapped to "
                  "ambient",
                  "",
                  std::string("map a sensor to node \"ambient\", give a column or a number as \"ambient\", or write ") +
                      says_unmeasured + ": it is fitted batch by batch");
    column = sensor->column;
  }
  return VectorX<Scalar>::Constant(
      rows, batch_column<Scalar>(batch, column, "the machine's first ambient temperature", 1)(0));
}

}  // namespace detail

/// The excitation of a batch. Throws Error when the batch has no clock, fewer than two samples, lacks a column that the
/// network needs, or has a missing value in one. Allocates.
template <typename Scalar = double>
Excitation excitation_of(const ThermalNetwork& network, const Lazy<Batch, Scalar>& batch) {
  const std::string place = batch.source.empty() ? "batch " + batch.name : batch.source;
  if (!batch.has_time())
    throw Error(place, "there is no time column", "time_s, time_min, time_h, time or a date-time",
                "a simulation needs a clock");
  if (batch.rows() < 2) throw Error(place, "one sample only", "at least two", "a simulation needs a duration");

  Lazy<Excitation, Scalar> result;
  result.batch = batch.name;
  result.time_s = batch.time_s.array() - batch.time_s(0);
  for (Index i = 1; i < batch.rows(); ++i)
    if (!(result.time_s(i) > result.time_s(i - 1)))
      throw Error(place, "the clock does not advance at sample " + std::to_string(i + 1), "strictly increasing time");
  result.input_names = batch.inputs.names;
  result.inputs = batch.inputs.values;
  for (const ThermalNetwork::HeatSource& source : network.heat_sources) {
    if (source.input == "constant" || result.find_input(source.input) >= 0) continue;
    // A heat source may follow any column; those that are not inputs (a measured temperature, say) are taken along.
    const VectorX<Scalar> values = detail::batch_column<Scalar>(
        batch, source.input, "the input of heat source '" + source.name + "'", batch.rows());
    result.input_names.push_back(source.input);
    result.inputs.conservativeResize(batch.rows(), result.inputs.cols() + 1);
    result.inputs.rightCols(1) = values;
  }
  for (const ThermalNetwork::HeatSource& source : network.heat_sources)
    if (source.input != "constant")
      detail::batch_column<Scalar>(batch, source.input, "the input of heat source '" + source.name + "'", batch.rows());

  result.ambient_degC = detail::ambient_of<Scalar>(network, batch);
  if (const ThermalNetwork::Sensor* sensor = detail::ambient_sensor(network, batch)) {
    result.measured_ambient_degC = batch.temperatures.values.col(batch.temperatures.find(sensor->column));
    if (!result.measured_ambient_degC.allFinite()) result.measured_ambient_degC.resize(0);
    smooth_level<Scalar>(result.measured_ambient_degC);
  }

  result.first_reading_degC = VectorX<Scalar>::Constant(static_cast<Index>(network.sensors.size()), std::nan(""));
  for (std::size_t s = 0; s < network.sensors.size(); ++s)
    if (const Index column = batch.temperatures.find(network.sensors[s].column); column >= 0)
      result.first_reading_degC(static_cast<Index>(s)) = batch.temperatures.values(0, column);

  const Index nodes = network.node_count();
  result.start_degC = VectorX<Scalar>::Constant(nodes, result.ambient_degC(0));
  result.start_sensors.resize(network.nodes.size());
  if (network.initial.rule == ThermalNetwork::Initial::Rule::given)
    for (const auto& [node, degC] : network.initial.degC) result.start_degC(node) = degC;
  result.starts_at_ambient.assign(network.nodes.size(), true);
  for (const auto& [node, degC] : network.initial.degC)
    result.starts_at_ambient[static_cast<std::size_t>(node)] = false;
  const bool fitted = network.initial.rule == ThermalNetwork::Initial::Rule::fitted;
  if (fitted || network.initial.rule == ThermalNetwork::Initial::Rule::measured) {
    VectorX<Scalar> sum = VectorX<Scalar>::Zero(nodes);
    for (std::size_t s = 0; s < network.sensors.size(); ++s) {
      const ThermalNetwork::Sensor& sensor = network.sensors[s];
      if (sensor.node < 0 || batch.temperatures.find(sensor.column) < 0) continue;
      if (fitted && !std::isfinite(result.first_reading_degC(static_cast<Index>(s)))) continue;
      sum(sensor.node) += detail::batch_column<Scalar>(batch, sensor.column, "the start of a node", 1)(0);
      result.start_sensors[static_cast<std::size_t>(sensor.node)].push_back(static_cast<Index>(s));
    }
    for (Index node = 0; node < nodes; ++node)
      if (const auto count = result.start_sensors[static_cast<std::size_t>(node)].size(); count > 0)
        result.start_degC(node) = sum(node) / static_cast<double>(count);
    std::vector<char> known;
    for (const std::vector<Index>& sensors : result.start_sensors) known.push_back(!sensors.empty());
    for (std::size_t i = 0; i < known.size(); ++i) result.starts_at_ambient[i] = !known[i] && !fitted;
    if (fitted) detail::fill_between<Scalar>(network, result.ambient_degC(0), known, result.start_degC);
  }
  return result;
}

THERMFIT_COMPILED_TEMPLATE(Excitation excitation_of<double>(const ThermalNetwork&, const Batch&));

/// excitation_of() each batch of a campaign, in order.
template <typename Scalar = double>
std::vector<Excitation> excitations_of(const ThermalNetwork& network, const Campaign& campaign) {
  std::vector<Excitation> result;
  for (const Batch& batch : campaign) {
    result.push_back(excitation_of<Scalar>(network, batch));
    result.back().number = static_cast<Index>(result.size()) - 1;
  }
  return result;
}

}  // namespace thermfit
