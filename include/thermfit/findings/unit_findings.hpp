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
  double unusual_start_degC = 50;  ///< a temperature that starts above is told; a hot place is no fault
  double alike_K = 2;              ///< in another unit it starts as the others of the batch do, within that or …
  double alike_scatters = 3;       ///< … so many standard deviations of the others
  double seasons_K = 5;            ///< … or as in the other batches, within their range and that
  double away_K = 10;              ///< as written it is farther from them than this
  double largest_error_um = 5000;  ///< a thermal error that moves by more looks like nanometres or counts
  double smallest_range_um = 0.5;  ///< one that moves less in all …
  double finest_step_um = 0.002;   ///< … and is written down finer …
  double warmed_by_K = 3;          ///< … while some temperature rose by more, looks like millimetres
};

namespace detail {

/// The unit in which `start` lies between `low` and `high`, degC, or nothing: where it is right as it stands, or not in
/// another unit either.
inline std::string unit_that_fits(double start, double low, double high, const UnitLimits& limits) {
  if (start > low - limits.away_K && start < high + limits.away_K) return "";
  const auto fits = [&](double degC) { return low <= degC && degC <= high; };
  return fits((start - 32) / 1.8) ? "degF" : fits(start - 273.15) ? "K" : "";
}

inline Finding unit_finding(const std::string& name, double start, double usual, const std::string& unit,
                            const std::string& like) {
  return {FindingRule::unit,
          name,
          0,
          0,
          start,
          usual,
          "degC",
          "in " + unit + " it starts as " + like + ": name the unit, CsvOptions::units = '" + name + "=" + unit + "'"};
}

}  // namespace detail

/// Values that make sense in another unit only: temperatures that start as the others do once they are converted,
/// thermal errors by how they move. A temperature that starts hot without such evidence is told as `range`: it may be
/// right. Allocates.
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
    std::vector<double> others, scatter;
    for (std::size_t o = 0; o < starts.size(); ++o)
      if (o != c && std::isfinite(starts[o])) others.push_back(starts[o]);
    const double middle = median(others), start = starts[c];
    for (const double other : others) scatter.push_back(std::abs(other - middle));
    const double near = std::max(limits.alike_K, limits.alike_scatters * median(scatter) / normal_median);
    const std::string unit =
        others.size() > 1 ? detail::unit_that_fits(start, middle - near, middle + near, limits) : "";
    if (!unit.empty())
      findings.push_back(detail::unit_finding(name, start, middle, unit, "the others do"));
    else if (start > limits.unusual_start_degC)
      findings.push_back({FindingRule::range, name, 0, 0, start, limits.unusual_start_degC, "degC",
                          "starts at " + std::to_string(std::lround(start)) +
                              ": degF, K, tenths of a degree? If it is degC, all is well"});
  }
  for (Index c = 0; c < batch.errors.count(); ++c) {
    const Series series(batch.errors.values.col(c));
    const SeriesScale scale = series_scale(series);
    const std::string& name = batch.errors.names[static_cast<std::size_t>(c)];
    const double size = std::max(std::abs(scale.lowest), std::abs(scale.highest));
    if (scale.range() > limits.largest_error_um)
      findings.push_back({FindingRule::unit, name, 0, 0, size, limits.largest_error_um, "um",
                          "too much for micrometres: nm or counts?"});
    else if (size > limits.largest_error_um)
      findings.push_back({FindingRule::range, name, 0, 0, size, limits.largest_error_um, "um",
                          "stands far from zero: a machine coordinate? TrainingPlan::error_reference = start takes it "
                          "off"});
    else if (scale.range() > 0 && scale.range() < limits.smallest_range_um &&
             scale.resolution < limits.finest_step_um && largest_rise > limits.warmed_by_K)
      findings.push_back({FindingRule::unit, name, 0, 0, scale.range(), limits.smallest_range_um, "um",
                          "too little for micrometres: name the unit, CsvOptions::units = '" + name + "=mm'"});
  }
  return findings;
}

/// Makes a `range` of one batch a `unit` where the same channel starts elsewhere at what it is in another unit: two
/// other batches at least, none of them told. One list of `findings` a batch. Allocates.
inline void compare_units(const Campaign& campaign, std::vector<std::vector<Finding>>& findings,
                          const UnitLimits& limits = {}) {
  for (std::size_t b = 0; b < campaign.size(); ++b)
    for (Finding& one : findings[b]) {
      if (one.rule != FindingRule::range) continue;
      std::vector<double> starts;
      for (std::size_t o = 0; o < campaign.size(); ++o) {
        const Index c = campaign[o].temperatures.find(one.channel);
        if (o == b || c < 0 || campaign[o].rows() == 0) continue;
        if (const double start = campaign[o].temperatures.values(0, c); start <= limits.unusual_start_degC)
          starts.push_back(start);
      }
      if (starts.size() < 2) continue;
      const auto [low, high] = std::minmax_element(starts.begin(), starts.end());
      const std::string unit =
          detail::unit_that_fits(one.figure, *low - limits.seasons_K, *high + limits.seasons_K, limits);
      if (!unit.empty()) one = detail::unit_finding(one.channel, one.figure, median(starts), unit, "in other batches");
    }
}

}  // namespace thermfit
