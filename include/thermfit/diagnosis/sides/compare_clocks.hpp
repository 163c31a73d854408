#pragma once

/// Clocks of two campaigns that differ before any value is looked at.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/batch/batch.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"

namespace thermfit {

namespace detail {

/// Whether a machine can be warmed, or left alone, for that long: from a quarter of an hour to four days.
inline bool is_campaign_span(double seconds) { return seconds >= 900 && seconds <= 4 * 86400.; }

}  // namespace detail

/// Clocks of the two sides in other units, or from other starts, by batch of both. Whose clock it is, where only one
/// side lasts as long as machines are watched. Allocates.
template <typename Scalar = double>
std::vector<DataProblem> compare_clocks(const Campaign& real, const Campaign& sim) {
  using Kind = DataProblem::Kind;
  std::vector<DataProblem> result;
  const auto span = [](const Batch& batch) { return batch.time_s(batch.rows() - 1) - batch.time_s(0); };
  for (const double factor : {60., 1000., 3600., 60000.})
    for (const bool longer : {true, false}) {
      std::vector<std::string> in;
      std::size_t paired = 0;
      double real_s = 0, sim_s = 0;
      for (const Batch& batch : real) {
        const auto same =
            std::find_if(sim.begin(), sim.end(), [&](const Batch& one) { return one.name == batch.name; });
        if (same == sim.end() || !batch.has_time() || !same->has_time()) continue;
        ++paired;
        const double ratio = span(*same) / span(batch), expected = longer ? factor : 1 / factor;
        const double rows = static_cast<double>(same->rows() - 1) / static_cast<double>(batch.rows() - 1);
        if (std::abs(std::log(ratio / expected)) < .1 && std::abs(std::log(rows)) < .7) {
          in.push_back(batch.name);
          real_s = span(batch), sim_s = span(*same);
        }
      }
      if (in.empty()) continue;
      DataProblem problem;
      problem.kind = Kind::clock_unit;
      const bool real_odd = !detail::is_campaign_span(real_s), sim_odd = !detail::is_campaign_span(sim_s);
      problem.side = sim_odd && !real_odd   ? DataProblem::Side::simulated
                     : real_odd && !sim_odd ? DataProblem::Side::measured
                                            : DataProblem::Side::either;
      problem.certain = true;
      problem.figure = longer != (problem.side == DataProblem::Side::measured) ? factor : 1 / factor;
      if (in.size() < paired) problem.batches = std::move(in);
      result.push_back(std::move(problem));
    }
  if (!result.empty()) return result;
  std::vector<std::string> in;
  std::vector<double> off;
  std::size_t paired = 0;
  for (const Batch& batch : real) {
    const auto same = std::find_if(sim.begin(), sim.end(), [&](const Batch& one) { return one.name == batch.name; });
    if (same == sim.end() || !batch.has_time() || !same->has_time()) continue;
    ++paired;
    const double apart = batch.time_s(0) - same->time_s(0);
    if (std::abs(apart) < std::min(span(batch), span(*same)) || std::abs(std::log(span(batch) / span(*same))) > .1)
      continue;
    in.push_back(batch.name);
    off.push_back(apart);
  }
  if (in.empty()) return result;
  DataProblem problem;
  problem.kind = Kind::clock_offset;
  problem.side = DataProblem::Side::either;
  problem.certain = true;
  problem.figure = off[0];
  problem.note = "start";
  if (in.size() < paired) problem.batches = std::move(in);
  result.push_back(std::move(problem));
  return result;
}

THERMFIT_COMPILED_TEMPLATE(std::vector<DataProblem> compare_clocks<double>(const Campaign&, const Campaign&));

}  // namespace thermfit
