#pragma once

/// What is wrong between a machine file and a campaign before anything is fitted.

#include <algorithm>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/sides/compare_sides.hpp"
#include "thermfit/diagnosis/sides/drive_clock.hpp"
#include "thermfit/diagnosis/sides/drive_room.hpp"
#include "thermfit/diagnosis/sides/drive_temperatures.hpp"

namespace thermfit {
namespace detail {

/// The most probable fault of what drives a machine, or nothing.
template <typename Scalar = double>
std::vector<DataProblem> compare_drives(const ThermalNetwork& machine, const Campaign& real,
                                        const EffectLibrary& library, const SideLimits& limits) {
  const DriveWeighing<Scalar> of(machine, real, library, limits);
  std::vector<DataProblem> found;
  for (auto* one : {temperatures_unit<Scalar>, drive_clock<Scalar>, room_unit<Scalar>, exchanged_room<Scalar>})
    for (DataProblem& problem : one(of)) found.push_back(std::move(problem));
  const auto best = std::max_element(found.begin(), found.end(),
                                     [](const DataProblem& a, const DataProblem& b) { return a.nats < b.nats; });
  return best == found.end() ? found : std::vector<DataProblem>{*best};
}

}  // namespace detail

/// What is wrong between a machine file and a campaign before any effect, certain and suspected: first what drives the
/// machine (clock, room, units of all thermometers), else channel by channel. `machine` as for sides_of(). Allocates.
template <typename Scalar = double>
std::vector<DataProblem> compare_machine(const ThermalNetwork& machine, const Campaign& real,
                                         const EffectLibrary& library, const SideLimits& limits = {}) {
  std::vector<DataProblem> found = detail::compare_drives<Scalar>(machine, real, library, limits);
  if (std::any_of(found.begin(), found.end(), [](const DataProblem& one) { return one.certain; })) return found;
  const Sides both = sides_of<Scalar>(machine, observations_of<Scalar>(machine, real), library);
  for (DataProblem& one : compare_sides<Scalar>(both, limits)) found.push_back(std::move(one));
  return found;
}

THERMFIT_COMPILED_TEMPLATE(std::vector<DataProblem> compare_machine<double>(const ThermalNetwork&, const Campaign&,
                                                                            const EffectLibrary&, const SideLimits&));

}  // namespace thermfit
