#include "thermfit/findings/leave_out.hpp"

#include "support/catch.hpp"
#include "support/vcenter55.hpp"
#include "thermfit/findings/campaign_findings.hpp"
#include "thermfit/findings/copy_findings.hpp"

using namespace thermfit;

namespace {

LeaveOut leave_out_of(const Campaign& campaign) { return leave_out(campaign, find_faults(campaign)); }

auto temperature(Batch& batch, Index number) { return batch.temperatures.values.col(number - 1); }

}  // namespace

TEST_CASE("of a sound campaign nothing is left out", "[findings]") {
  const Campaign campaign = vcenter55();
  const LeaveOut left = leave_out_of(campaign);
  CHECK(left.nothing());
  const Campaign kept = without(campaign, left);
  REQUIRE(kept.size() == campaign.size());
  for (std::size_t b = 0; b < kept.size(); ++b) CHECK(kept[b].temperatures.values == campaign[b].temperatures.values);
}

TEST_CASE("bad readings are left out as rows of their batch", "[findings]") {
  Campaign campaign = vcenter55();
  temperature(campaign[2], 3)(30) += 5;
  campaign[2].errors.values(40, 0) = -1e12;
  temperature(campaign[2], 4).segment(60, 2).setConstant(-127);
  const LeaveOut left = leave_out_of(campaign);
  CHECK(left.rows[2] == std::vector<Index>{30, 40, 60, 61});
  CHECK(left.temperatures.empty());
  CHECK(left.batches.empty());
  REQUIRE(left.reasons.size() == 3);
  for (const LeaveOut::Reason& reason : left.reasons) {
    CHECK(reason.batch == 2);
    CHECK(reason.what == LeaveOut::What::rows);
  }
  const Campaign kept = without(campaign, left);
  CHECK(kept[2].rows() == 75);
  CHECK(kept[2].dropped_rows == 4);
  CHECK(kept[2].time_s(30) == campaign[2].time_s(31));
  CHECK(kept[2].errors.values(74, 0) == campaign[2].errors.values(78, 0));
  CHECK(leave_out_of(kept).nothing());
}

TEST_CASE("a sensor that is faulty in some batches is left out of all, since models need the same points",
          "[findings]") {
  Campaign campaign = vcenter55();
  for (const std::size_t b : {5u, 6u})
    temperature(campaign[b], 7).tail(69).setConstant(temperature(campaign[b], 7)(10));
  const LeaveOut left = leave_out_of(campaign);
  CHECK(left.temperatures == std::vector<std::string>{"T7"});
  CHECK(left.batches.empty());
  CHECK(left.rows[5].empty());
  const Campaign kept = without(campaign, left);
  REQUIRE(kept.size() == 12);
  for (std::size_t b = 0; b < 12; ++b) {
    CHECK(kept[b].temperatures.count() == 9);
    CHECK(kept[b].temperatures.find("T7") == -1);
    CHECK(kept[b].temperatures.values.col(kept[b].temperatures.find("T8")) == temperature(campaign[b], 8));
  }
}

TEST_CASE("of a faulty sensor and the batches it is faulty in, what costs fewer readings is left out", "[findings]") {
  Campaign campaign = vcenter55();
  const auto freeze = [&](std::size_t b, Index number) {
    temperature(campaign[b], number).tail(69).setConstant(temperature(campaign[b], number)(10));
  };
  SECTION("one batch of twelve, not one point of ten") {
    freeze(5, 7);
    const LeaveOut left = leave_out_of(campaign);
    CHECK(left.batches == std::vector<std::size_t>{5});
    CHECK(left.temperatures.empty());
    REQUIRE(!left.reasons.empty());
    CHECK(left.reasons.front().finding.channel == "T7");
    CHECK(left.reasons.front().what == LeaveOut::What::batch);
  }
  SECTION("one batch of seven, where two points of ten are faulty in it") {
    campaign.resize(7);
    freeze(3, 2);
    freeze(3, 7);
    CHECK(leave_out_of(campaign).batches == std::vector<std::size_t>{3});
  }
  SECTION("one point of ten, not one batch of seven") {
    campaign.resize(7);
    freeze(3, 7);
    CHECK(leave_out_of(campaign).temperatures == std::vector<std::string>{"T7"});
  }
  SECTION("three batches of twelve, not one point of two") {
    for (Batch& batch : campaign) {
      batch.temperatures.names.resize(2);
      batch.temperatures.values.conservativeResize(batch.rows(), 2);
    }
    for (const std::size_t b : {2u, 4u, 9u}) temperature(campaign[b], 1).setConstant(-127);
    const LeaveOut left = leave_out_of(campaign);
    CHECK(left.batches == std::vector<std::size_t>{2, 4, 9});
    CHECK(left.temperatures.empty());
  }
}

TEST_CASE("a batch is left out for its error, for being a copy, or when most of its sensors are faulty", "[findings]") {
  Campaign campaign = vcenter55();
  SECTION("the error never moves") { campaign[1].errors.values.setZero(); }
  SECTION("a copy") { campaign[1].digest = campaign[0].digest = "the same"; }
  SECTION("six of ten sensors") {
    for (Index number = 1; number <= 6; ++number) temperature(campaign[1], number).setConstant(20);
  }
  const LeaveOut left = leave_out_of(campaign);
  CHECK(left.batches == std::vector<std::size_t>{1});
  CHECK(left.temperatures.empty());
  for (const LeaveOut::Reason& reason : left.reasons) CHECK(reason.what == LeaveOut::What::batch);
  const Campaign kept = without(campaign, left);
  REQUIRE(kept.size() == 11);
  CHECK(kept[1].name == "K03");
}

TEST_CASE("an error that is faulty in every batch goes, where another is there", "[findings]") {
  Campaign campaign = vcenter55();
  for (Batch& batch : campaign) {
    batch.errors.names = {"X", "Z"};
    batch.errors.values.conservativeResize(batch.rows(), 2);
    batch.errors.values.col(1) = batch.errors.values.col(0);
    batch.errors.values.col(0).setZero();
  }
  const LeaveOut left = leave_out_of(campaign);
  CHECK(left.errors == std::vector<std::string>{"X"});
  CHECK(left.batches.empty());
  CHECK(without(campaign, left)[3].errors.names == std::vector<std::string>{"Z"});
}

TEST_CASE("a jump leaves out the shorter side of its batch", "[findings]") {
  Campaign campaign = vcenter55();
  campaign[4].errors.values.col(0).tail(10).array() -= 60;
  const LeaveOut left = leave_out_of(campaign);
  REQUIRE(left.rows[4].size() == 10);
  CHECK(left.rows[4].front() == 69);
  CHECK(left.rows[4].back() == 78);
}

TEST_CASE("rises count from the first row also where it is left out, from a bad reading never", "[findings]") {
  Campaign campaign = vcenter55();
  const Batch good = campaign[3];
  campaign[3].temperatures.values(0, 0) += 7;
  const LeaveOut left = leave_out_of(campaign);
  REQUIRE(left.rows[3] == std::vector<Index>{0});
  const Batch kept = without(campaign, left)[3];
  CHECK(kept.number_of(0) == 2);
  REQUIRE(kept.first_degC.size() == good.temperatures.count());
  CHECK(std::abs(kept.first_degC(0) - good.temperatures.values(0, 0)) < .5);
  CHECK(kept.first_degC(1) == good.temperatures.values(0, 1));
  LeaveOut also = left;
  also.temperatures = {good.temperatures.names[0]};
  const Batch without_T1 = without(campaign, also)[3];
  CHECK(without_T1.first_degC.size() == without_T1.temperatures.count());
  CHECK(without_T1.first_degC(0) == good.temperatures.values(0, 1));
}

TEST_CASE("what is worth knowing only leaves out nothing", "[findings]") {
  Campaign campaign = vcenter55();
  for (Batch& batch : campaign) temperature(batch, 6) = temperature(batch, 1);  // collinear
  campaign[1].time_s.tail(39).array() += 40000;                                 // a gap
  CHECK(leave_out_of(campaign).nothing());
}

TEST_CASE("campaigns that tell nothing about each other are no trouble", "[findings]") {
  CHECK(find_faults(Campaign{}).empty());
  Campaign campaign = vcenter55();
  SECTION("a batch without a number") {
    campaign[3].temperatures.values.setConstant(std::nan(""));
    campaign[3].errors.values.setConstant(std::nan(""));
  }
  SECTION("a batch without rows") {
    campaign[3].temperatures.values.resize(0, 10);
    campaign[3].errors.values.resize(0, 1);
    campaign[3].time_s.resize(0);
  }
  SECTION("a batch of two rows") {
    for (Matrix* values : {&campaign[3].temperatures.values, &campaign[3].errors.values})
      values->conservativeResize(2, values->cols());
    campaign[3].time_s.conservativeResize(2);
  }
  SECTION("another order of names") { std::swap(campaign[3].temperatures.names[0], campaign[3].temperatures.names[1]); }
  SECTION("no errors") {
    for (Batch& batch : campaign) batch.errors = {};
  }
  SECTION("two sensors") {
    for (Batch& batch : campaign) {
      batch.temperatures.names.resize(2);
      batch.temperatures.values.conservativeResize(batch.rows(), 2);
    }
  }
  SECTION("three batches") { campaign.resize(3); }
  const CampaignFindings findings = find_faults(campaign);
  for (std::size_t b = 0; b < campaign.size(); ++b) {
    INFO(b);
    if (b != 3) CHECK(findings[b].empty());
  }
  CHECK(without(campaign, leave_out(campaign, findings)).size() + 1 >= campaign.size());
}
