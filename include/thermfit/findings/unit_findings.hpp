#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/findings/finding.hpp"
#include "thermfit/findings/series_scale.hpp"

namespace thermfit {

/// Values that make sense in another unit only. Temperatures: a start above 200 degC looks like kelvin; one above 50
/// degC, or 25 K above the median of the others, like degrees Fahrenheit. Thermal errors: more than 5 mm looks like
/// nanometres or counts; less than 0.5 um in all, finer than 0.002 um, while temperatures rose by 3 K or more, like
/// millimetres. Allocates.
inline std::vector<Finding> unit_findings(const Batch& batch) {
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
    if (start > 200)
      add(start, 200, "starts as kelvin do: name the unit, " + name + " [K]");
    else if (start > 50)
      add(start, 50, "starts as degrees Fahrenheit do: name the unit, " + name + " [degF]");
    else if (others.size() > 1 && start - middle > 25)
      add(start, middle + 25, "starts far above the others: degrees Fahrenheit?");
  }
  for (Index c = 0; c < batch.errors.count(); ++c) {
    const Series series(batch.errors.values.col(c));
    const SeriesScale scale = series_scale(series);
    const std::string& name = batch.errors.names[static_cast<std::size_t>(c)];
    const double size = std::max(std::abs(scale.lowest), std::abs(scale.highest));
    if (size > 5000)
      findings.push_back({FindingRule::unit, name, 0, 0, size, 5000, "um", "too much for micrometres: nm or counts?"});
    else if (scale.range() > 0 && scale.range() < 0.5 && scale.resolution < 0.002 && largest_rise > 3)
      findings.push_back({FindingRule::unit, name, 0, 0, scale.range(), 0.5, "um",
                          "too little for micrometres: name the unit, " + name + " [mm]"});
  }
  return findings;
}

}  // namespace thermfit
