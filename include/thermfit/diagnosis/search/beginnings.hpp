#pragma once

/// Where the size of an effect may begin and how far it may go.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "thermfit/network/effect.hpp"

namespace thermfit::detail {

/// Size of an effect in units of where it begins: 0 is no effect, 1 as begun.
struct SizeRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double prior_mean = 0, prior_information = 0;
};

/// Whether a parameter carries the size of an effect (else it only shapes it).
inline bool carries_size(const EffectParameter& one) { return !one.shapes && !one.fixed; }

inline double value_at_size(const EffectParameter& one, double begun, double size) {
  const double null = one.logarithmic ? 0 : one.null;
  const double value = null + size * (begun - null);
  return std::clamp(value, one.lower, one.upper);
}

/// The values at which to begin: every combination of what the parameters list, at most eight.
inline std::vector<ThermalNetwork::AddedEffect> beginnings(const Effect& effect, const ThermalNetwork& network,
                                                           const ThermalNetwork::AddedEffect& added) {
  std::vector<ThermalNetwork::AddedEffect> result{added};
  result[0].parameters.clear();
  for (const EffectParameter& one : effect.parameters(network, added)) {
    std::vector<double> starts = one.starts;
    if (one.fixed) starts = {added.value(one.name, one.mean)};
    if (starts.empty()) {
      const bool vanishes = carries_size(one) && !one.logarithmic && one.mean == one.null;
      starts = {vanishes ? std::clamp(one.null + one.sd, one.lower, one.upper) : one.mean};
      if (starts[0] == one.null && vanishes) starts[0] = std::clamp(one.null - one.sd, one.lower, one.upper);
    }
    std::vector<ThermalNetwork::AddedEffect> longer;
    for (const auto& begun : result)
      for (const double value : starts) {
        longer.push_back(begun);
        longer.back().parameters.emplace_back(one.name, value);
      }
    if (longer.size() <= 8) {
      result = std::move(longer);
    } else {
      for (auto& begun : result) begun.parameters.emplace_back(one.name, starts[0]);
    }
  }
  return result;
}

inline SizeRange size_range(const std::vector<EffectParameter>& parameters, const ThermalNetwork::AddedEffect& begun) {
  SizeRange range;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const EffectParameter& one = parameters[k];
    if (!carries_size(one)) continue;
    const double at = begun.parameters[k].second;
    if (one.logarithmic) {
      range.low = std::max(range.low, 0.02);
      range.high = std::min(range.high, std::exp(4 * one.sd) * one.mean / at);
      continue;
    }
    const double unit = at - one.null;
    if (unit == 0) continue;
    double a = (one.lower - one.null) / unit, b = (one.upper - one.null) / unit;
    if (a > b) std::swap(a, b);
    range.low = std::max(range.low, a);
    range.high = std::min(range.high, b);
    const double information = unit * unit / (one.sd * one.sd);
    range.prior_mean = (one.mean - one.null) / unit;
    range.prior_information += information;
  }
  return range;
}

}  // namespace thermfit::detail
