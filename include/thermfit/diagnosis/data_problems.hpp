#pragma once

/// Faults of the data that a diagnosis sees on its way.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/findings/finding.hpp"

namespace thermfit {

/// Thermometers that only one side has, and `findings` on single batches, by batch; copies among thermometers and
/// unusual units are told where both sides are compared. Allocates.
template <typename Scalar = double>
std::vector<DataProblem> data_problems(const ThermalNetwork& machine, const Campaign& real,
                                       const std::vector<std::vector<Finding>>& findings) {
  using Kind = DataProblem::Kind;
  std::vector<DataProblem> result;
  DataProblem missing{Kind::not_measured, {}, "", "", "", ""}, unknown{Kind::not_modelled, {}, "", "", "", ""};
  for (const ThermalNetwork::Sensor& sensor : machine.sensors)
    if (real[0].temperatures.find(sensor.column) < 0) missing.names.push_back(sensor.column);
  for (const std::string& name : real[0].temperatures.names)
    if (std::none_of(machine.sensors.begin(), machine.sensors.end(),
                     [&](const ThermalNetwork::Sensor& sensor) { return sensor.column == name; }))
      unknown.names.push_back(name);
  for (DataProblem* one : {&missing, &unknown})
    if (!one->names.empty()) result.push_back(std::move(*one));
  for (std::size_t b = 0; b < findings.size(); ++b)
    for (const Finding& one : findings[b]) {
      if (one.rule == FindingRule::collinear || one.rule == FindingRule::unit || one.rule == FindingRule::range)
        continue;
      result.push_back({Kind::finding, {}, real[b].name, one.channel, std::string(rule_name(one.rule)), one.note});
    }
  return result;
}

THERMFIT_COMPILED_TEMPLATE(std::vector<DataProblem> data_problems<double>(const ThermalNetwork&, const Campaign&,
                                                                          const std::vector<std::vector<Finding>>&));

}  // namespace thermfit
