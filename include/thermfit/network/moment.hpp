#pragma once

#include <functional>

#include "thermfit/network/room_history.hpp"

namespace thermfit {

/// What a law may look at: the machine and its surroundings at one moment of one batch.
///
/// Points into the simulation and is valid only during the call of the law. `temperature_degC` is null for laws that
/// are held over a step (heat and conductance driven by inputs), which must not depend on the state.
struct Moment {
  double time_s = 0;                              ///< since the first sample of the batch
  double ambient_degC = 0;                        ///< what the network takes as ambient now, effects on it included
  double first_ambient_degC = 0;                  ///< the same at the first sample
  double measured_ambient_degC = 0;               ///< the reading of the ambient sensor, where the batch has one
  double first_measured_ambient_degC = 0;         ///< at the first sample
  const RoomHistory* ambient = nullptr;           ///< the course of ambient_degC over the batch
  const RoomHistory* measured_ambient = nullptr;  ///< and of measured_ambient_degC
  const double* first_reading_degC =
      nullptr;                               ///< of every sensor, NaN where there is none; null where nothing is known
  double reading_degC = 0;                   ///< what the sensor would read, for laws of readings
  const double* inputs = nullptr;            ///< values of the batch's input columns, held since the last sample
  const double* temperature_degC = nullptr;  ///< of every node
};

/// A law of an effect: a number (W, W/K, um, K: as the hook says) at a moment, given the effect's own parameters.
/// Derivatives are taken by central differences of the law, so it should be smooth where it can.
using Law = std::function<double(const Moment&, const double* parameters)>;

}  // namespace thermfit
