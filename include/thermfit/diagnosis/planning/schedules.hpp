#pragma once

/// The menu of experiments a machine can be asked for, as the excitation a simulation needs.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/calibration/machine_record.hpp"
#include "thermfit/constants.hpp"
#include "thermfit/network/schedule.hpp"
#include "thermfit/statistics/held_levels.hpp"

namespace thermfit {

/// A piece of machine time with what would drive the machine in it.
struct Schedule {
  PlannedBlock block;     ///< hours of one run
  Excitation excitation;  ///< of the same run
};

namespace detail {

/// Schedules for one machine: inputs by the range in which the campaign used them, durations in units of its batches.
template <typename Scalar = double>
class Menu {
 public:
  Menu(const ThermalNetwork& network, const MachineRecord& seen) : network_(network), seen_(seen) {
    const Excitation& first = seen.excitations[0];
    largest_.assign(first.input_names.size(), 0);
    held_.assign(first.input_names.size(), {});
    std::vector<double> spans, rooms;
    for (const Excitation& one : seen.excitations) {
      spans.push_back(one.time_s(one.samples() - 1));
      const VectorX<Scalar>& room_degC = one.ambient_degC;
      rooms.push_back(room_degC.mean());
      for (std::size_t i = 0; i < largest_.size(); ++i) {
        const MatrixX<Scalar>& inputs = one.inputs;
        const VectorX<Scalar> column = inputs.col(static_cast<Index>(i));
        largest_[i] = std::max(largest_[i], column.cwiseAbs().maxCoeff());
        count_held(held_[i], column);
      }
    }
    std::sort(spans.begin(), spans.end());
    std::sort(rooms.begin(), rooms.end());
    span_s_ = spans[spans.size() / 2];
    room_degC_ = rooms[rooms.size() / 2];
    double most_W = -1;
    for (const ThermalNetwork::HeatSource& source : network.heat_sources) {
      const Index input = first.find_input(source.input);
      if (input >= 0 && source.power_W > most_W) {
        most_W = source.power_W;
        main_ = input;
      }
    }
  }

  std::vector<Schedule> all() const {
    std::vector<Schedule> menu;
    const double top = main_ >= 0 ? largest_[static_cast<std::size_t>(main_)] : 0;
    if (top > 0) {
      const std::string& speed = input_name(main_);
      menu.push_back(planned({ScheduleKind::speed_stair, separates, speed, "", "", top, 1, 0}, 1.25,
                             [&](Index input, double share) {
                               return input == main_ && share < .8 ? top * .25 * std::floor(1 + 5 * share) : 0.;
                             }));
      menu.push_back(planned({ScheduleKind::single_high_speed, separates, speed, "", "", top, 1, 0}, .75,
                             [&](Index input, double) { return input == main_ ? top : 0.; }));
      menu.push_back(planned({ScheduleKind::cool_down, separates, speed, "", "", top, 1, 0}, 1.5,
                             [&](Index input, double share) { return input == main_ && share < 1. / 3 ? top : 0.; }));
      for (Index other = 0; other < static_cast<Index>(largest_.size()); ++other)
        if (other != main_ && largest_[static_cast<std::size_t>(other)] != 0 &&
            is_set(held_[static_cast<std::size_t>(other)]))
          menu.push_back(of_another(other, top));
    }
    menu.push_back(planned(
        {ScheduleKind::idle_day, separates, "", "", "", 0, 1, 0}, 4, [](Index, double) { return 0.; }, room_swing_K));
    if (!seen_.excitations.empty())
      menu.push_back(again({ScheduleKind::repeat, separates, "", "", seen_.names[0], 0, 1, 0}, seen_.excitations[0]));
    return menu;
  }

  /// A batch of the campaign once more.
  static Schedule again(PlannedBlock block, const Excitation& batch) {
    block.machine_hours = batch.time_s(batch.samples() - 1) / 3600;
    return {std::move(block), batch};
  }

 private:
  static constexpr SchedulePurpose separates = SchedulePurpose::separates;
  static constexpr double room_swing_K = 3;  ///< either way, on an idle day

  /// An on-off input toggled while the main one runs at half; any other alone.
  Schedule of_another(Index other, double top) const {
    const double level = largest_[static_cast<std::size_t>(other)];
    if (level <= 1)
      return planned({ScheduleKind::toggle, separates, input_name(other), input_name(main_), "", top, 1, 0}, 1,
                     [&](Index input, double share) {
                       if (input == other) return static_cast<int>(6 * share) % 2 ? level : 0.;
                       return input == main_ ? .5 * top : 0.;
                     });
    return planned({ScheduleKind::only, separates, input_name(other), "", "", level, 1, 0}, 1,
                   [&](Index input, double share) { return input == other && share < 2. / 3 ? level : 0.; });
  }

  template <class Level>
  Schedule planned(PlannedBlock block, double spans, Level level, double swing_K = 0) const {
    return again(std::move(block), excitation(spans, level, swing_K));
  }

  const std::string& input_name(Index input) const {
    return seen_.excitations[0].input_names[static_cast<std::size_t>(input)];
  }

  /// From rest at room temperature; `level(input, share of the duration)`.
  template <class Level>
  Excitation excitation(double spans, Level level, double swing_K) const {
    constexpr Index samples = 121;
    Excitation result;
    result.batch = "planned";
    const VectorX<Scalar> time_s = VectorX<Scalar>::LinSpaced(samples, 0, spans * span_s_);
    result.time_s = time_s;
    result.input_names = seen_.excitations[0].input_names;
    result.inputs.resize(samples, static_cast<Index>(largest_.size()));
    for (Index k = 0; k < samples; ++k)
      for (Index i = 0; i < result.inputs.cols(); ++i)
        result.inputs(k, i) = level(i, static_cast<double>(k) / static_cast<double>(samples));
    result.measured_ambient_degC = room_degC_ + swing_K * (2 * pi * time_s.array() / time_s(samples - 1)).sin();
    const bool held = network_.ambient.rule != ThermalNetwork::Ambient::Rule::column;
    result.ambient_degC = result.measured_ambient_degC;
    if (held) result.ambient_degC = VectorX<Scalar>::Constant(samples, room_degC_);
    if (seen_.excitations[0].measured_ambient_degC.size() == 0) result.measured_ambient_degC.resize(0);
    result.start_degC = VectorX<Scalar>::Constant(network_.node_count(), room_degC_);
    result.start_sensors.resize(static_cast<std::size_t>(network_.node_count()));
    return result;
  }

  const ThermalNetwork& network_;
  const MachineRecord& seen_;
  std::vector<double> largest_;
  std::vector<HeldLevels> held_;
  double span_s_ = 0, room_degC_ = 20;
  Index main_ = -1;
};

}  // namespace detail

/// `network` with the thermometers of `schedule` exchanged: a fault goes with its thermometer to the other's place.
inline ThermalNetwork with_swap(ThermalNetwork network, const Schedule& schedule) {
  if (schedule.block.kind != ScheduleKind::sensor_swap) return network;
  for (ThermalNetwork::AddedEffect& added : network.effects)
    if (added.location == schedule.block.subject)
      added.location = schedule.block.beside;
    else if (added.location == schedule.block.beside)
      added.location = schedule.block.subject;
  return network;
}

/// For every thermometer among `suspects`: a batch repeated after it has changed places with another node's.
template <typename Scalar = double>
std::vector<Schedule> sensor_swaps(const ThermalNetwork& network, const MachineRecord& seen,
                                   const std::vector<std::string>& suspects) {
  std::vector<Schedule> result;
  for (const ThermalNetwork::Sensor& own : network.sensors) {
    if (own.node < 0 || std::find(suspects.begin(), suspects.end(), own.column) == suspects.end()) continue;
    for (const ThermalNetwork::Sensor& other : network.sensors) {
      if (other.node < 0 || other.node == own.node) continue;
      if (std::find(suspects.begin(), suspects.end(), other.column) != suspects.end()) continue;
      result.push_back(detail::Menu<Scalar>::again(
          {ScheduleKind::sensor_swap, SchedulePurpose::separates, own.column, other.column, seen.names[0], 0, 1, 0},
          seen.excitations[0]));
      break;
    }
  }
  return result;
}

/// Speed stair, single high speed, cool-down, the other inputs alone or toggled, idle day, repeat; those that the
/// campaign's inputs allow. Needs one batch at least.
template <typename Scalar = double>
std::vector<Schedule> experiment_menu(const ThermalNetwork& network, const MachineRecord& seen) {
  return detail::Menu<Scalar>(network, seen).all();
}

}  // namespace thermfit
