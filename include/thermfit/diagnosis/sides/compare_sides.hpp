#pragma once

/// What is wrong between two sides before any effect: units, signs, exchanged and copied columns, clocks, zeros.

#include <algorithm>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/sides/compare_copies.hpp"
#include "thermfit/diagnosis/sides/compare_datums.hpp"
#include "thermfit/diagnosis/sides/compare_delays.hpp"
#include "thermfit/diagnosis/sides/compare_displacements.hpp"
#include "thermfit/diagnosis/sides/compare_places.hpp"
#include "thermfit/diagnosis/sides/compare_temperatures.hpp"

namespace thermfit {
namespace detail {

/// Adds problems, joined with ones that differ in the channel only.
inline void join_problems(std::vector<DataProblem>& found, std::vector<DataProblem> more) {
  for (DataProblem& problem : more) {
    const auto same = std::find_if(found.begin(), found.end(), [&](const DataProblem& one) {
      return problem.kind == DataProblem::Kind::unit && one.kind == problem.kind && one.side == problem.side &&
             one.unit == problem.unit && one.certain == problem.certain && one.batches == problem.batches;
    });
    if (same == found.end())
      found.push_back(std::move(problem));
    else
      same->names.insert(same->names.end(), problem.names.begin(), problem.names.end());
  }
}

}  // namespace detail

/// What is wrong between the sides, certain and suspected. Nothing where they are written down alike, whatever the
/// simulator lacks. Allocates.
template <typename Scalar = double>
std::vector<DataProblem> compare_sides(const Sides& sides, const SideLimits& limits = {}) {
  detail::SideWeighing<Scalar> of(sides, limits);
  std::vector<DataProblem> found;
  const auto join = [&](std::vector<DataProblem> more) { detail::join_problems(found, std::move(more)); };
  for (std::size_t c = 0; c < sides.channels.size(); ++c)
    join(sides.channels[c].displacement ? detail::DisplacementUnits<Scalar>(of).run(c)
                                        : detail::TemperatureUnits<Scalar>(of).run(c));
  if (std::any_of(found.begin(), found.end(), [](const DataProblem& one) { return one.certain; })) return found;
  join(detail::CopiedColumns<Scalar>(of).run(false));
  if (found.empty()) join(detail::ExchangedColumns<Scalar>(of).run());
  if (found.empty() && !sides.computed) join(detail::CopiedColumns<Scalar>(of).run(true));
  join(detail::Delays<Scalar>(of).run());
  for (std::size_t c = 0; c < sides.channels.size(); ++c) join(detail::Datums<Scalar>(of).run(c));
  return found;
}

THERMFIT_COMPILED_TEMPLATE(std::vector<DataProblem> compare_sides<double>(const Sides&, const SideLimits&));

}  // namespace thermfit
