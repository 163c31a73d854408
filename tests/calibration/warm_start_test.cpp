#include "thermfit/calibration/warm_start.hpp"

#include "support/bench_campaign.hpp"
#include "support/catch.hpp"

using namespace thermfit;

namespace {

WarmStart of(const Campaign& campaign) {
  return warm_start(bench::machine(), excitations_of(bench::machine(), campaign));
}

}  // namespace

TEST_CASE("batches that start in equilibrium do not start warm, whatever the seed") {
  for (unsigned seed = 1; seed <= 50; ++seed) CHECK_FALSE(of(bench::campaign(bench::machine(), 3, seed, .25)));
}

TEST_CASE("a batch whose beginning was not logged starts warm") {
  Campaign campaign = bench::campaign(bench::machine(), 3, 7);
  campaign[1].temperatures.values.row(0) += (Eigen::RowVectorXd(5) << 12, 6, 1, .2, 0).finished();
  const WarmStart found = of(campaign);
  REQUIRE(found.batches == std::vector<std::string>{"K02"});
  CHECK(found.channel == "T1");
  CHECK(found.rise_K == Approx(12).margin(.3));
}

TEST_CASE("one thermometer off is no warm start, nor are all by as much") {
  Campaign campaign = bench::campaign(bench::machine(), 3, 7);
  for (Batch& batch : campaign) batch.temperatures.values.col(1).array() += 5;
  CHECK_FALSE(of(campaign));
  for (Batch& batch : campaign) {
    batch.temperatures.values.col(1).array() -= 5;
    batch.temperatures.values.leftCols(4).array() += 5;
  }
  CHECK_FALSE(of(campaign));
}

TEST_CASE("a group of parts that starts off the room by the same is no machine that ran before") {
  Campaign campaign = bench::campaign(bench::machine(), 3, 7);
  for (Batch& batch : campaign) batch.temperatures.values.leftCols(2).array() += 5;
  CHECK_FALSE(of(campaign));
}
