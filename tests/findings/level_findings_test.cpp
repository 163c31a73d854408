#include "thermfit/findings/level_findings.hpp"

#include "support/catch.hpp"
#include "support/vcenter55.hpp"
#include "thermfit/findings/campaign_findings.hpp"

using namespace thermfit;

namespace {

std::vector<Finding> levels_of(const Campaign& campaign) {
  std::vector<Finding> levels;
  for (const std::vector<Finding>& batch : find_faults(campaign))
    for (const Finding& one : batch)
      if (one.rule == FindingRule::level) levels.push_back(one);
  return levels;
}

}  // namespace

TEST_CASE("errors that start further apart than they move are told once, where they are farthest off", "[findings]") {
  Campaign campaign = vcenter55();
  CHECK(levels_of(campaign).empty());
  campaign[2].errors.values.array() += 300;
  campaign[5].errors.values.array() -= 40;
  campaign[5].errors.values(0, 0) = std::nan("");
  const std::optional<LevelFinding> level = level_finding(campaign, "Z");
  REQUIRE(level);
  CHECK(level->batch == 2);
  CHECK(level->finding.figure > level->finding.limit);
  CHECK(level->finding.note.find("300.2 um in 12 batches") != std::string::npos);
  CHECK(levels_of(campaign).size() == 1);
}

TEST_CASE("one bad first reading, one batch, or one machine coordinate for all are no levels", "[findings]") {
  Campaign campaign = vcenter55();
  campaign[4].errors.values(0, 0) = -800;
  CHECK(levels_of(campaign).empty());
  for (Batch& batch : campaign) batch.errors.values.array() += 102350;
  CHECK(levels_of(campaign).empty());
  CHECK(levels_of({campaign[0]}).empty());
  CHECK_FALSE(level_finding(campaign, "X"));
}
