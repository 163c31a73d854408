#include "thermfit/controller/compensator.hpp"

#include <cmath>
#include <set>
#include <utility>

#include "controller/example_model.hpp"
#include "embedded/random_walk.hpp"
#include "support/catch.hpp"

using namespace thermfit;
using State = CompensatorState;

namespace {

const double nan_degC = std::nan("");

struct Bench {
  using Device = Compensator<double, 3, 2, 2>;
  Device::Model model = narrow_model<double, 3, 2, 2>(example_model());
  Device::Settings settings;
  Device device{model, settings};

  Bench() {
    for (auto& sensor : settings.sensors) {
      sensor = {};
      sensor.lowest_degC = 0;
      sensor.highest_degC = 60;
      sensor.largest_step_K = 2;
    }
    settings.patience = {3, 4, 1, 0};
    settings.zero = {ZeroPolicy::first, 3, false};
    settings.hold_steps = 5;
    settings.outputs = {{{50, 1}, {20, 1}}};
  }
  CompensatorStatus step(double a, double b, double c, int times = 1) {
    for (int i = 0; i < times; ++i) device.step({a, b, c});
    return device.status();
  }
  /// Starts, and takes its zero at these readings.
  void start(double a = 20, double b = 20, double c = 20) {
    device.start();
    step(a, b, c, 3);
    REQUIRE(device.status().zero_source() == ZeroSource::first);
  }
  /// The zero that sensors have, as if kept from before a power cycle.
  Device::Retained zero(double a, double b, double c) const {
    Device::Retained kept;
    kept.zero_degC = {a, b, c};
    kept.seal(model.identity);
    return kept;
  }
  /// What the state machine says, and which sensors, without where the zero is from.
  std::uint32_t word() const { return device.status().word & 0x0fffffffu; }
  double z() const { return device.offset_um()[1]; }
  /// The correction the model asks for at this rise, all sensors well.
  double wanted(double a, double b, double c) const {
    return -model.equation.predict(1, std::array<double, 3>{a, b, c});
  }
};

}  // namespace

TEST_CASE("the offset becomes the negative predicted error of the rise since its zero", "[controller]") {
  Bench bench;
  REQUIRE(bench.device.start());
  CHECK(bench.step(21, 22, 23, 2).state() == State::starting);
  CHECK(bench.device.status().zero_pending());
  CHECK(bench.step(21, 22, 23).state() == State::tracking);
  CHECK(bench.z() == -1);  // the model's intercept, at rise 0
  bench.step(22, 23, 23, 10);
  CHECK(bench.word() == static_cast<std::uint32_t>(State::tracking));
  CHECK(bench.z() == bench.wanted(1, 1, 0));
  bench.settings.sign = OutputSign::error;
  bench.step(22, 23, 23, 20);
  CHECK(bench.z() == -bench.wanted(1, 1, 0));
}

TEST_CASE("a model on absolute temperatures takes no zero", "[controller]") {
  Bench bench;
  bench.model.rise = false;
  bench.settings.outputs = {{{1000, 1000}, {1000, 1000}}};
  REQUIRE(bench.device.start());
  bench.step(21, 22, 23);
  CHECK(bench.z() == bench.wanted(21, 22, 23));
}

TEST_CASE("the offset is clamped and slewed, and the status says so", "[controller]") {
  Bench bench;
  bench.start();
  for (double a = 20; a < 34; a += 1) bench.step(a, 20, 20);
  const CompensatorStatus far = bench.step(34, 20, 20, 40);
  CHECK(bench.z() == -20);
  CHECK(far.clamped());
  CHECK_FALSE(far.slewing());
  const double before = bench.z();
  CHECK(bench.step(32, 20, 20).clamped());
  bench.step(30, 20, 20), bench.step(28, 20, 20), bench.step(26, 20, 20);
  CHECK(bench.step(24, 20, 20).slewing());
  CHECK(bench.z() >= before);
  CHECK(bench.z() <= before + 5);
}

TEST_CASE("a bad reading holds the offset, names the sensor and the reason, and is forgotten", "[controller]") {
  const std::pair<double, SensorFault> bad[] = {{nan_degC, SensorFault::not_finite},
                                                {-HUGE_VAL, SensorFault::not_finite},
                                                {61, SensorFault::range},
                                                {25, SensorFault::rate}};
  for (const auto& [reading, fault] : bad) {
    Bench bench;
    bench.start(21, 20, 20);
    bench.step(22, 20, 20, 20);
    const double before = bench.z();
    const CompensatorStatus status = bench.step(22, reading, 20);
    CHECK(status.state() == State::holding);
    CHECK(status.sensor() == 2);
    CHECK(status.fault() == fault);
    CHECK(status.unused_sensors() == 1);
    CHECK(bench.z() == before);
    CHECK(bench.step(22, 20, 20).state() == State::tracking);
    CHECK(bench.z() == before);
  }
}

TEST_CASE("the substitute takes over for a lost sensor and hands back when it recovered", "[controller]") {
  Bench bench;
  bench.start();
  bench.step(21, 22, 20, 20);
  bench.step(nan_degC, 22, 20, 2);
  CHECK(bench.device.state() == State::holding);
  CHECK(bench.step(nan_degC, 22, 20, 20).state() == State::substituting);
  CHECK(bench.z() == -bench.model.substitutes[0].predict(1, std::array<double, 3>{0, 2, 0}));
  CHECK(bench.step(21, 22, 20, 3).fault() == SensorFault::recovering);
  CHECK(bench.device.state() == State::substituting);
  bench.step(21, 22, 20, 20);
  CHECK(bench.word() == static_cast<std::uint32_t>(State::tracking));
  CHECK(bench.z() == bench.wanted(1, 2, 0));
}

TEST_CASE("without a substitute, or with two sensors lost, it holds, then ramps to zero, then comes back",
          "[controller]") {
  for (const bool two : {false, true}) {
    Bench bench;
    bench.start();
    bench.step(22, 22, 20, 20);
    const double before = bench.z();
    REQUIRE(before < -5);
    const double first = two ? nan_degC : 22;
    CHECK(bench.step(first, 22, nan_degC, 5).state() == State::holding);
    CHECK(bench.z() == before);
    CHECK(bench.step(first, 22, nan_degC).state() == State::fallback);
    CHECK(bench.z() == before + 1);
    CHECK(bench.step(first, 22, nan_degC, 100).unused_sensors() == (two ? 2 : 1));
    CHECK(bench.z() == 0);
    CHECK(bench.step(22, 22, 20, 4).state() == State::tracking);
    CHECK(bench.step(22, 22, 20, 20).state() == State::tracking);
    CHECK(bench.z() == before);
  }
}

TEST_CASE("hold time-out 0 ramps at once", "[controller]") {
  Bench bench;
  bench.settings.hold_steps = 0;
  bench.device.resume(bench.zero(20, 20, 20));
  bench.step(20, 20, 20, 9);
  CHECK(bench.step(nan_degC, 20, 20).state() == State::fallback);
}

TEST_CASE("a start from another source's offset makes no bump and slews to the demand", "[controller]") {
  Bench bench;
  CHECK(bench.device.resume(bench.zero(20, 20, 20), {7, -12}));
  bench.step(20, nan_degC, 20);
  CHECK(bench.z() == -12);  // still starting: held
  CHECK(bench.device.state() == State::starting);
  bench.step(20, 20, 20);
  CHECK(bench.z() == -11);
  CHECK(bench.device.offset_um()[0] == 6);
  CHECK(bench.device.start({nan_degC, -1000}));
  CHECK(bench.device.offset_um()[0] == 0);
  CHECK(bench.z() == -20);
}

TEST_CASE("outside the training domain the policy decides: warn, shrink, hold or ignore", "[controller]") {
  const std::array<double, 3> rise{21, 5, 2};  // z = (5, 0, 0): T2 = 12.5 over its limit 9.5
  for (const DomainPolicy policy :
       {DomainPolicy::ignore, DomainPolicy::warn, DomainPolicy::shrink, DomainPolicy::hold}) {
    Bench bench;
    bench.settings.domain_policy = policy;
    bench.settings.outputs = {{{1000, 1000}, {1000, 1000}}};
    for (auto& sensor : bench.settings.sensors) sensor.largest_step_K = 100;
    bench.device.resume(bench.zero(20, 20, 20));
    bench.step(26, 25, 22);
    CHECK(bench.word() == static_cast<std::uint32_t>(State::tracking));
    const double before = bench.z();
    const CompensatorStatus status = bench.step(20 + rise[0], 20 + rise[1], 20 + rise[2]);
    CHECK(status.outside_domain() == (policy != DomainPolicy::ignore));
    CHECK(status.state() == (policy == DomainPolicy::hold ? State::holding : State::tracking));
    const double full = bench.wanted(rise[0], rise[1], rise[2]);
    if (policy == DomainPolicy::ignore || policy == DomainPolicy::warn) CHECK(bench.z() == full);
    if (policy == DomainPolicy::hold) CHECK(bench.z() == before);
    if (policy != DomainPolicy::shrink) continue;
    const double edge = 6 + 15 * std::sqrt(9.5 / 12.5);  // the sample on the way to the mean where T2 = 9.5
    CHECK(bench.z() == Approx(bench.wanted(edge, 5, 2)));
  }
}

TEST_CASE("stop ramps to zero and switches off, off does nothing", "[controller]") {
  Bench bench;
  CHECK(bench.step(20, 20, 20).word == 0);
  bench.start();
  bench.step(22, 22, 20, 20);
  bench.device.stop();
  CHECK(bench.step(22, 22, 20).state() == State::stopping);
  CHECK(bench.step(22, 22, 20, 30).state() == State::off);
  CHECK(bench.z() == 0);
}

TEST_CASE("faulty settings are never started and show in the status", "[controller]") {
  Bench bench;
  bench.settings.outputs[1].slew_um_per_step = nan_degC;
  CHECK_FALSE(bench.device.start());
  CHECK_FALSE(bench.device.start({1, 1}));
  CHECK(bench.step(20, 20, 20).bad_settings());
  CHECK(bench.device.offset_um() == std::array<double, 2>{0, 0});
}

TEMPLATE_TEST_CASE("ten million random steps: always finite, in the clamp, within the slew", "[controller]", float,
                   double) {
  using Scalar = TestType;
  CompensationWishes wishes;
  wishes.clamp_um = 14;
  wishes.slew_um_per_s = .7;
  wishes.hold_s = 15;
  wishes.stuck_factor = .1;
  wishes.others_moved_K = .2;
  wishes.domain_policy = DomainPolicy::shrink;
  const auto model = narrow_model<Scalar, 3, 2, 2>(example_model());
  const auto settings = settings_for<Scalar, 3, 2>(example_model(), wishes);
  Compensator<Scalar, 3, 2, 2> device(model, settings);
  struct Subject {
    Compensator<Scalar, 3, 2, 2>& device;
    std::uint32_t identity;
    Scalar periods = 1;
    std::array<Scalar, 2> before{};
    State state_before = State::off;
    void remember() { before = device.offset_um(), state_before = device.state(); }
    void start() { device.start(); }
    void start(const std::array<Scalar, 2>& offsets) { device.start(offsets); }
    void start(const std::array<Scalar, 2>& offsets, const std::array<Scalar, 3>& zero) {
      typename Compensator<Scalar, 3, 2, 2>::Retained kept;
      kept.zero_degC = zero;
      kept.seal(identity);
      device.resume(kept, offsets);
    }
    void datum() { device.take_datum(); }
    void stop() { device.stop(); }
    void probe(std::size_t, Scalar) {}
    void step(const std::array<Scalar, 3>& readings, std::uint32_t passed, std::uint32_t heartbeat) {
      remember();
      periods = static_cast<Scalar>(passed);
      device.step(readings, {passed, heartbeat});
    }
  } subject{device, model.identity};
  std::set<std::pair<State, State>> seen;
  std::set<SensorFault> faults;
  long violations = 0, flags = 0;
  random_walk::run<Scalar, 3, 2>(subject, 10000000, [&] {
    for (std::size_t j = 0; j < 2; ++j) {
      const Scalar now = device.offset_um()[j], before = subject.before[j];
      const Scalar rounding = std::numeric_limits<Scalar>::epsilon() * 14;
      if (!(now >= -14 && now <= 14)) ++violations;
      if (!(std::abs(now - before) <= settings.outputs[j].slew_um_per_step * subject.periods + rounding)) ++violations;
    }
    seen.emplace(subject.state_before, device.state());
    faults.insert(device.status().fault());
    flags |= static_cast<long>(device.status().word & 0x70u);
  });
  CHECK(violations == 0);
  CHECK(faults.size() == 9);  // every kind of fault came up
  CHECK(flags == 0x70);       // out of the domain, clamped and slewing as well
  // Within a step the middle events and at_zero act: every transition they allow must have been seen, and no other.
  std::set<std::pair<State, State>> allowed;
  for (int s = 0; s < compensator_states; ++s)
    for (const auto event : {CompensatorEvent::demand, CompensatorEvent::substitute_demand, CompensatorEvent::no_demand,
                             CompensatorEvent::hold_expired, CompensatorEvent::no_zero})
      allowed.emplace(static_cast<State>(s), next_state(static_cast<State>(s), event));
  allowed.emplace(State::stopping, State::off);
  // A zero is forgotten only while off: what runs on one, or waits for one asked for, never comes to no_datum.
  for (const State runs : {State::tracking, State::substituting, State::holding, State::fallback})
    allowed.erase({runs, State::no_datum});
  CHECK(seen == allowed);
}
