#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/calibration/repeats.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/error.hpp"
#include "thermfit/lazy.hpp"
#include "thermfit/network/excitation.hpp"
#include "thermfit/statistics/reading_step.hpp"
#include "thermfit/statistics/residual_noise.hpp"
#include "thermfit/statistics/white_noise.hpp"

namespace thermfit {

/// One measured channel that the simulator predicts, over all batches.
struct ObservedChannel {
  std::string name;                        ///< of the column
  bool displacement = false;               ///< um, else degC
  Index column = 0;                        ///< in Simulation::channels
  SeriesByBatch measured;                  ///< NaN where a value is missing
  std::vector<std::vector<char>> present;  ///< by batch and sample
  double swing = 0;                        ///< rms of the change since the first sample
  double floor = 0;                        ///< noise of the readings: repeats, else high frequency
  NoiseBounds bounds;                      ///< of the noise of its residual
};

/// What a campaign says about a machine: what drove each batch and what its channels read.
struct MachineRecord {
  std::vector<std::string> names;         ///< of the batches
  std::vector<Excitation> excitations;    ///< what drove each batch
  std::vector<Vector> time_s;             ///< the clock of each batch, as read
  std::vector<ObservedChannel> channels;  ///< temperatures in the machine's order, then displacements

  /// How many batches there are.
  std::size_t batches() const { return names.size(); }
};

/// A lumped machine stands for a spread one only to about this share of a channel's swing: a slow error of that size is
/// expected of every model, right or wrong, and no effect gets credit for removing it.
constexpr double lumping_tolerance = 0.01;

/// Steps of temperature-dependent heat while machines are compared (Excitation::state_step): errors of some mK, far
/// below what is expected of any model, for a tenth of the time.
constexpr double search_state_step = 0.3;

namespace detail {

/// The readings of a channel; none present where the campaign lacks it.
template <typename Scalar>
ObservedChannel readings_of(const Lazy<Campaign, Scalar>& campaign, const std::string& name, bool displacement) {
  ObservedChannel channel;
  channel.name = name;
  channel.displacement = displacement;
  double swing = 0, count = 0;
  for (const auto& batch : campaign) {
    const auto& from = displacement ? batch.errors : batch.temperatures;
    const Index found = from.find(name);
    VectorX<Scalar> series = VectorX<Scalar>::Constant(batch.rows(), std::nan(""));
    if (found >= 0) series = from.values.col(found);
    std::vector<char> present(static_cast<std::size_t>(series.size()));
    double first = std::nan("");
    for (Index k = 0; k < series.size(); ++k) {
      const bool there = std::isfinite(series(k));
      present[static_cast<std::size_t>(k)] = there;
      if (!there) continue;
      if (std::isnan(first)) first = series(k);
      swing += (series(k) - first) * (series(k) - first);
      ++count;
    }
    channel.measured.push_back(std::move(series));
    channel.present.push_back(std::move(present));
  }
  channel.swing = count > 0 ? std::sqrt(swing / count) : std::nan("");
  return channel;
}

}  // namespace detail

/// The channels of `network` that `campaign` measured. The column that gives the ambient temperature is an input, not
/// an output. Throws Error when there is none, or when a batch cannot drive the network. Allocates.
template <typename Scalar = double>
MachineRecord observations_of(const ThermalNetwork& network, const Campaign& campaign) {
  MachineRecord result;
  result.excitations = excitations_of<Scalar>(network, campaign);
  for (Excitation& one : result.excitations) one.state_step = search_state_step;
  double shortest = 1e300, longest = 0;
  for (const Batch& batch : campaign) {
    result.names.push_back(batch.name);
    result.time_s.push_back(batch.time_s);
    const double span = batch.time_s(batch.time_s.size() - 1) - batch.time_s(0);
    longest = std::max(longest, span);
    shortest = std::min(shortest, span / static_cast<double>(std::max<Index>(1, batch.time_s.size() - 1)));
  }
  const auto take = [&](const std::string& name, bool displacement, Index column) {
    ObservedChannel channel = detail::readings_of<Scalar>(campaign, name, displacement);
    if (std::isnan(channel.swing)) return;
    channel.column = column;
    channel.floor = std::max(white_noise(channel.measured), resolution_sd(channel.measured));
    channel.bounds.least_white = std::max(0.7 * channel.floor, 1e-3 * channel.swing);
    channel.bounds.least_slow = std::hypot(lumping_tolerance * channel.swing, channel.floor,
                                           repeat_sd<Scalar>(result.excitations, channel.measured));
    channel.bounds.shortest_s = 5 * shortest;
    channel.bounds.longest_s = std::max(longest / 6, 2 * channel.bounds.shortest_s);
    result.channels.push_back(std::move(channel));
  };
  for (std::size_t s = 0; s < network.sensors.size(); ++s)
    if (network.sensors[s].node >= 0) take(network.sensors[s].column, false, static_cast<Index>(s));
  for (std::size_t d = 0; d < network.displacements.size(); ++d)
    take(network.displacements[d].output, true, static_cast<Index>(network.sensors.size() + d));
  if (result.channels.empty())
    throw Error("campaign", "no channel of the machine was measured", "a sensor of a node or a displacement output",
                "check the column names in `sensors` and `displacement`");
  return result;
}

THERMFIT_COMPILED_TEMPLATE(MachineRecord observations_of<double>(const ThermalNetwork&, const Campaign&));

}  // namespace thermfit
