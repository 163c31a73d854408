#pragma once

#include <cstdint>

#include "thermfit/controller/state_machine.hpp"

namespace thermfit {

/// Where a zero comes from.
enum class ZeroSource : std::uint8_t {
  none,     ///< there is none
  first,    ///< the first samples after the start
  datum,    ///< the samples after the work offset was probed
  retained  ///< kept from before a power cycle
};

/// Why a sensor is not used.
enum class SensorFault : std::uint8_t {
  none,          ///< it is used
  not_finite,    ///< NaN or infinite
  range,         ///< outside the readings that make sense for it
  rate,          ///< changed faster than it can since it was last trusted
  stuck,         ///< has not changed for longer than it rests, or while the others moved
  recovering,    ///< was lost, reads well again, not yet for long enough
  no_reference,  ///< was lost when the zero was taken; needs a datum
  stale,         ///< the heartbeat stopped: old readings repeated
  disagrees      ///< was lost, reads well again, but not what the others say
};

/// The status of one step in one 32-bit word, the same for every target:
///
/// | bits  | meaning |
/// |-------|---------|
/// | 0–3   | CompensatorState |
/// | 4     | the sample lies outside the training domain |
/// | 5     | the demand was clamped |
/// | 6     | the offset is on its way: slew limited |
/// | 7     | the settings are faulty: start was refused |
/// | 8–15  | number of the first sensor not used, counted from 1; 0 none |
/// | 16–19 | SensorFault of that sensor |
/// | 20–27 | how many sensors are not used |
/// | 28–29 | ZeroSource: where the zero comes from |
/// | 30    | a zero was asked for and is not there yet |
/// | 31    | a probe's reading corrects the demand |
struct CompensatorStatus {
  std::uint32_t word = 0;  ///< the bits of the table above

  static constexpr std::uint32_t outside_domain_bit = 1u << 4;  ///< bit 4 of the word
  static constexpr std::uint32_t clamped_bit = 1u << 5;         ///< bit 5 of the word
  static constexpr std::uint32_t slewing_bit = 1u << 6;         ///< bit 6 of the word
  static constexpr std::uint32_t bad_settings_bit = 1u << 7;    ///< bit 7 of the word

  static constexpr std::uint32_t zero_pending_bit = 1u << 30;  ///< bit 30 of the word
  static constexpr std::uint32_t probed_bit = 1u << 31;        ///< bit 31 of the word

  /// What the compensator does: bits 0–3.
  constexpr CompensatorState state() const noexcept { return static_cast<CompensatorState>(word & 15u); }
  /// Whether the sample lies outside the training domain.
  constexpr bool outside_domain() const noexcept { return (word & outside_domain_bit) != 0; }
  /// Whether the demand was clamped.
  constexpr bool clamped() const noexcept { return (word & clamped_bit) != 0; }
  /// Whether the offset is on its way, slew limited.
  constexpr bool slewing() const noexcept { return (word & slewing_bit) != 0; }
  /// Whether start was refused for faulty settings.
  constexpr bool bad_settings() const noexcept { return (word & bad_settings_bit) != 0; }
  /// Number of the first sensor not used, counted from 1; 0 none.
  constexpr int sensor() const noexcept { return static_cast<int>(word >> 8 & 255u); }
  /// Why that sensor is not used.
  constexpr SensorFault fault() const noexcept { return static_cast<SensorFault>(word >> 16 & 15u); }
  /// How many sensors are not used; 255 for more.
  constexpr int unused_sensors() const noexcept { return static_cast<int>(word >> 20 & 255u); }
  /// Where the zero comes from.
  constexpr ZeroSource zero_source() const noexcept { return static_cast<ZeroSource>(word >> 28 & 3u); }
  /// Whether a zero was asked for and is not there yet.
  constexpr bool zero_pending() const noexcept { return (word & zero_pending_bit) != 0; }
  /// Whether a probe's reading corrects the demand.
  constexpr bool probed() const noexcept { return (word & probed_bit) != 0; }

  /// The part of the word that tells about sensors. Numbers above 255 read 255.
  static constexpr std::uint32_t sensor_bits(std::uint32_t first, SensorFault fault, std::uint32_t count) noexcept {
    return (first < 255u ? first : 255u) << 8 | static_cast<std::uint32_t>(fault) << 16 |
           (count < 255u ? count : 255u) << 20;
  }
};

}  // namespace thermfit
