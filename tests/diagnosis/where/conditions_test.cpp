#include "thermfit/diagnosis/where/conditions.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

Batch batch_of(const std::string& name, const Vector& rpm, const Vector& coolant, const Vector& room) {
  Batch batch;
  batch.name = name;
  batch.time_s = Vector::LinSpaced(rpm.size(), 0, 180. * static_cast<double>(rpm.size() - 1));
  batch.inputs = {{"spindle_rpm", "coolant"}, Matrix(rpm.size(), 2)};
  batch.inputs.values << rpm, coolant;
  batch.temperatures = {{"T1"}, room};
  return batch;
}

const ConditionShare* find(const std::vector<ConditionShare>& shares, const std::string& factor,
                           const std::string& level, double low = 0) {
  for (const ConditionShare& share : shares)
    if (share.factor == factor && share.level == level && (!share.is_range || share.range.low == low)) return &share;
  return nullptr;
}

}  // namespace

TEST_CASE("a gap that exists only while an input is on is found under that input", "[gap]") {
  Vector rpm(6), coolant(6), room(6);
  rpm << 2000, 2000, 4000, 4000, 6000, 6000;
  coolant << 0, 1, 0, 1, 0, 1;
  room.setConstant(20);
  const auto shares = condition_shares({batch_of("K01", rpm, coolant, room)}, {coolant});
  REQUIRE(find(shares, "coolant", "on"));
  CHECK(find(shares, "coolant", "on")->share == Approx(1));
  CHECK(find(shares, "coolant", "on")->rms == Approx(1));
  CHECK(find(shares, "coolant", "on")->share_of_time == Approx(.5));
  CHECK(find(shares, "coolant", "off")->share == Approx(0));
  for (const double low : {2000., 4000., 6000.}) {
    REQUIRE(find(shares, "spindle_rpm", "", low));
    CHECK(find(shares, "spindle_rpm", "", low)->share == Approx(1. / 3));
  }
}

TEST_CASE("shares of a factor add up to one, and a factor that never changes is left out", "[gap]") {
  const Vector course = Vector::LinSpaced(50, 0, 9), room = Vector::LinSpaced(50, 18, 24), still = Vector::Zero(50);
  const Campaign campaign{batch_of("K01", course, still, room), batch_of("K02", course, still, room)};
  const auto shares = condition_shares(campaign, {course, Vector(2 * course)}, "T1");
  double rpm = 0, ambient = 0, batch = 0;
  for (const ConditionShare& share : shares) {
    rpm += share.factor == "spindle_rpm" ? share.share : 0;
    ambient += share.factor == "T1" ? share.share : 0;
    batch += share.factor == "batch" ? share.share : 0;
    CHECK(share.factor != "coolant");
  }
  CHECK(rpm == Approx(1));
  CHECK(ambient == Approx(1));
  CHECK(batch == Approx(1));
  CHECK(find(shares, "batch", "K02")->share == Approx(.8));
}

TEST_CASE("only an input that is held at levels can be set, no temperature of the room and nothing that is measured") {
  const Vector course = Vector::LinSpaced(50, 0, 9), steps = (course.array() / 3).floor();
  for (const ConditionShare& share : condition_shares({batch_of("K01", steps, course, course)}, {course}, "T1")) {
    INFO(share.factor);
    CHECK(share.settable == (share.factor == "spindle_rpm"));
  }
}

TEST_CASE("warm-up, steady and cool-down follow the slope of the mean temperature", "[gap]") {
  Vector room(300);
  for (int i = 0; i < 300; ++i) room(i) = i < 100 ? .1 * i : i < 200 ? 10 : 10 - .1 * (i - 200);
  const auto phases = thermal_phases(batch_of("K", room, room, room));
  CHECK(phases[50] == ThermalPhase::warm_up);
  CHECK(phases[150] == ThermalPhase::steady);
  CHECK(phases[250] == ThermalPhase::cool_down);
}
