#pragma once

/// All thermometers in one other unit.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/sides/drive_weighing.hpp"

namespace thermfit::detail {

/// All thermometers in one other unit: seen by where they stand when a batch begins.
template <typename Scalar>
std::vector<DataProblem> temperatures_unit(const DriveWeighing<Scalar>& of) {
  std::vector<DataProblem> found;
  std::vector<double> starts;
  for (const Batch& batch : of.real())
    for (Index c = 0; c < batch.temperatures.count(); ++c)
      if (std::isfinite(batch.temperatures.values(0, c))) starts.push_back(batch.temperatures.values(0, c));
  if (starts.empty()) return {};
  std::nth_element(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(starts.size() / 2), starts.end());
  const double start = starts[starts.size() / 2];
  if (start < of.limits().warmest_start_degC) return {};
  const auto surprise = [&](double room_degC) {
    return .5 * std::pow((room_degC - of.limits().room_degC) / of.limits().room_sd_K, 2);
  };
  for (const Reading& reading : temperature_readings()) {
    const double read = reading.scale * start + reading.shift;
    if (reading.as_given() || reading.simulated || read < -10 || read > of.limits().warmest_start_degC) continue;
    Campaign otherwise = of.real();
    for (Batch& batch : otherwise) {
      MatrixX<Scalar>& values = batch.temperatures.values;
      values = (reading.scale * values).array() + reading.shift;
    }
    DataProblem problem;
    problem.kind = DataProblem::Kind::unit;
    problem.names = of.real()[0].temperatures.names;
    problem.unit = reading.unit;
    double channels = 0;
    for (const SideChannel& one : of.given_sides().channels) channels += !one.displacement;
    const double looks = looks_per_batch * static_cast<double>(of.real().size());
    if (auto one = of.weigh(std::move(problem), otherwise, of.all(),
                            surprise(start) - surprise(read) + channels * looks * std::log(reading.scale)))
      found.push_back(std::move(*one));
  }
  return found;
}

}  // namespace thermfit::detail
