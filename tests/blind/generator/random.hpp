#pragma once

/// Random draws that give the same bytes with every compiler: the standard distributions do not.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace blind {

/// SplitMix64 (Steele, Lea, Flood 2014). Copies repeat the same draws.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 0x632be59bd9b4e019u) { next(); }

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
  int integer(int low, int high) { return low + static_cast<int>(next() % static_cast<unsigned>(high - low + 1)); }
  bool chance(double probability) { return uniform() < probability; }
  double sign() { return chance(.5) ? 1 : -1; }

  /// Standard normal, Box and Muller; one draw a call keeps the stream simple.
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }

  template <class T>
  const T& pick(const std::vector<T>& from) {
    return from[static_cast<std::size_t>(integer(0, static_cast<int>(from.size()) - 1))];
  }
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[next() % i]);
  }
  /// A stream of its own: what it draws leaves the others as they are.
  Random fork(std::uint64_t tag) const { return Random(state_ ^ (tag * 0xd1342543de82ef95u + 0x2545f4914f6cdd1du)); }

 private:
  std::uint64_t state_;
};

}  // namespace blind
