#pragma once

/// The room's thermometer in another unit, or exchanged with another.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/sides/drive_weighing.hpp"

namespace thermfit::detail {

/// The room's thermometer in another unit than the others.
template <typename Scalar>
std::vector<DataProblem> room_unit(const DriveWeighing<Scalar>& of) {
  const std::string name = of.room();
  if (name.empty() || of.real()[0].temperatures.find(name) < 0) return {};
  for (const Reading& reading : temperature_readings()) {
    if (reading.as_given() || reading.simulated) continue;
    Campaign otherwise = of.real();
    std::vector<std::size_t> odd;
    for (std::size_t b = 0; b < otherwise.size(); ++b) {
      MatrixX<Scalar>& values = otherwise[b].temperatures.values;
      const Index column = otherwise[b].temperatures.find(name);
      std::vector<double> starts;
      for (Index c = 0; c < values.cols(); ++c)
        if (c != column && std::isfinite(values(0, c))) starts.push_back(values(0, c));
      if (starts.empty()) continue;
      std::nth_element(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(starts.size() / 2), starts.end());
      const double others = starts[starts.size() / 2], own = values(0, column);
      values.col(column) = (reading.scale * values.col(column)).array() + reading.shift;
      if (std::abs(own - others) > of.limits().level_K &&
          std::abs(values(0, column) - others) < std::abs(own - others) / 4)
        odd.push_back(b);
    }
    DataProblem problem;
    problem.kind = DataProblem::Kind::unit;
    problem.names = {name};
    problem.unit = reading.unit;
    if (auto one = of.weigh(std::move(problem), otherwise, odd)) return {std::move(*one)};
  }
  return {};
}

/// The room's thermometer exchanged with another.
template <typename Scalar>
std::vector<DataProblem> exchanged_room(const DriveWeighing<Scalar>& of) {
  std::vector<DataProblem> found;
  const std::string name = of.room();
  if (name.empty() || of.real()[0].temperatures.find(name) < 0) return {};
  std::string best;
  const double channels = static_cast<double>(of.given_sides().channels.size());
  double least = std::log(of.limits().exchanged_room) * channels;
  const auto otherwise = [&](const std::string& other) {
    Campaign campaign = of.real();
    for (Batch& batch : campaign) {
      MatrixX<Scalar>& values = batch.temperatures.values;
      const Index a = batch.temperatures.find(name), b = batch.temperatures.find(other);
      const VectorX<Scalar> kept = values.col(a);
      values.col(a) = values.col(b);
      values.col(b) = kept;
    }
    return campaign;
  };
  for (const ThermalNetwork::Sensor& sensor : of.machine().sensors) {
    if (sensor.column == name || sensor.node < 0 || of.real()[0].temperatures.find(sensor.column) < 0) continue;
    const std::vector<double> misfit = of.misfits(otherwise(sensor.column));
    double gain = 0;
    for (std::size_t b = 0; b < misfit.size(); ++b) gain += misfit[b] - of.given()[b];
    gain /= static_cast<double>(misfit.size());
    if (gain < least) least = gain, best = sensor.column;
  }
  if (best.empty()) return {};
  DataProblem problem;
  problem.kind = DataProblem::Kind::swapped;
  problem.names = {name, best};
  if (auto one = of.weigh(std::move(problem), otherwise(best), of.all())) found.push_back(std::move(*one));
  return found;
}

}  // namespace thermfit::detail
