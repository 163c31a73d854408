#pragma once

/// How probable a campaign is under a machine when what drives the machine was written down otherwise.

#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/sides/machine_sides.hpp"
#include "thermfit/diagnosis/sides/side_weighing.hpp"

namespace thermfit::detail {

/// Weighs hypotheses about what drives a machine, which change everything that is simulated. The arguments must outlive
/// it.
template <typename Scalar = double>
class DriveWeighing {
 public:
  DriveWeighing(const ThermalNetwork& machine, const Campaign& real, const EffectLibrary& library,
                const SideLimits& limits)
      : machine_(machine),
        real_(real),
        library_(library),
        limits_(limits),
        given_sides_(sides(real)),
        given_(misfits(real)) {}

  const Campaign& real() const { return real_; }
  const ThermalNetwork& machine() const { return machine_; }
  const SideLimits& limits() const { return limits_; }
  /// Both sides as given.
  const Sides& given_sides() const { return given_sides_; }
  /// log misfit of every batch as given.
  const std::vector<double>& given() const { return given_; }
  /// All batches.
  std::vector<std::size_t> all() const {
    std::vector<std::size_t> all(real_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }

  /// log misfit of every batch, summed over channels.
  std::vector<double> misfits(const Campaign& campaign) const {
    const Sides both = sides(campaign);
    std::vector<double> result(both.batches.size(), 0);
    for (const SideChannel& one : both.channels)
      for (std::size_t b = 0; b < both.batches.size(); ++b) {
        VectorX<Scalar> gap = one.measured[b] - one.simulated[b];
        gap = gap.array().isFinite().select(gap, 0);
        if (one.displacement) gap.array() -= gap.mean();
        result[b] += std::log(std::hypot(rms_of<Scalar>(gap), one.noise) + 1e-9);
      }
    return result;
  }

  /// Batches in which a campaign written down otherwise fits better by `least` of a log a channel.
  std::vector<std::size_t> better(const std::vector<double>& misfit, double least) const {
    std::vector<std::size_t> result;
    const double channels = static_cast<double>(machine_.sensors.size() + machine_.displacements.size());
    for (std::size_t b = 0; b < misfit.size(); ++b)
      if (misfit[b] - given_[b] < -least * channels) result.push_back(b);
    return result;
  }

  /// A problem as certain as the campaign written down otherwise is more probable in these batches; nothing where it
  /// is not.
  std::optional<DataProblem> weigh(DataProblem problem, const Campaign& otherwise,
                                   const std::vector<std::size_t>& batches, double beside = 0) const {
    if (batches.empty()) return {};
    const double gained = nats(otherwise, batches) + beside;
    if (gained < limits_.suspected_nats) return {};
    problem.certain = gained >= limits_.certain_nats;
    problem.nats = gained;
    if (batches.size() < real_.size())
      for (const std::size_t b : batches) problem.batches.push_back(real_[b].name);
    return problem;
  }

  /// The column of the room's thermometer; "" where there is none among the measured temperatures.
  std::string room() const {
    if (machine_.ambient.rule == ThermalNetwork::Ambient::Rule::column) return machine_.ambient.column;
    for (const ThermalNetwork::Sensor& sensor : machine_.sensors)
      if (sensor.node == ThermalNetwork::ambient_node) return sensor.column;
    return {};
  }

 private:
  Sides sides(const Campaign& campaign) const {
    return sides_of<Scalar>(machine_, observations_of<Scalar>(machine_, campaign), library_);
  }

  Campaign taken(const Campaign& from, const std::vector<std::size_t>& batches) const {
    Campaign result;
    for (const std::size_t b : batches) result.push_back(from[b]);
    return result;
  }

  /// By how much the campaign written down otherwise is more probable in these batches.
  double nats(const Campaign& otherwise, const std::vector<std::size_t>& batches) const {
    const Sides with = sides(taken(otherwise, batches)), given = sides(taken(real_, batches));
    SideWeighing<Scalar> otherwise_seen(with, limits_);
    if (otherwise_seen.share_left() > limits_.drive_leaves) return -1e300;  // better than nonsense is not good
    return otherwise_seen.nats_as_given() - SideWeighing<Scalar>(given, limits_).nats_as_given();
  }

  const ThermalNetwork& machine_;
  const Campaign& real_;
  const EffectLibrary& library_;
  const SideLimits limits_;
  const Sides given_sides_;
  std::vector<double> given_;
};

}  // namespace thermfit::detail
