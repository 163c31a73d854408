#include "thermfit/controller/datum.hpp"

#include <cmath>

#include "controller/example_model.hpp"
#include "support/catch.hpp"

using namespace thermfit;
using State = CompensatorState;

namespace {

const double nan_degC = std::nan("");

/// The example machine with everything a controller knows of it, a step a second.
struct Machine {
  using Device = Compensator<double, 3, 2, 2>;
  Device::Model model = narrow_model<double, 3, 2, 2>(example_model());
  Device::Settings settings;
  Device device{model, settings};

  explicit Machine(ZeroPolicy policy = ZeroPolicy::wait) {
    CompensationWishes wishes;
    wishes.zero = policy;
    wishes.slew_um_per_s = 100;
    wishes.clamp_um = 100;
    settings = settings_for<double, 3, 2>(example_model(), wishes);
  }
  CompensatorStatus step(std::array<double, 3> readings, int times = 1) {
    for (int i = 0; i < times; ++i) device.step(readings);
    return device.status();
  }
  CompensatorStatus step(double all, int times = 1) { return step({all, all, all}, times); }
  double z() const { return device.offset_um()[1]; }
  double wanted(double a, double b, double c) const {
    return -model.equation.predict(1, std::array<double, 3>{a, b, c});
  }
  double intercept() const { return model.equation.intercept_um[1]; }
};

}  // namespace

TEST_CASE("without a zero nothing is compensated, and the state says no datum", "[controller]") {
  for (const double degC : {20., 24., 0., 39.}) {
    Machine machine;
    REQUIRE(machine.device.start({0, 9}));
    CHECK(machine.step(degC, 3600).state() == State::no_datum);
    CHECK(machine.device.status().zero_source() == ZeroSource::none);
    CHECK(machine.z() == 0);
    CHECK_FALSE(machine.device.retained().valid(machine.model.identity));
  }
}

TEST_CASE("a datum makes the offset zero there, and later offsets relative to it, on a warm machine too",
          "[controller]") {
  Machine machine;
  machine.device.start();
  machine.step(27, 10);
  machine.device.take_datum();
  CHECK(machine.step(27).zero_pending());
  CHECK(machine.step(27, 10).state() == State::tracking);
  CHECK(machine.device.status().zero_source() == ZeroSource::datum);
  CHECK(machine.z() == 0);
  machine.step(29, 60);
  CHECK(machine.z() == Approx(machine.wanted(2, 2, 2) + machine.intercept()));
  machine.device.take_datum();
  CHECK(machine.step(29, 3).zero_pending());
  CHECK(machine.z() != 0);  // the old zero counts until the new one is there
  machine.step(29, 30);
  CHECK(machine.z() == 0);
}

TEST_CASE("a model on absolute temperatures is absolute until a datum, relative after it", "[controller]") {
  Machine machine;
  machine.model.rise = false;
  machine.settings.domain_policy = DomainPolicy::ignore;
  machine.device.start();
  machine.step(25, 100);
  CHECK(machine.z() == Approx(machine.wanted(25, 25, 25)));
  machine.device.take_datum();
  machine.step(25, 30);
  CHECK(machine.z() == 0);
  machine.step(26, 30);
  CHECK(machine.z() == Approx(machine.wanted(1, 1, 1) + machine.intercept()));
}

TEST_CASE("a machine that goes on warm after a power cycle goes on where it was, if its zero was kept",
          "[controller]") {
  Machine before(ZeroPolicy::first);
  before.device.start();
  before.step(20, 60);
  for (int k = 0; k < 1200; ++k) before.step(20 + 4. * k / 1200);
  before.step(24, 60);
  const double offset = before.z();
  REQUIRE(offset == Approx(before.wanted(4, 4, 4)));
  const Machine::Device::Retained kept = before.device.retained();

  Machine after;
  after.device.resume(kept);
  CHECK(after.step(24, 100).zero_source() == ZeroSource::retained);
  CHECK(after.device.state() == State::tracking);
  CHECK(after.z() == Approx(offset));
  after.device.stop();  // enable toggled: no power cycle, the zero stays
  after.step(24, 100);
  CHECK(after.device.state() == State::off);
  after.device.start();
  after.step(24, 100);
  CHECK(after.z() == Approx(offset));
}

TEST_CASE("a kept zero that is none, torn or another model's is not taken", "[controller]") {
  Machine machine;
  Machine::Device::Retained kept;
  CHECK_FALSE(kept.valid(machine.model.identity));
  kept.zero_degC = {20, 20, 20};
  kept.seal(machine.model.identity);
  REQUIRE(kept.valid(machine.model.identity));
  std::vector<Machine::Device::Retained> wrong(5, kept);
  wrong[0].mark = 0;
  wrong[1].zero_degC[2] = 20.5;
  wrong[2].through_zero = 1;
  wrong[3].digest ^= 1;
  wrong[4].seal(machine.model.identity + 1);
  for (const auto& one : wrong) {
    machine.device.resume(kept);
    REQUIRE(machine.step(24).zero_source() == ZeroSource::retained);
    machine.device.resume(one);
    CHECK(machine.device.status().zero_source() == ZeroSource::none);  // at once, before any step
    CHECK(machine.step(24, 60).state() == State::no_datum);
    CHECK(machine.z() == 0);
  }
}

TEST_CASE("a sensor that had no zero when it was kept has none after, though it reads again", "[controller]") {
  Machine before(ZeroPolicy::first);
  before.device.start();
  before.step({nan_degC, 20, 20}, 700);
  CHECK(before.device.state() == State::substituting);
  CHECK(std::isnan(before.device.retained().zero_degC[0]));
  Machine after;
  after.device.resume(before.device.retained());
  CHECK(after.step(22, 60).state() == State::substituting);
  CHECK(after.device.status().sensor() == 1);
  CHECK(after.device.status().fault() == SensorFault::no_reference);
  CHECK(after.z() == Approx(-after.model.substitutes[0].predict(1, std::array<double, 3>{0, 2, 2})));
}

TEST_CASE("a zero saved before it was taken is none", "[controller]") {
  Machine before(ZeroPolicy::first);
  before.device.start();
  before.step(nan_degC, 3);
  Machine after;
  after.device.resume(before.device.retained());
  CHECK(after.step(20, 60).state() == State::no_datum);
}

TEST_CASE("bad first samples do not become the zero: defaults of 0, one sensor late, one off", "[controller]") {
  struct Course {
    const char* what;
    std::array<double, 3> first;
    int times;
  };
  for (const Course& course :
       {Course{"a default of 0 for one sample", {0, 0, 0}, 1}, Course{"a default of 0 for three", {0, 0, 0}, 3},
        Course{"a default of 0 for ten", {0, 0, 0}, 10}, Course{"one sensor's default", {0, 20, 20}, 1},
        Course{"two sensors .9 K off", {20.9, 20.9, 20}, 1}, Course{"one sensor .9 K off for two", {20, 20.9, 20}, 2},
        Course{"one sensor late", {20, nan_degC, 20}, 300}, Course{"all late", {nan_degC, nan_degC, nan_degC}, 300}}) {
    INFO(course.what);
    Machine machine(ZeroPolicy::first);
    machine.device.start();
    machine.step(course.first, course.times);
    CHECK(machine.step({20, 20, 20}, 120).state() == State::tracking);
    CHECK(machine.device.retained().zero_degC == std::array<double, 3>{20, 20, 20});
    CHECK(machine.z() == Approx(machine.wanted(0, 0, 0)));
  }
}

TEST_CASE("the zero is the median of samples that agree: noise is told apart from a machine that moves",
          "[controller]") {
  Machine machine(ZeroPolicy::first);
  machine.device.start();
  for (const double a : {20.02, 19.98, 20.01, 20., 19.99}) machine.step({a, 20, 20});
  CHECK(machine.device.retained().zero_degC[0] == 20);
  Machine moving(ZeroPolicy::first);
  moving.device.start();
  for (int k = 0; k < 50; ++k) moving.step({18 + .08 * k, 20, 20});
  CHECK(moving.device.state() == State::starting);
  CHECK(moving.z() == 0);
}

TEST_CASE("a first zero must look like the beginning of a training batch, a datum need not", "[controller]") {
  Machine machine(ZeroPolicy::first);
  machine.device.start();
  CHECK(machine.step(28, 500).state() == State::starting);
  CHECK(machine.step(28, 500).state() == State::fallback);
  machine.device.take_datum();
  CHECK(machine.step(28, 60).state() == State::tracking);
  CHECK(machine.z() == 0);
}

TEST_CASE("a choice lets the intercept of a first zero drop out", "[controller]") {
  Machine machine(ZeroPolicy::first);
  machine.settings.zero.through_zero = true;
  machine.device.start();
  machine.step(20, 60);
  CHECK(machine.z() == 0);
  CHECK(machine.device.retained().through_zero == 1);
}

TEST_CASE("a datum while off forgets the zero: it is not known what is true when it is started", "[controller]") {
  Machine machine(ZeroPolicy::wait);
  Machine::Device::Retained kept;
  kept.zero_degC = {20, 20, 20};
  kept.seal(machine.model.identity);
  machine.device.resume(kept);
  machine.step(24, 60);
  machine.device.stop();
  machine.step(24, 60);
  machine.device.take_datum();
  machine.device.start();
  CHECK(machine.step(24, 60).state() == State::no_datum);
}
