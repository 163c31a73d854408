#include "thermfit/findings/finding_groups.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

Finding finding(FindingRule rule, const std::string& channel, double figure, double limit, Index row = 0) {
  return {rule, channel, row, row, figure, limit, "K", ""};
}

}  // namespace

TEST_CASE("findings of one rule and channel are one entry, with the batches they are in and the worst first",
          "[findings]") {
  const CampaignFindings findings{{finding(FindingRule::spike, "T1", 2, 1), finding(FindingRule::spike, "T1", 3, 1, 7)},
                                  {},
                                  {finding(FindingRule::spike, "T1", -9, 1), finding(FindingRule::jump, "T1", 4, 1)}};
  const std::vector<FindingGroup> groups = grouped(findings);
  REQUIRE(groups.size() == 2);
  CHECK(groups[0].rule == FindingRule::spike);
  CHECK(groups[0].batches == 2);
  REQUIRE(groups[0].places.size() == 3);
  CHECK(groups[0].worst().batch == 2);
  CHECK(groups[0].places[1].finding->first_row == 7);
  CHECK(groups[1].batches == 1);
}

TEST_CASE("what spoils a batch comes before a channel, that before readings, whatever their figures", "[findings]") {
  const CampaignFindings findings{{finding(FindingRule::time_gap, "time", 1e9, 1),
                                   finding(FindingRule::spike, "T1", 2, 1), finding(FindingRule::jump, "T2", 50, 1),
                                   finding(FindingRule::constant, "T3", 0, 0),
                                   finding(FindingRule::copy, "all", 0, 0)}};
  std::vector<std::string> order;
  for (const FindingGroup& group : grouped(findings)) order.push_back(group.channel);
  CHECK(order == std::vector<std::string>{"all", "T3", "T2", "T1", "time"});
}

TEST_CASE("without findings there is no group", "[findings]") {
  CHECK(grouped({}).empty());
  CHECK(grouped({{}, {}}).empty());
}
