#include "thermfit/network/effect.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

/// The least an effect must say.
class Bare : public Effect {
 public:
  std::string name() const override { return "bare"; }
  Stage stage() const override { return Stage::heat; }
  std::vector<ThermalNetwork::AddedEffect> candidates(const Setting&) const override { return {}; }
  std::vector<EffectParameter> parameters(const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {
    return {};
  }
  void act(ThermalSystem&, const ThermalNetwork&, const ThermalNetwork::AddedEffect&) const override {}
};

}  // namespace

TEST_CASE("an effect that says no more than its law is shown by a cool-down and disturbs the place where it acts",
          "[network]") {
  const Bare effect;
  const ThermalNetwork::AddedEffect here{"bare", "head", "", {}};
  CHECK(effect.meaning().empty());
  CHECK_FALSE(effect.calibration_does_the_same());
  CHECK(effect.disturbs(here) == "head");
  const PlannedBlock block = effect.shown_by(here, 4);
  CHECK(block.kind == ScheduleKind::cool_down);
  CHECK(block.purpose == SchedulePurpose::shows);
  CHECK(block.machine_hours == 6);
}
