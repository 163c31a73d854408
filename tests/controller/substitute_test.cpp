#include <cmath>
#include <iostream>

#include "support/catch.hpp"
#include "support/vcenter55.hpp"
#include "thermfit/controller/compensator.hpp"
#include "thermfit/controller/settings_for.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/number.hpp"

using namespace thermfit;

TEST_CASE("with any one sensor lost the compensator leaves the error that was printed at fit time", "[controller]") {
  const Campaign campaign = vcenter55();
  TrainingPlan plan;
  plan.options.components = ComponentRule::fixed(2);
  const TrainedModel trained = train(campaign, plan);
  REQUIRE(trained.substitutes.size() == 10);
  CompensationWishes wishes;
  wishes.period_s = 300;
  wishes.lost_after_s = 0;
  wishes.slew_um_per_s = 1000;
  wishes.clamp_um = 1000;
  wishes.stuck_factor = wishes.frozen_factor = 0;
  const auto model = narrow_model<double, 10, 1, 2>(trained);
  const auto settings = settings_for<double, 10, 1>(trained, wishes);
  const auto remaining_um = [&](Index lost) {  // S over all batches; lost < 0: none
    double squares = 0, rows = 0;
    for (const Batch& batch : campaign) {
      Compensator<double, 10, 1, 2> device(model, settings);
      decltype(device)::Retained zero;  // the first row, from which training counts as well
      for (Index i = 0; i < 10; ++i) zero.zero_degC[static_cast<std::size_t>(i)] = batch.temperatures.values(0, i);
      zero.seal(model.identity);
      REQUIRE(device.resume(zero));
      for (Index row = 0; row < batch.rows(); ++row) {
        std::array<double, 10> readings{};
        for (Index i = 0; i < 10; ++i)
          readings[static_cast<std::size_t>(i)] = i == lost ? std::nan("") : batch.temperatures.values(row, i);
        const CompensatorStatus status = device.step(readings);
        REQUIRE(status.state() == (lost < 0 ? CompensatorState::tracking : CompensatorState::substituting));
        REQUIRE(status.sensor() == lost + 1);
        squares += std::pow(batch.errors.values(row, 0) + device.offset_um()[0], 2);
        ++rows;
      }
    }
    return std::sqrt(squares / (rows - 1));
  };
  std::cout << "lost sensor: S as trained, S as run, um\n";
  std::cout << "none  " << fixed_text(trained.residual_deviation_um(0), 3) << "  " << fixed_text(remaining_um(-1), 3)
            << '\n';
  for (const SubstituteModel& substitute : trained.substitutes) {
    const double printed = substitute.residual_deviation_um(0), run = remaining_um(substitute.lost);
    std::cout << trained.temperatures[static_cast<std::size_t>(substitute.lost)] << "  " << fixed_text(printed, 3)
              << "  " << fixed_text(run, 3) << '\n';
    CHECK(run == Approx(printed).epsilon(1e-9));
  }
}
