#include "thermfit/diagnosis/judgement/closure.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

/// Two channels, one batch of 100 samples, each expected to be off by 1.
MachineRecord two_channels() {
  MachineRecord seen;
  seen.names = {"K01"};
  seen.time_s = {Vector::LinSpaced(100, 0, 9900)};
  for (const char* name : {"T1", "T2"}) {
    ObservedChannel channel;
    channel.name = name;
    channel.floor = 1;
    seen.channels.push_back(channel);
  }
  return seen;
}

/// Held-out residuals of constant size, with log scores to match.
HeldOut held(double first, double second, double first_score, double second_score) {
  HeldOut result;
  result.residual = {{Vector::Constant(100, first)}, {Vector::Constant(100, second)}};
  result.by_channel = (Vector(2) << first_score, second_score).finished();
  return result;
}

}  // namespace

TEST_CASE("an account is judged in the channels that it explains") {
  const MachineRecord seen = two_channels();
  const Closure closure = closure_of(seen, held(3, 4, 0, 0), held(1, 4, 100, 0));
  CHECK(closure.share == Approx(1));
  CHECK(closure.left == Approx(0));
}

TEST_CASE("what an account leaves where it explains counts against it") {
  const MachineRecord seen = two_channels();
  const Closure closure = closure_of(seen, held(3, 1, 0, 0), held(2, 1, 100, 0));
  CHECK(closure.share == Approx(1 - 3.0 / 8));
  CHECK(closure.left == Approx(3));
  CHECK(probability_known(closure.share, closure.left, {}) < probability_known(1, 0, {}));
}

TEST_CASE("an account of heat must close what is really open, wherever that is") {
  const MachineRecord seen = two_channels();
  // It explains T2; at T1, four times further off than a right machine would be, hardly anything.
  const HeldOut before = held(12, 3, 0, 0), after = held(11, 1, 10, 100);
  CHECK(closure_of(seen, before, after).share > 0.9);
  const Closure closure = closure_of_heat(seen, before, after, {});
  CHECK(closure.share == Approx(23.0 / 143));
  CHECK(closure.left == Approx(120));
  // What any machine may leave at a thermometer counts for nothing.
  CHECK(closure_of_heat(seen, held(2.9, 3, 0, 0), held(2.9, 1, 0, 100), {}).share == Approx(1));
}

TEST_CASE("an account that gains nothing closes nothing") {
  CHECK(closure_of(two_channels(), held(3, 3, 0, 0), held(3, 3, -5, 0)).share == 0);
}
