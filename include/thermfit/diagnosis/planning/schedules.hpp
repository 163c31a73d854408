#pragma once

/// The menu of experiments a machine can be asked for, as the excitation a simulation needs.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/calibration/machine_record.hpp"
#include "thermfit/number.hpp"

namespace thermfit {

struct Schedule {
  std::string name;  ///< "speed stair", "cool-down", …
  std::string how;   ///< settings in words
  Excitation excitation;
  std::string swapped, with;  ///< sensors that change places; empty: none

  double hours() const { return excitation.time_s(excitation.samples() - 1) / 3600; }
};

namespace detail {

/// Schedules for one machine: inputs by the range in which the campaign used them, durations in units of its batches.
class Menu {
 public:
  Menu(const ThermalNetwork& network, const MachineRecord& seen) : network_(network), seen_(seen) {
    const Excitation& first = seen.excitations[0];
    largest_.assign(first.input_names.size(), 0);
    varies_.assign(first.input_names.size(), false);
    std::vector<double> spans, rooms;
    for (const Excitation& one : seen.excitations) {
      spans.push_back(one.time_s(one.samples() - 1));
      rooms.push_back(one.ambient_degC.mean());
      for (std::size_t i = 0; i < largest_.size(); ++i) {
        const Vector column = one.inputs.col(static_cast<Index>(i));
        largest_[i] = std::max(largest_[i], column.cwiseAbs().maxCoeff());
        varies_[i] = varies_[i] || column.maxCoeff() > column.minCoeff();
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
    const auto add = [&](const std::string& name, const std::string& how, double spans, auto level,
                         double swing_K = 0) {
      menu.push_back({name, how, excitation(spans, level, swing_K), "", ""});
    };
    const double top = main_ >= 0 ? largest_[static_cast<std::size_t>(main_)] : 0;
    if (top > 0) {
      const std::string speed = input_name(main_), most = general_text(top, 5);
      add("speed stair", speed + " at 25, 50, 75 and 100 % of " + most + ", then 0", 1.25,
          [&](Index input, double share) {
            return input == main_ && share < .8 ? top * .25 * std::floor(1 + 5 * share) : 0.;
          });
      add("single high speed", speed + " at " + most + " from cold", .75,
          [&](Index input, double) { return input == main_ ? top : 0.; });
      add("cool-down", speed + " at " + most + ", then 0 for twice as long", 1.5,
          [&](Index input, double share) { return input == main_ && share < 1. / 3 ? top : 0.; });
      for (Index other = 0; other < static_cast<Index>(largest_.size()); ++other) {
        const double level = largest_[static_cast<std::size_t>(other)];
        if (other == main_ || level == 0) continue;
        const std::string word = input_name(other);
        if (level <= 1)
          add(word + " toggle", speed + " at half of " + most + ", " + word + " on and off in six equal pieces", 1,
              [&, other, level](Index input, double share) {
                if (input == other) return static_cast<int>(6 * share) % 2 ? level : 0.;
                return input == main_ ? .5 * top : 0.;
              });
        else
          add(word + " only", word + " at " + general_text(level, 5) + ", everything else off, then a pause", 1,
              [&, other, level](Index input, double share) { return input == other && share < 2. / 3 ? level : 0.; });
      }
    }
    add(
        "idle day", "everything off while the room swings by 6 K", 4, [](Index, double) { return 0.; }, 3);
    if (!seen_.excitations.empty())
      menu.push_back({"repeat", "batch " + seen_.names[0] + " once more", seen_.excitations[0], "", ""});
    return menu;
  }

 private:
  const std::string& input_name(Index input) const {
    return seen_.excitations[0].input_names[static_cast<std::size_t>(input)];
  }

  /// From rest at room temperature; `level(input, share of the duration)`.
  template <class Level>
  Excitation excitation(double spans, Level level, double swing_K) const {
    constexpr Index samples = 121;
    Excitation result;
    result.batch = "planned";
    result.time_s = Vector::LinSpaced(samples, 0, spans * span_s_);
    result.input_names = seen_.excitations[0].input_names;
    result.inputs.resize(samples, static_cast<Index>(largest_.size()));
    for (Index k = 0; k < samples; ++k)
      for (Index i = 0; i < result.inputs.cols(); ++i)
        result.inputs(k, i) = level(i, static_cast<double>(k) / static_cast<double>(samples));
    result.measured_ambient_degC =
        room_degC_ + swing_K * (2 * 3.14159265358979 * result.time_s.array() / result.time_s(samples - 1)).sin();
    const bool held = network_.ambient.rule != ThermalNetwork::Ambient::Rule::column;
    result.ambient_degC = held ? Vector::Constant(samples, room_degC_) : result.measured_ambient_degC;
    if (seen_.excitations[0].measured_ambient_degC.size() == 0) result.measured_ambient_degC.resize(0);
    result.start_degC = Vector::Constant(network_.node_count(), room_degC_);
    result.start_sensors.resize(static_cast<std::size_t>(network_.node_count()));
    return result;
  }

  const ThermalNetwork& network_;
  const MachineRecord& seen_;
  std::vector<double> largest_;
  std::vector<bool> varies_;
  double span_s_ = 0, room_degC_ = 20;
  Index main_ = -1;
};

}  // namespace detail

/// `network` with the thermometers of `schedule` exchanged: a fault goes with its thermometer to the other's place.
inline ThermalNetwork with_swap(ThermalNetwork network, const Schedule& schedule) {
  for (ThermalNetwork::AddedEffect& added : network.effects)
    if (added.location == schedule.swapped)
      added.location = schedule.with;
    else if (added.location == schedule.with)
      added.location = schedule.swapped;
  return network;
}

/// For every thermometer among `suspects`: a batch repeated after it has changed places with another node's.
inline std::vector<Schedule> sensor_swaps(const ThermalNetwork& network, const MachineRecord& seen,
                                          const std::vector<std::string>& suspects) {
  std::vector<Schedule> result;
  for (const ThermalNetwork::Sensor& own : network.sensors) {
    if (own.node < 0 || std::find(suspects.begin(), suspects.end(), own.column) == suspects.end()) continue;
    for (const ThermalNetwork::Sensor& other : network.sensors) {
      if (other.node < 0 || other.node == own.node) continue;
      if (std::find(suspects.begin(), suspects.end(), other.column) != suspects.end()) continue;
      result.push_back({"sensor swap",
                        "exchange " + own.column + " and " + other.column + ", then batch " + seen.names[0] +
                            " once more: a faulty thermometer takes its fault along",
                        seen.excitations[0], own.column, other.column});
      break;
    }
  }
  return result;
}

/// Speed stair, single high speed, cool-down, the other inputs alone or toggled, idle day, repeat; those that the
/// campaign's inputs allow. Needs one batch at least.
inline std::vector<Schedule> experiment_menu(const ThermalNetwork& network, const MachineRecord& seen) {
  return detail::Menu(network, seen).all();
}

}  // namespace thermfit
