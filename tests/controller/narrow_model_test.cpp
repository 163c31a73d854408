#include "thermfit/controller/narrow_model.hpp"

#include "controller/example_model.hpp"
#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("the controller model computes what the trained model predicts", "[controller]") {
  const TrainedModel trained = example_model();
  const auto fixed = narrow_model<double, 3, 2, 2>(trained);
  const auto dynamic = narrow_model<double>(trained);
  const std::array<double, 3> rise{7.25, -1.5, 3};
  const Vector predicted = trained.model.predict(Eigen::Vector3d(7.25, -1.5, 3));
  for (std::size_t j = 0; j < 2; ++j) {
    CHECK(fixed.equation.predict(j, rise) == Approx(predicted(static_cast<Index>(j))).margin(1e-14));
    CHECK(dynamic.equation.predict(j, rise) == fixed.equation.predict(j, rise));
  }
  CHECK(fixed.has_substitute == std::array<bool, 3>{true, true, false});
  CHECK(fixed.substitutes[0].coefficients[1] == std::array<double, 3>{0, 1.75, -1});
  CHECK(fixed.rise);
}

TEST_CASE("sizes that do not fit are reported, nothing is cut or padded", "[controller]") {
  const TrainedModel trained = example_model();
  CHECK_THROWS_WITH((narrow_model<float, 2, 2, 2>(trained)), Catch::Contains("3 sensors; allowed: 2"));
  CHECK_THROWS_WITH((narrow_model<float, 4, 2, 2>(trained)), Catch::Contains("3 sensors; allowed: 4"));
  CHECK_THROWS_WITH((narrow_model<float, 3, 1, 2>(trained)), Catch::Contains("2 errors; allowed: 1"));
  CHECK_THROWS_WITH((narrow_model<float, 3, 2, 3>(trained)), Catch::Contains("2 components; allowed: 3"));
}

TEST_CASE("a value that float cannot hold is an error, in double it is none", "[controller]") {
  TrainedModel trained = example_model();
  trained.model.coefficients(1, 1) = 1e39;
  CHECK_THROWS_AS(narrow_model<float>(trained), Error);
  CHECK_NOTHROW(narrow_model<double>(trained));
  trained.model.coefficients(1, 1) = std::nan("");
  CHECK_THROWS_AS(narrow_model<double>(trained), Error);
}

TEST_CASE("a model without a domain or substitutes still runs", "[controller]") {
  TrainedModel trained = example_model();
  trained.domain = {};
  trained.substitutes.clear();
  const auto model = narrow_model<float, 3, 2, 0>(trained);
  CHECK(model.domain.t2_limit == 0);
  CHECK(settings_for<float>(trained).domain_policy == DomainPolicy::ignore);
}

TEST_CASE("settings follow from the envelope of the sensors and the period", "[controller]") {
  CompensationWishes wishes;
  wishes.period_s = 10;
  wishes.hold_s = 95;
  const auto settings = settings_for<double, 3, 2>(example_model(), wishes);
  CHECK(settings.sensors[1].lowest_degC == -2);
  CHECK(settings.sensors[1].highest_degC == 55);
  CHECK(settings.sensors[0].largest_step_K == Approx(1 + 5 * 2. / 6));
  CHECK(settings.sensors[2].stuck_steps == 72);
  CHECK(settings.patience.lost_after_steps == 1);
  CHECK(settings.hold_steps == 10);
  CHECK(settings.outputs[1].slew_um_per_step == 10);
  CHECK(settings.outputs[1].clamp_um == std::ceil(std::abs(example_model().error_mean(1)) + 24));
}

TEST_CASE("samples of a zero may scatter and drift as in training, by 1 K each where that is not known",
          "[controller]") {
  CompensationWishes wishes;
  wishes.period_s = 10;
  TrainedModel model = example_model();
  CHECK(settings_for<double>(model, wishes).sensors[0].agree_K == Approx(.1 + 2. / 60 * 2 * 10));
  model.envelope.largest_rate_K_per_min.resize(0);
  CHECK(settings_for<double>(model, wishes).sensors[0].agree_K == Approx(1.1));
  model.envelope = {};
  CHECK(settings_for<double>(model, wishes).sensors[0].agree_K == 2);
}

TEST_CASE("settings that break a rule are refused by the rule's text", "[controller]") {
  CompensationWishes wishes;
  wishes.slew_um_per_s = 0;
  CHECK_THROWS_WITH((settings_for<double, 3, 2>(example_model(), wishes)),
                    Catch::Contains("slew_um_per_step is above 0"));
  wishes = {};
  wishes.clamp_um = -1;
  CHECK_THROWS_WITH((settings_for<double, 3, 2>(example_model(), wishes)), Catch::Contains("clamp_um is above 0"));
}
