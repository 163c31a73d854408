#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>

/// Readings and commands as bad as they come, the same on every machine: integers and exact conversions only.

namespace random_walk {

/// Marsaglia's xorshift, 32 bits.
class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed) {}
  std::uint32_t below(std::uint32_t bound) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return (state_ >> 8) % bound;
  }

 private:
  std::uint32_t state_;
};

/// What a sensor is up to for a while.
enum class Mood : std::uint32_t { well, stuck, not_a_number, infinite, denormal, huge, jumped, out_of_range, moods };

template <class Scalar>
struct Sensor {
  std::int32_t hundredths = 2000;  // true temperature, 0.01 degC
  std::int32_t goal = 2600;        // where it drifts to for a while
  Mood mood = Mood::well;
  std::uint32_t left = 0;
  Scalar last = 20;

  Scalar read(Random& random) {
    if (random.below(3000) == 0) goal = 1900 + static_cast<std::int32_t>(random.below(1200));
    hundredths += static_cast<std::int32_t>(random.below(21)) - 10 + (hundredths < goal) - (hundredths > goal);
    if (left-- == 0) {
      const bool ill = random.below(4) == 0;
      mood = ill ? static_cast<Mood>(random.below(static_cast<std::uint32_t>(Mood::moods))) : Mood::well;
      left = ill ? 1 + random.below(random.below(3) == 0 ? 200 : 8) : 20 + random.below(300);
    }
    using Limits = std::numeric_limits<Scalar>;
    const Scalar truth = static_cast<Scalar>(hundredths) / 100;
    switch (mood) {
      case Mood::stuck:
        return last;
      case Mood::not_a_number:
        return Limits::quiet_NaN();
      case Mood::infinite:
        return random.below(2) ? Limits::infinity() : -Limits::infinity();
      case Mood::denormal:
        return Limits::denorm_min() * static_cast<Scalar>(1 + random.below(1000));
      case Mood::huge:
        return random.below(2) ? Limits::max() : Limits::lowest();
      case Mood::jumped:
        return last = truth + 8;
      case Mood::out_of_range:
        return 200;
      default:
        return last = truth;
    }
  }
};

/// FNV-1a over the bits of values: equal hashes mean equal bits.
class Hash {
 public:
  template <class Value>
  void add(Value value) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (unsigned char byte : bytes) state_ = (state_ ^ byte) * 16777619u;
  }
  std::uint32_t value() const { return state_; }

 private:
  std::uint32_t state_ = 2166136261u;
};

/// Runs `steps` of a compensator with any interface: `subject` has start(), start(offsets), start(offsets, zero),
/// stop(), datum(), probe(error, measured) and step(readings, periods, heartbeat); after each step `look()` is called.
template <class Scalar, std::size_t Sensors, std::size_t Errors, class Subject, class Look>
void run(Subject& subject, std::uint32_t steps, Look look) {
  Random random(2463534242u);
  std::array<Sensor<Scalar>, Sensors> sensors{};
  std::array<Scalar, Sensors> readings{}, zero{};
  std::array<Scalar, Errors> offsets{};
  std::uint32_t heartbeat = 0, silence = 0;  // the second half of the way has a heartbeat
  subject.start();
  for (std::uint32_t n = 0; n < steps; ++n) {
    const std::uint32_t command = random.below(5000);
    if (command >= 10 && command < 13) subject.datum();
    if (silence > 0)
      --silence;
    else if (n >= steps / 2)
      ++heartbeat;
    if (command >= 13 && command < 18) silence = random.below(30);
    const std::uint32_t lateness = random.below(1000);
    const std::uint32_t periods = lateness < 990 ? 1 : lateness < 995 ? 0 : random.below(20);
    if (command >= 18 && command < 30)
      subject.probe(command % Errors, static_cast<Scalar>(static_cast<std::int32_t>(random.below(4000)) - 2000) / 100);
    if (command == 30) subject.probe(0, std::numeric_limits<Scalar>::quiet_NaN());
    if (command == 0) subject.stop();
    if (command > 0 && command < 6) subject.start();
    if (command >= 6 && command < 10) {
      for (Scalar& offset : offsets) offset = static_cast<Scalar>(random.below(2000)) / 10 - 100;
      if (command == 9) offsets[0] = std::numeric_limits<Scalar>::quiet_NaN();
      for (Scalar& value : zero) value = static_cast<Scalar>(1900 + random.below(200)) / 100;
      if (command == 7) subject.start(offsets, zero);
      if (command != 7) subject.start(offsets);
    }
    for (std::size_t i = 0; i < Sensors; ++i) readings[i] = sensors[i].read(random);
    subject.step(readings, periods, heartbeat);
    look();
  }
}

}  // namespace random_walk
