#include "thermfit/diagnosis/where/remaining.hpp"

#include <random>

#include "support/catch.hpp"

using namespace thermfit;

namespace {

Campaign campaign_of(int batches) {
  std::mt19937 random(5);
  Campaign campaign;
  for (int b = 0; b < batches; ++b) {
    Batch batch;
    batch.name = "K" + std::to_string(b);
    batch.time_s = Vector::LinSpaced(121, 0, 21600);
    batch.inputs = {{"spindle_rpm"}, Matrix(121, 1)};
    double level = 0;
    for (int i = 0; i < 121; ++i)
      batch.inputs.values(i, 0) = level = random() % 12 == 0 ? static_cast<double>(random() % 6) * 1000 : level;
    campaign.push_back(batch);
  }
  return campaign;
}

}  // namespace

TEST_CASE("a remaining gap at the noise is called noise", "[gap]") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<Vector> residuals(4, Vector(121));
  for (Vector& residual : residuals)
    for (double& value : residual) value = .25 * normal(random);
  const auto [look, white] = remaining_look(campaign_of(4), residuals, .255, .25);
  CHECK(white);
  CHECK(look.kind == RemainingLook::Kind::noise);
  CHECK(unexplained(.255, .25) == Approx(std::sqrt(.255 * .255 - .0625)));
  CHECK(unexplained(.2, .25) == 0);
}

TEST_CASE("an offset per batch, a drift and a followed input are told", "[gap]") {
  const Campaign campaign = campaign_of(5);
  std::vector<Vector> offset, drift, driven;
  for (std::size_t b = 0; b < 5; ++b) {
    offset.push_back(Vector::Constant(121, b % 2 ? 3. : -2.));
    drift.push_back(Vector::LinSpaced(121, -1, 1));
    driven.push_back(campaign[b].inputs.values.col(0) / 1000);
  }
  const auto look = [&](const std::vector<Vector>& residuals, double rms) {
    return remaining_look(campaign, residuals, rms, .2).first;
  };
  CHECK(look(offset, 2.5).kind == RemainingLook::Kind::shaped);
  CHECK(look(offset, 2.5).offset_share == Approx(1));
  CHECK(look(drift, .6).trend_share == Approx(1));
  CHECK(look(drift, .6).offset_share == 0);
  CHECK(look(driven, 3).follows == "spindle_rpm");
  CHECK(look(driven, 3).correlation == Approx(1).margin(.005));
}

TEST_CASE("of a few samples nothing is said", "[gap]") {
  Campaign campaign = campaign_of(1);
  campaign[0].time_s.conservativeResize(5);
  CHECK(remaining_look(campaign, {Vector::Ones(5)}, 1, .1).first.kind == RemainingLook::Kind::too_few);
}
