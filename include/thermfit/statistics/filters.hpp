#pragma once

/// Operators that turn a recorded course into the trace it would leave: first-order lag, delay, play.

#include <algorithm>
#include <cmath>

#include "thermfit/types.hpp"

namespace thermfit {

/// First-order lag tau y' = u - y from y = `start`, exact for u linear between samples. tau in s.
inline Vector low_pass(const Vector& time_s, const Vector& course, double tau_s, double start) {
  Vector result(course.size());
  double state = start;
  result(0) = state;
  for (Index k = 1; k < course.size(); ++k) {
    const double step = time_s(k) - time_s(k - 1), decay = std::exp(-step / tau_s);
    const double slope = (course(k) - course(k - 1)) / step;
    // particular solution of the ramp: u - slope tau
    state = course(k) - slope * tau_s + (state - course(k - 1) + slope * tau_s) * decay;
    result(k) = state;
  }
  return result;
}

/// The same for an input that is held from a sample to the next.
inline Vector low_pass_held(const Vector& time_s, const Vector& input, double tau_s, double start = 0) {
  Vector result(input.size());
  double state = start;
  result(0) = state;
  for (Index k = 1; k < input.size(); ++k) {
    state = input(k - 1) + (state - input(k - 1)) * std::exp(-(time_s(k) - time_s(k - 1)) / tau_s);
    result(k) = state;
  }
  return result;
}

/// y(t) = u(t - delay), linear between samples, the first value before the start; a negative delay reads ahead.
inline Vector delayed(const Vector& time_s, const Vector& course, double delay_s) {
  Vector result(course.size());
  Index after = 1;
  for (Index k = 0; k < course.size(); ++k) {
    const double t = std::min(std::max(time_s(k) - delay_s, time_s(0)), time_s(time_s.size() - 1));
    while (after + 1 < time_s.size() && time_s(after) < t) ++after;
    const double share = (t - time_s(after - 1)) / (time_s(after) - time_s(after - 1));
    result(k) = course(after - 1) + share * (course(after) - course(after - 1));
  }
  return result;
}

/// Play (backlash) of half-width r: y follows u only where it would leave [u - r, u + r]; starts at u.
inline Vector play(const Vector& course, double half_width) {
  Vector result(course.size());
  double state = course(0);
  for (Index k = 0; k < course.size(); ++k)
    result(k) = state = std::min(std::max(state, course(k) - half_width), course(k) + half_width);
  return result;
}

}  // namespace thermfit
