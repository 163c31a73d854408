#pragma once

/// A campaign laid beside what a machine file says for it: what is wrong with the data before anything is fitted.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/linearized.hpp"
#include "thermfit/calibration/machine_record.hpp"
#include "thermfit/calibration/start_tolerance.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/sides/compare_sides.hpp"
#include "thermfit/effects/setting.hpp"

namespace thermfit {

/// What `machine` says for a record beside what was measured, its calibration parameters as the belief. `machine` is
/// complete, as of with_complete_effects(); `library` must outlive the result. Throws Error as simulate() does.
/// Allocates.
template <typename Scalar = double>
Sides sides_of(const ThermalNetwork& machine, const Lazy<MachineRecord, Scalar>& seen, const EffectLibrary& library) {
  Lazy<Sides, Scalar> result;
  result.batches = seen.names;
  result.time_s = seen.time_s;
  result.largest_um_per_K = largest_expansion_um_per_K(machine);
  const Lazy<std::vector<Simulation>, Scalar> simulated = simulate<Scalar>(machine, seen.excitations, library);
  std::vector<Index> columns;
  for (const ObservedChannel& channel : seen.channels) {
    SideChannel one{channel.name, channel.displacement, channel.measured, {}, channel.floor};
    for (const Simulation& batch : simulated) one.simulated.push_back(batch.channels.col(channel.column));
    columns.push_back(channel.column);
    result.channels.push_back(std::move(one));
  }
  struct Known {
    std::vector<Parameter> parameters;
    Lazy<std::vector<Simulation>, Scalar> simulated;
  };
  auto known = std::make_shared<Known>();
  result.belief = [machine, excitations = seen.excitations, &library, columns, known](std::size_t c) {
    if (known->simulated.empty()) {
      known->parameters = calibration_parameters<Scalar>(machine, library);
      known->simulated = simulate<Scalar>(machine, excitations, library, known->parameters);
    }
    std::vector<VectorX<Scalar>> kept;
    Index rows = 0;
    for (const Simulation& batch : known->simulated) rows += batch.channels.rows();
    for (Index j = 0; j < static_cast<Index>(known->parameters.size()); ++j) {
      VectorX<Scalar> direction(rows);
      Index row = 0;
      for (const Lazy<Simulation, Scalar>& batch : known->simulated) {
        const Index n = batch.channels.rows();
        direction.segment(row, n) = batch.jacobian.col(j).segment(columns[c] * n, n);
        row += n;
      }
      direction *= known->parameters[static_cast<std::size_t>(j)].slope(0);
      if (direction.squaredNorm() > 0) kept.push_back(std::move(direction));
    }
    MatrixX<Scalar> directions(rows, static_cast<Index>(kept.size()));
    for (std::size_t j = 0; j < kept.size(); ++j) directions.col(static_cast<Index>(j)) = kept[j];
    return directions;
  };
  return result;
}

namespace detail {

/// Hypotheses about what drives a machine, which change everything that is simulated.
template <typename Scalar = double>
class DriveComparison {
 public:
  DriveComparison(const ThermalNetwork& machine, const Campaign& real, const EffectLibrary& library,
                  const SideLimits& limits)
      : machine_(machine),
        real_(real),
        library_(library),
        limits_(limits),
        given_sides_(sides(real)),
        given_(misfits(real)) {}

  /// The most probable of them, or nothing.
  std::vector<DataProblem> run() {
    all_temperatures();
    clocks();
    rooms();
    exchanged_room();
    const auto best = std::max_element(found_.begin(), found_.end(),
                                       [](const DataProblem& a, const DataProblem& b) { return a.nats < b.nats; });
    return best == found_.end() ? found_ : std::vector<DataProblem>{*best};
  }

 private:
  using Kind = DataProblem::Kind;

  Sides sides(const Campaign& campaign) const {
    return sides_of<Scalar>(machine_, observations_of<Scalar>(machine_, campaign), library_);
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

  Campaign taken(const Campaign& from, const std::vector<std::size_t>& batches) const {
    Campaign result;
    for (const std::size_t b : batches) result.push_back(from[b]);
    return result;
  }

  /// By how much the campaign written down otherwise is more probable in these batches.
  double nats(const Campaign& otherwise, const std::vector<std::size_t>& batches) const {
    const Sides with = sides(taken(otherwise, batches)), given = sides(taken(real_, batches));
    SideComparison<Scalar> otherwise_seen(with, limits_);
    if (otherwise_seen.share_left() > limits_.drive_leaves) return -1e300;  // better than nonsense is not good
    return otherwise_seen.nats_as_given() - SideComparison<Scalar>(given, limits_).nats_as_given();
  }

  bool tell(DataProblem problem, const Campaign& otherwise, const std::vector<std::size_t>& batches,
            double beside = 0) {
    if (batches.empty()) return false;
    const double gained = nats(otherwise, batches) + beside;
    if (gained < limits_.suspected_nats) return false;
    problem.certain = gained >= limits_.certain_nats;
    problem.nats = gained;
    if (batches.size() < real_.size())
      for (const std::size_t b : batches) problem.batches.push_back(real_[b].name);
    found_.push_back(std::move(problem));
    return true;
  }

  /// Seconds read as minutes and the like.
  void clocks() {
    struct Best {
      double factor = 1, misfit = 0;
    };
    for (const double factor : {60., 1000., 3600., 60000.})
      for (const bool longer : {true, false}) {
        Campaign otherwise = real_;
        for (Batch& batch : otherwise) batch.time_s *= longer ? factor : 1 / factor;
        const std::vector<std::size_t> where = better(misfits(otherwise), .7);
        DataProblem problem;
        problem.kind = Kind::clock_unit;
        problem.figure = longer ? 1 / factor : factor;
        if (tell(std::move(problem), otherwise, where)) return;
      }
  }

  std::string room() const {
    if (machine_.ambient.rule == ThermalNetwork::Ambient::Rule::column) return machine_.ambient.column;
    for (const ThermalNetwork::Sensor& sensor : machine_.sensors)
      if (sensor.node == ThermalNetwork::ambient_node) return sensor.column;
    return {};
  }

  /// The room's thermometer in another unit than the others.
  void rooms() {
    const std::string name = room();
    if (name.empty() || real_[0].temperatures.find(name) < 0) return;
    for (const Reading& reading : temperature_readings()) {
      if (reading.as_given() || reading.simulated) continue;
      Campaign otherwise = real_;
      std::vector<std::size_t> odd;
      for (std::size_t b = 0; b < otherwise.size(); ++b) {
        MatrixX<Scalar>& values = otherwise[b].temperatures.values;
        const Index column = otherwise[b].temperatures.find(name);
        std::vector<double> starts;
        for (Index c = 0; c < values.cols(); ++c)
          if (c != column && std::isfinite(values(0, c))) starts.push_back(values(0, c));
        if (starts.empty()) continue;
        std::nth_element(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(starts.size() / 2), starts.end());
        const double others = starts[starts.size() / 2], own = values(0, column);
        values.col(column) = (reading.scale * values.col(column)).array() + reading.shift;
        if (std::abs(own - others) > limits_.level_K &&
            std::abs(values(0, column) - others) < std::abs(own - others) / 4)
          odd.push_back(b);
      }
      DataProblem problem;
      problem.kind = Kind::unit;
      problem.names = {name};
      problem.unit = reading.unit;
      if (tell(std::move(problem), otherwise, odd)) return;
    }
  }

  /// The room's thermometer exchanged with another.
  void exchanged_room() {
    const std::string name = room();
    if (name.empty() || real_[0].temperatures.find(name) < 0) return;
    std::string best;
    const double channels = static_cast<double>(given_sides_.channels.size());
    double least = std::log(limits_.exchanged_room) * channels;
    const auto otherwise = [&](const std::string& other) {
      Campaign campaign = real_;
      for (Batch& batch : campaign) {
        MatrixX<Scalar>& values = batch.temperatures.values;
        const Index a = batch.temperatures.find(name), b = batch.temperatures.find(other);
        const VectorX<Scalar> kept = values.col(a);
        values.col(a) = values.col(b);
        values.col(b) = kept;
      }
      return campaign;
    };
    for (const ThermalNetwork::Sensor& sensor : machine_.sensors) {
      if (sensor.column == name || sensor.node < 0 || real_[0].temperatures.find(sensor.column) < 0) continue;
      const std::vector<double> misfit = misfits(otherwise(sensor.column));
      double gain = 0;
      for (std::size_t b = 0; b < misfit.size(); ++b) gain += misfit[b] - given_[b];
      gain /= static_cast<double>(misfit.size());
      if (gain < least) least = gain, best = sensor.column;
    }
    if (best.empty()) return;
    std::vector<std::size_t> all(real_.size());
    for (std::size_t b = 0; b < all.size(); ++b) all[b] = b;
    DataProblem problem;
    problem.kind = Kind::swapped;
    problem.names = {name, best};
    tell(std::move(problem), otherwise(best), all);
  }

  /// All thermometers in one other unit: seen by where they stand when a batch begins.
  void all_temperatures() {
    std::vector<double> starts;
    for (const Batch& batch : real_)
      for (Index c = 0; c < batch.temperatures.count(); ++c)
        if (std::isfinite(batch.temperatures.values(0, c))) starts.push_back(batch.temperatures.values(0, c));
    if (starts.empty()) return;
    std::nth_element(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(starts.size() / 2), starts.end());
    const double start = starts[starts.size() / 2];
    if (start < limits_.warmest_start_degC) return;
    const auto surprise = [&](double room_degC) {
      return .5 * std::pow((room_degC - limits_.room_degC) / limits_.room_sd_K, 2);
    };
    std::vector<std::size_t> all(real_.size());
    for (std::size_t b = 0; b < all.size(); ++b) all[b] = b;
    for (const Reading& reading : temperature_readings()) {
      const double read = reading.scale * start + reading.shift;
      if (reading.as_given() || reading.simulated || read < -10 || read > limits_.warmest_start_degC) continue;
      Campaign otherwise = real_;
      for (Batch& batch : otherwise) {
        MatrixX<Scalar>& values = batch.temperatures.values;
        values = (reading.scale * values).array() + reading.shift;
      }
      DataProblem problem;
      problem.kind = Kind::unit;
      problem.names = real_[0].temperatures.names;
      problem.unit = reading.unit;
      double channels = 0;
      for (const SideChannel& one : given_sides_.channels) channels += !one.displacement;
      const double looks = looks_per_batch * static_cast<double>(real_.size());
      tell(std::move(problem), otherwise, all,
           surprise(start) - surprise(read) + channels * looks * std::log(reading.scale));
    }
  }

  const ThermalNetwork& machine_;
  const Campaign& real_;
  const EffectLibrary& library_;
  const SideLimits limits_;
  const Sides given_sides_;
  std::vector<double> given_;
  std::vector<DataProblem> found_;
};

}  // namespace detail

/// What is wrong between a machine file and a campaign before any effect, certain and suspected: first what drives the
/// machine (clock, room, units of all thermometers), else channel by channel. `machine` as for sides_of(). Allocates.
template <typename Scalar = double>
std::vector<DataProblem> compare_machine(const ThermalNetwork& machine, const Campaign& real,
                                         const EffectLibrary& library, const SideLimits& limits = {}) {
  std::vector<DataProblem> found = detail::DriveComparison<Scalar>(machine, real, library, limits).run();
  if (std::any_of(found.begin(), found.end(), [](const DataProblem& one) { return one.certain; })) return found;
  const Sides both = sides_of<Scalar>(machine, observations_of<Scalar>(machine, real), library);
  for (DataProblem& one : compare_sides<Scalar>(both, limits)) found.push_back(std::move(one));
  return found;
}

THERMFIT_COMPILED_TEMPLATE(std::vector<DataProblem> compare_machine<double>(const ThermalNetwork&, const Campaign&,
                                                                            const EffectLibrary&, const SideLimits&));

}  // namespace thermfit
