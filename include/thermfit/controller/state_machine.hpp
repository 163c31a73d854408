#pragma once

#include <cstdint>

namespace thermfit {

/// What the compensator is doing.
enum class CompensatorState : std::uint8_t {
  off,           ///< not started, or stopped and back at zero: offset 0
  starting,      ///< waiting for the first usable readings, or for its zero: offset held where it was taken over
  tracking,      ///< offset follows the model
  substituting,  ///< one sensor is lost: offset follows the model made without it
  holding,       ///< no demand to trust: offset held
  fallback,      ///< held too long: offset ramps to zero and waits for readings to trust
  stopping,      ///< offset ramps to zero, then off
  no_datum       ///< no zero is known and none is being taken: offset ramps to zero and stays there
};
/// How many states there are: rows of the table below.
constexpr int compensator_states = 8;

/// What can happen to it. Each step raises exactly one of the middle five; then at_zero where that is the case.
enum class CompensatorEvent : std::uint8_t {
  start,              ///< told to start, also while running
  stop,               ///< told to stop
  demand,             ///< all sensors can be trusted and the sample may be followed
  substitute_demand,  ///< all but one, and there is a substitute for that one
  no_demand,          ///< neither
  hold_expired,       ///< neither, for longer than the hold time-out
  no_zero,            ///< what the demand would be relative to is not known
  at_zero             ///< every offset is zero
};
/// How many events there are: columns of the table below.
constexpr int compensator_events = 8;

/// The state after `event`. This table is the whole behaviour; rows are states, columns events, in the order above.
constexpr CompensatorState next_state(CompensatorState state, CompensatorEvent event) noexcept {
  using S = CompensatorState;
  // clang-format off
  constexpr S table[compensator_states][compensator_events] = {
    //                  start        stop         demand       substitute_demand  no_demand    hold_expired  no_zero      at_zero
    /* off          */ {S::starting, S::off,      S::off,      S::off,            S::off,      S::off,       S::off,      S::off},
    /* starting     */ {S::starting, S::stopping, S::tracking, S::substituting,   S::starting, S::fallback,  S::no_datum, S::starting},
    /* tracking     */ {S::starting, S::stopping, S::tracking, S::substituting,   S::holding,  S::fallback,  S::no_datum, S::tracking},
    /* substituting */ {S::starting, S::stopping, S::tracking, S::substituting,   S::holding,  S::fallback,  S::no_datum, S::substituting},
    /* holding      */ {S::starting, S::stopping, S::tracking, S::substituting,   S::holding,  S::fallback,  S::no_datum, S::holding},
    /* fallback     */ {S::starting, S::stopping, S::tracking, S::substituting,   S::fallback, S::fallback,  S::no_datum, S::fallback},
    /* stopping     */ {S::starting, S::stopping, S::stopping, S::stopping,       S::stopping, S::stopping,  S::stopping, S::off},
    /* no_datum     */ {S::starting, S::stopping, S::tracking, S::substituting,   S::no_datum, S::no_datum,  S::no_datum, S::no_datum},
  };
  // clang-format on
  return table[static_cast<int>(state)][static_cast<int>(event)];
}

/// Where the offset goes.
enum class OffsetTarget : std::uint8_t {
  demand,  ///< it follows the model
  rest,    ///< it stays where it is
  zero     ///< it ramps to zero
};

/// Where the offset goes in `state`.
constexpr OffsetTarget offset_target(CompensatorState state) noexcept {
  using S = CompensatorState;
  if (state == S::tracking || state == S::substituting) return OffsetTarget::demand;
  return state == S::starting || state == S::holding ? OffsetTarget::rest : OffsetTarget::zero;
}

}  // namespace thermfit
