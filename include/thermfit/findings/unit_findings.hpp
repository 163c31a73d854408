#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"

namespace thermfit {

/// When values make sense in another unit only. A batch starts near the temperature of a workshop, 10 to 40 degC, which
/// is 283 to 313 K and 50 to 104 degF; a machine tool is off by micrometres to some hundred.
struct UnitLimits {
  double kelvin_start_degC = 200;     ///< a temperature that starts above looks like kelvin
  double fahrenheit_start_degC = 50;  ///< one that starts above, like degrees Fahrenheit
  double fahrenheit_above_K = 25;     ///< so does one that starts so far above the median of the others
  double largest_error_um = 5000;     ///< a thermal error beyond looks like nanometres or counts
  double smallest_range_um = 0.5;     ///< one that moves less in all …
  double finest_step_um = 0.002;      ///< … and is written down finer …
  double warmed_by_K = 3;             ///< … while some temperature rose by more, looks like millimetres
};

/// Values that make sense in another unit only, judged by where temperatures start and how thermal errors move.
/// Allocates.
inline std::vector<Finding> unit_findings(const Batch& batch, const UnitLimits& limits = {}) {
  std::vector<Finding> findings;
  std::vector<double> starts;
  double largest_rise = 0;
  std::vector<Series> temperatures;
  for (Index c = 0; c < batch.temperatures.count(); ++c) {
    temperatures.emplace_back(batch.temperatures.values.col(c));
    const Series& series = temperatures.back();
    starts.push_back(series.size() == 0 ? std::nan("") : series.values.front());
    for (const double value : series.values) largest_rise = std::max(largest_rise, std::abs(value - starts.back()));
  }
  for (std::size_t c = 0; c < starts.size(); ++c) {
    const std::string& name = batch.temperatures.names[c];
    std::vector<double> others;
    for (std::size_t o = 0; o < starts.size(); ++o)
      if (o != c && std::isfinite(starts[o])) others.push_back(starts[o]);
    const double middle = median(others), start = starts[c];
    const auto add = [&](double figure, double limit, const std::string& note) {
      findings.push_back({FindingRule::unit, name, 0, 0, figure, limit, "degC", note});
    };
    if (start > limits.kelvin_start_degC)
      add(start, limits.kelvin_start_degC, "starts as kelvin do: name the unit, " + name + " [K]");
    else if (start > limits.fahrenheit_start_degC)
      add(start, limits.fahrenheit_start_degC, "starts as degrees Fahrenheit do: name the unit, " + name + " [degF]");
    else if (others.size() > 1 && start - middle > limits.fahrenheit_above_K)
      add(start, middle + limits.fahrenheit_above_K, "starts far above the others: degrees Fahrenheit?");
  }
  for (Index c = 0; c < batch.errors.count(); ++c) {
    const Series series(batch.errors.values.col(c));
    const SeriesScale scale = series_scale(series);
    const std::string& name = batch.errors.names[static_cast<std::size_t>(c)];
    const double size = std::max(std::abs(scale.lowest), std::abs(scale.highest));
    if (size > limits.largest_error_um)
      findings.push_back({FindingRule::unit, name, 0, 0, size, limits.largest_error_um, "um",
                          "too much for micrometres: nm or counts?"});
    else if (scale.range() > 0 && scale.range() < limits.smallest_range_um &&
             scale.resolution < limits.finest_step_um && largest_rise > limits.warmed_by_K)
      findings.push_back({FindingRule::unit, name, 0, 0, scale.range(), limits.smallest_range_um, "um",
                          "too little for micrometres: name the unit, " + name + " [mm]"});
  }
  return findings;
}

}  // namespace thermfit
