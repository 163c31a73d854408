#include "thermfit/model/probe_level.hpp"

#include "support/catch.hpp"
#include "support/vcenter55.hpp"
#include "thermfit/controller/settings_for.hpp"
#include "thermfit/fit/train.hpp"

using namespace thermfit;

namespace {

TrainedModel model_of_errors_at(double level_um, TemperatureReference temperatures, ErrorReference errors) {
  Campaign campaign = vcenter55();
  for (Batch& batch : campaign) batch.errors.values.array() += level_um;
  TrainingPlan plan;
  plan.points = {0, 2};
  plan.reference = temperatures;
  plan.error_reference = errors;
  return train(campaign, plan);
}

}  // namespace

TEST_CASE("a machine coordinate is no thermal error, a warm-up's intercept is", "[model]") {
  for (const auto temperatures : {TemperatureReference::rise, TemperatureReference::absolute}) {
    CHECK(probe_level_um(model_of_errors_at(0, temperatures, ErrorReference::recorded), 0) == 0);
    for (const double level : {102350., -5000.})
      CHECK(probe_level_um(model_of_errors_at(level, temperatures, ErrorReference::recorded), 0) ==
            Approx(level).margin(100));
  }
  for (const ErrorReference errors : {ErrorReference::start, ErrorReference::batch})
    CHECK(probe_level_um(model_of_errors_at(102350, TemperatureReference::rise, errors), 0) == 0);
}

TEST_CASE("a probe's zero is never applied, and counts in no clamp", "[model]") {
  const auto rise = TemperatureReference::rise, absolute = TemperatureReference::absolute;
  const TrainedModel coordinate = model_of_errors_at(102350, rise, ErrorReference::recorded);
  CompensationWishes wishes;
  const double clamp_um = settings_for<double>(coordinate, wishes).outputs[0].clamp_um;
  CHECK(clamp_um < 300);
  CHECK(clamp_um > 50);
  wishes.zero = ZeroPolicy::first;
  CHECK_THROWS_WITH(settings_for<double>(coordinate, wishes), Catch::Contains("machine coordinate"));
  wishes.through_zero = true;
  CHECK(settings_for<double>(coordinate, wishes).outputs[0].clamp_um == clamp_um);
  CHECK_THROWS_AS(settings_for<double>(model_of_errors_at(102350, absolute, ErrorReference::recorded), wishes), Error);
  wishes.through_zero = false;
  CHECK_NOTHROW(settings_for<double>(model_of_errors_at(102350, rise, ErrorReference::start), wishes));
  CHECK_NOTHROW(settings_for<double>(model_of_errors_at(0, absolute, ErrorReference::recorded), wishes));
}
