#include "thermfit/controller/session.hpp"

#include <cmath>
#include <random>

#include "controller/example_model.hpp"
#include "support/catch.hpp"
#include "thermfit/model/predict.hpp"

using namespace thermfit;
using Device = Compensator<double, 3, 2, 2, 11, 4, 2>;
using State = CompensatorState;

namespace {

/// A compensator that follows its demand at once, and the rows it was given as a batch.
struct Machine {
  TrainedModel trained = example_transfer_model();
  CompensationWishes wishes = free_wishes();
  Device::Model model = narrow_model<double, 3, 2, 2, 11, 4>(trained);
  Device::Settings settings = settings_for<double, 3, 2, 11, 4, 2>(trained, wishes);
  Device device{model, settings};
  std::vector<std::array<double, 3>> rows;
  std::vector<double> times_s;

  static CompensationWishes free_wishes() {
    CompensationWishes wishes;
    wishes.period_s = 10;
    wishes.slew_um_per_s = 1e5;
    wishes.clamp_um = 1e5;
    wishes.domain_policy = DomainPolicy::ignore;
    wishes.sign = OutputSign::error;
    wishes.rate_floor_K = 100;
    wishes.stuck_factor = 0;
    wishes.frozen_factor = 0;
    return wishes;
  }
  /// One step `periods` after the one before.
  std::array<double, 2> step(const std::array<double, 3>& row, std::uint32_t periods = 1) {
    times_s.push_back(times_s.empty() ? 0 : times_s.back() + 10. * periods);
    rows.push_back(row);
    device.step(row, {periods, 0});
    return device.offset_um();
  }
  /// What the model predicts of all the rows.
  Matrix predicted() const {
    Batch batch;
    batch.name = "walk";
    batch.temperatures.names = trained.temperatures;
    batch.temperatures.values.resize(static_cast<Index>(rows.size()), 3);
    batch.time_s.resize(static_cast<Index>(rows.size()));
    batch.errors.values.resize(static_cast<Index>(rows.size()), 0);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      batch.time_s(static_cast<Index>(r)) = times_s[r];
      for (std::size_t i = 0; i < 3; ++i)
        batch.temperatures.values(static_cast<Index>(r), static_cast<Index>(i)) = rows[r][i];
    }
    return predict(trained, batch).errors;
  }
  /// Cold and at rest, with its zero there.
  void begin(double degC = 20) {
    device.start();
    device.take_datum();
    for (int n = 0; n < 5; ++n) step({degC, degC + 1, degC - 1});
    REQUIRE(device.state() == State::tracking);
  }
};

/// A course of temperatures at irregular times.
struct Walk {
  std::mt19937 random{7};
  double a = 20, b = 21, c = 19;
  std::array<double, 3> next() {
    const auto move = [&] { return std::uniform_real_distribution<>(-.2, .25)(random); };
    a += move(), b += move(), c += move();
    return {a, b, c};
  }
  std::uint32_t periods() { return std::array<std::uint32_t, 6>{1, 1, 1, 2, 7, 60}[random() % 6]; }
};

double distance(const std::array<double, 2>& offset, const Matrix& predicted, Index row, Index since = -1) {
  double most = 0;
  for (Index j = 0; j < 2; ++j) {
    const double wanted = predicted(row, j) - (since < 0 ? 0 : predicted(since, j));
    most = std::max(most, std::abs(offset[static_cast<std::size_t>(j)] - wanted));
  }
  return most;
}

}  // namespace

TEST_CASE("the share of its way that a lag goes in many steps is that of one long step", "[controller]") {
  const double share = -std::expm1(-.01);
  for (const std::uint32_t steps : {1u, 2u, 3u, 100u, 1023u, 4000000000u})
    CHECK(share_of_way(share, steps) == Approx(-std::expm1(-.01 * steps)).epsilon(1e-13));
  CHECK(share_of_way(share, 0) == 0);
}

TEST_CASE("a model on derived channels runs as predict computes it, at any sampling", "[controller]") {
  Machine machine;
  Walk walk;
  machine.begin();
  std::vector<std::array<double, 2>> offsets(5);
  for (int n = 0; n < 500; ++n) offsets.push_back(machine.step(walk.next(), walk.periods()));
  const Matrix predicted = machine.predicted();
  double most = 0;
  for (Index row = 5; row < predicted.rows(); ++row)
    most = std::max(most, distance(offsets[static_cast<std::size_t>(row)], predicted, row));
  CHECK(predicted.cwiseAbs().maxCoeff() > 5);
  CHECK(most < 1e-10);
}

TEST_CASE("a datum on the warm machine gives the change since then: lags and climate go on", "[controller]") {
  Machine machine;
  Walk walk;
  machine.begin();
  for (int n = 0; n < 300; ++n) machine.step(walk.next(), walk.periods());
  machine.device.take_datum();
  const std::array<double, 3> there = walk.next();
  for (int n = 0; n < 3; ++n) machine.step(there);
  REQUIRE(machine.device.status().zero_source() == ZeroSource::datum);
  REQUIRE_FALSE(machine.device.status().zero_pending());
  const Index since = static_cast<Index>(machine.rows.size()) - 1;
  CHECK(std::abs(machine.device.offset_um()[0]) < 1e-12);
  for (int n = 0; n < 300; ++n) {
    const auto offset = machine.step(walk.next(), walk.periods());
    if (n % 50 == 49)
      CHECK(distance(offset, machine.predicted(), static_cast<Index>(machine.rows.size()) - 1, since) < 1e-10);
  }
}

TEST_CASE("after a power cycle lags go on as if the rows of the time off had not been recorded", "[controller]") {
  Machine machine;
  Walk walk;
  machine.begin();
  for (int n = 0; n < 200; ++n) machine.step(walk.next(), walk.periods());
  const Device::Retained kept = machine.device.retained();
  for (const std::uint32_t off : {0u, 5u, 300u}) {
    Device after(machine.model, machine.settings);
    REQUIRE(after.resume(kept, off));
    Machine longer;
    longer.rows = machine.rows;
    longer.times_s = machine.times_s;
    Walk on = walk;
    for (int n = 0; n < 50; ++n) {
      const auto row = on.next();
      longer.rows.push_back(row);
      longer.times_s.push_back(longer.times_s.back() + 10. * (n == 0 ? 1 + off : 1));
      after.step(row);
      CHECK(distance(after.offset_um(), longer.predicted(), static_cast<Index>(longer.rows.size()) - 1) < 1e-10);
    }
  }
}

TEST_CASE("where the time off is not known lags are not, and there is no zero until a datum", "[controller]") {
  Machine machine;
  machine.begin();
  machine.step({24, 25, 23}, 30);
  const Device::Retained kept = machine.device.retained();
  Device after(machine.model, machine.settings);
  CHECK(after.resume(kept));
  CHECK(after.step({24, 25, 23}).state() == State::no_datum);
  CHECK(after.offset_um() == std::array<double, 2>{0, 0});
  Device::Retained torn = kept;
  torn.lag_degC[2] += 1;
  Device again(machine.model, machine.settings);
  again.resume(torn, 0);
  CHECK(again.step({24, 25, 23}).state() == State::no_datum);
  torn = kept;
  torn.climate_degC += 1;
  CHECK_FALSE(torn.valid(machine.model.identity));
}

TEST_CASE("after a long pause a session begins: lags at their temperatures, its own climate", "[controller]") {
  Machine machine;
  machine.begin();
  for (int n = 0; n < 20; ++n) machine.step({24, 24, 24}, 60);
  Device after(machine.model, machine.settings);
  after.resume(machine.device.retained(), 2000);
  for (int n = 0; n < 5; ++n) after.step({18, 18, 18});
  const Device::Retained kept = after.retained();
  CHECK(kept.climate_degC == 18);
  for (const double lag : kept.lag_degC) CHECK(lag == 18);
}

TEST_CASE("a spike, and a sensor that was lost and comes back, are to its lag as rows that were left out",
          "[controller]") {
  Machine machine;
  Walk walk;
  machine.begin();
  for (int n = 0; n < 100; ++n) machine.step(walk.next());
  for (const int gone : {1, 3, 40}) {
    for (int n = 0; n < gone; ++n) machine.device.step({std::nan(""), walk.b, walk.c});
    machine.times_s.back() += 0;
    const auto back = walk.next();
    machine.times_s.push_back(machine.times_s.back() + 10. * (gone + 1));
    machine.rows.push_back(back);
    for (int n = 0; n < 1; ++n) machine.device.step(back);
    for (int n = 0; n < 10; ++n) machine.step(back);
    CHECK(machine.device.state() == State::tracking);
    const Index last = static_cast<Index>(machine.rows.size()) - 1;
    // The others went on at their temperatures meanwhile; T1's lags went the whole way when it was back.
    CHECK(distance(machine.device.offset_um(), machine.predicted(), last) < (gone < 10 ? .05 : .5));
  }
}

TEST_CASE("a probe's reading is added to the demand until the next, slews, ages, and is refused where it is none",
          "[controller]") {
  Machine machine;
  machine.wishes.probe_age_s = 600;
  machine.wishes.probe_largest_um = 20;
  machine.settings = settings_for<double, 3, 2, 11, 4, 2>(machine.trained, machine.wishes);
  CHECK(machine.device.probe(0, 1) == ProbeReading::no_demand);
  machine.begin();
  const std::array<double, 3> warm{22, 22, 20};
  const double demand = machine.step(warm)[1];
  const double jump = machine.settings.probe[1].jump_um;
  CHECK(jump == Approx(6 * machine.trained.residual_deviation_um(1)));
  CHECK(machine.device.probe(1, demand + 4) == ProbeReading::taken);
  CHECK_FALSE(machine.device.status().probed());
  const auto corrected = machine.step(warm, 0);
  CHECK(corrected[1] == demand);  // from the next step on
  machine.device.step(warm, {1, 0});
  CHECK(machine.device.status().probed());
  const double before = machine.device.offset_um()[1];
  CHECK(machine.device.probe(1, std::nan("")) == ProbeReading::no_number);
  CHECK(machine.device.probe(1, demand + 50) == ProbeReading::too_large);
  CHECK(machine.device.probe(1, before + 2 * jump) == ProbeReading::to_be_repeated);
  machine.device.step(warm, {59, 0});
  CHECK(machine.device.status().probed());
  machine.device.step(warm, {1, 0});
  CHECK_FALSE(machine.device.status().probed());  // too old
  machine.device.step(warm, {1, 0});
  CHECK(machine.device.probe(1, machine.device.offset_um()[1] + 2) == ProbeReading::taken);
  machine.device.step(warm);
  CHECK(machine.device.status().probed());
  machine.device.take_datum();
  for (int n = 0; n < 5; ++n) machine.device.step(warm);
  CHECK_FALSE(machine.device.status().probed());         // a new zero drops it
  CHECK(std::abs(machine.device.offset_um()[1]) < .05);  // lags go on
}

TEST_CASE("a plain model costs no byte for lags, climate and probe", "[controller]") {
  struct Old {  // the members before there were any
    std::uint32_t mark, model, through_zero;
    float zero_degC[3];
    std::uint32_t digest;
  };
  CHECK(sizeof(Compensator<float, 3, 2, 2>::Retained) == sizeof(Old));
  using Plain = Compensator<float, 3, 2, 2>;
  CHECK(sizeof(Plain::Model) == 260);
  CHECK(sizeof(Plain::Settings) == 156);
  CHECK(sizeof(Plain) <= 320);
}

TEST_CASE("a fixed type without features refuses a model of the method transfer", "[controller]") {
  CHECK_THROWS_AS((narrow_model<double, 3, 2, 2>(example_transfer_model())), Error);
  CHECK_THROWS_AS((narrow_model<double, 3, 2, 2, 10, 4>(example_transfer_model())), Error);
  TrainedModel absolute = example_transfer_model();
  absolute.reference = TemperatureReference::absolute;
  CHECK_THROWS_AS(narrow_model<double>(absolute), Error);
}

TEMPLATE_TEST_CASE("in a short cycle rounding does not stop a lag", "[controller]", float, double) {
  using Scalar = TestType;
  TrainedModel trained = example_transfer_model();
  CompensationWishes wishes = Machine::free_wishes();
  wishes.period_s = .001;
  const auto model = narrow_model<Scalar>(trained);
  const auto settings = settings_for<Scalar>(trained, wishes);
  Compensator<Scalar, dynamic_size, dynamic_size, dynamic_size> device(model, settings);
  device.start();
  device.take_datum();
  for (int n = 0; n < 10; ++n) device.step({20, 20, 20});
  for (int n = 0; n < 300000; ++n) device.step({20.5, 20.5, 20.5});  // 5 min: the lag of 5 min goes 1 - 1/e of the way
  CHECK(device.retained().lag_degC[3] == Approx(20 + .5 * (1 - std::exp(-1.))).margin(2e-4));
}
