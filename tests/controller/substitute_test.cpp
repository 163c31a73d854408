#include <cmath>
#include <iostream>

#include "support/catch.hpp"
#include "support/numeric_csv.hpp"
#include "thermfit/controller/compensator.hpp"
#include "thermfit/controller/settings_for.hpp"
#include "thermfit/fit/train.hpp"
#include "thermfit/number.hpp"

using namespace thermfit;

namespace {

Campaign vcenter55() {
  Campaign campaign;
  for (int b = 1; b <= 12; ++b) {
    Batch batch;
    batch.name = (b < 10 ? "K0" : "K") + std::to_string(b);
    const NumericCsv csv(std::string(THERMFIT_SOURCE_DIR) + "/data/vcenter55/" + batch.name + ".csv");
    batch.temperatures = {{"T1", "T2", "T3", "T4", "T5", "T6", "T7", "T8", "T9", "T10"}, csv.columns("T1", "T10")};
    batch.errors = {{"Z"}, csv.columns("Z", "Z")};
    batch.time_s = Vector::LinSpaced(batch.rows(), 0, 300. * static_cast<double>(batch.rows() - 1));
    campaign.push_back(batch);
  }
  return campaign;
}

}  // namespace

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
  wishes.stuck_factor = 0;
  const auto model = narrow_model<double, 10, 1, 2>(trained);
  const auto settings = settings_for<double, 10, 1>(trained, wishes);
  const auto remaining_um = [&](Index lost) {  // S over all batches; lost < 0: none
    double squares = 0, rows = 0;
    for (const Batch& batch : campaign) {
      Compensator<double, 10, 1, 2> device(model, settings);
      REQUIRE(device.start());
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
