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
  const Remaining remaining = remaining_gap(campaign_of(4), residuals, .255, .25);
  CHECK(remaining.white);
  CHECK(remaining.looks_like == "noise");
  CHECK(remaining.unexplained_um == Approx(std::sqrt(.255 * .255 - .0625)));
}

TEST_CASE("an offset per batch, a drift and a followed input are told in words", "[gap]") {
  const Campaign campaign = campaign_of(5);
  std::vector<Vector> offset, drift, driven;
  for (std::size_t b = 0; b < 5; ++b) {
    offset.push_back(Vector::Constant(121, b % 2 ? 3. : -2.));
    drift.push_back(Vector::LinSpaced(121, -1, 1));
    driven.push_back(campaign[b].inputs.values.col(0) / 1000);
  }
  CHECK(remaining_gap(campaign, offset, 2.5, .2).looks_like.rfind("an offset per batch (100 %", 0) == 0);
  CHECK(remaining_gap(campaign, drift, .6, .2).looks_like.find("a slow drift (100 %") != std::string::npos);
  CHECK(remaining_gap(campaign, driven, 3, .2).looks_like.find("it follows spindle_rpm (correlation 1.00") !=
        std::string::npos);
}
