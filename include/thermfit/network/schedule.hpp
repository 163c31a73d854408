#pragma once

/// Pieces of machine time that can be asked for, as codes; a report puts them into words.

#include <string>
#include <utility>

namespace thermfit {

/// What is done.
enum class ScheduleKind {
  speed_stair,        ///< the main input in steps up to its largest value, then off
  single_high_speed,  ///< the main input at its largest value, from cold
  cool_down,          ///< the main input at its largest value, then off for twice as long
  toggle,             ///< one input on and off, everything else held
  only,               ///< one input alone, then a pause
  idle_day,           ///< everything off while the room moves
  repeat,             ///< a batch once more
  sensor_swap         ///< two thermometers change places, then a batch once more
};

/// What a piece of machine time is asked for.
enum class SchedulePurpose {
  separates,  ///< two explanations, by a simulation of both: levels are known
  shows,      ///< an effect by itself
  locates,    ///< a gap without a name
  pins        ///< a parameter that calibration moved
};

/// One piece of machine time.
struct PlannedBlock {
  ScheduleKind kind = ScheduleKind::cool_down;       ///< what is done
  SchedulePurpose purpose = SchedulePurpose::shows;  ///< what for
  std::string subject;                               ///< the input that moves, or the thermometer that is exchanged
  std::string beside;        ///< the input that is held, or the thermometer it changes places with
  std::string batch;         ///< that is repeated
  double level = 0;          ///< largest value of the input that moves (of the one that is held, in a toggle)
  int times = 1;             ///< how often
  double machine_hours = 0;  ///< all times together
};

/// A block that shows an effect by itself.
inline PlannedBlock block_that_shows(ScheduleKind kind, std::string subject, double machine_hours) {
  PlannedBlock block;
  block.kind = kind;
  block.subject = std::move(subject);
  block.machine_hours = machine_hours;
  return block;
}

}  // namespace thermfit
