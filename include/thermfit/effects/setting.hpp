#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/network/effect.hpp"

namespace thermfit {

namespace detail {

/// Typical size in a network, from which the priors of effects are scaled: the geometric mean of what is not zero;
/// `fallback` where there is nothing.
template <class Items, class Get>
double typical(const Items& items, Get get, double fallback) {
  double sum = 0;
  int count = 0;
  for (const auto& item : items)
    if (const double value = std::abs(get(item)); value > 0) {
      sum += std::log(value);
      ++count;
    }
  return count ? std::exp(sum / count) : fallback;
}

}  // namespace detail

/// Geometric mean of the links, W/K; without any, of the conductances to ambient; 1 where there is nothing. Does not
/// allocate.
inline double typical_conductance_W_per_K(const ThermalNetwork& network) {
  const double ambient = detail::typical(
      network.nodes, [](const auto& node) { return node.ambient_W_per_K; }, 1);
  return detail::typical(
      network.links, [](const auto& link) { return link.conductance_W_per_K; }, ambient);
}

/// Geometric mean of the heat sources, W; without any, what makes 10 K across a typical conductance. Does not allocate.
inline double typical_power_W(const ThermalNetwork& network) {
  const double fallback = 10 * typical_conductance_W_per_K(network);
  return detail::typical(
      network.heat_sources, [](const auto& source) { return source.power_W; }, fallback);
}

/// Largest expansion of an output, um/K; 1 where there is none.
inline double largest_expansion_um_per_K(const ThermalNetwork& network) {
  double largest = 0;
  for (const auto& output : network.displacements)
    for (const auto& [node, um_per_K] : output.um_per_K) largest = std::max(largest, std::abs(um_per_K));
  return largest > 0 ? largest : 1;
}

/// What one unit of an input means: the scale of the heat source it drives, else its largest value.
inline double scale_of(const Setting& setting, const std::string& input) {
  for (const auto& source : setting.network.heat_sources)
    if (source.input == input) return source.scale;
  return setting.largest_of(input);
}

/// What the data of a campaign can show of this machine.
inline Setting setting_of(const ThermalNetwork& network, const Campaign& campaign) {
  Setting setting;
  setting.network = network;
  if (campaign.empty()) return setting;
  for (const std::string& name : campaign.front().inputs.names) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    bool zero_or_highest = true;
    for (const Batch& batch : campaign) {
      const Index column = batch.inputs.find(name);
      if (column < 0) continue;
      for (Index k = 0; k < batch.rows(); ++k)
        if (const double value = batch.inputs.values(k, column); std::isfinite(value)) {
          lowest = std::min(lowest, value);
          highest = std::max(highest, value);
        }
    }
    for (const Batch& batch : campaign)
      if (const Index column = batch.inputs.find(name); column >= 0)
        for (Index k = 0; k < batch.rows(); ++k) {
          const double value = batch.inputs.values(k, column);
          zero_or_highest = zero_or_highest && (!std::isfinite(value) || value == 0 || value == highest);
        }
    if (!(highest > lowest)) {
      setting.constant_inputs.push_back(name);
      continue;
    }
    setting.inputs.push_back(name);
    setting.largest.push_back(std::max(std::abs(lowest), std::abs(highest)));
    if (zero_or_highest && lowest == 0) setting.on_off_inputs.push_back(name);
  }
  std::vector<double> steps;
  setting.shortest_batch_s = std::numeric_limits<double>::infinity();
  for (const Batch& batch : campaign) {
    if (!batch.has_time()) continue;
    const double length = batch.time_s(batch.rows() - 1) - batch.time_s(0);
    setting.shortest_batch_s = std::min(setting.shortest_batch_s, length);
    setting.longest_batch_s = std::max(setting.longest_batch_s, length);
    for (Index k = 1; k < batch.rows(); ++k) steps.push_back(batch.time_s(k) - batch.time_s(k - 1));
  }
  if (!steps.empty()) {
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
    setting.median_step_s = steps[steps.size() / 2];
  } else {
    setting.shortest_batch_s = 0;
  }
  for (const auto& sensor : network.sensors) {
    if (sensor.node != ThermalNetwork::ambient_node) continue;
    for (const Batch& batch : campaign) {
      const Index column = batch.temperatures.find(sensor.column);
      if (column < 0) continue;
      setting.ambient_measured = true;
      const Vector values = batch.temperatures.values.col(column);
      setting.ambient_varies = setting.ambient_varies || values.maxCoeff() - values.minCoeff() > 0;
    }
    break;
  }
  return setting;
}

}  // namespace thermfit
