#include "thermfit/io/json/campaign.hpp"

#include "support/catch.hpp"

TEST_CASE("the campaign card of the example data says that they are simulated and quotes the paper", "[io]") {
  const auto card = thermfit::read_campaign_card(THERMFIT_SOURCE_DIR "/data/vcenter55/campaign.json");
  CHECK(card.origin == "simulated");
  REQUIRE(card.published.size() == 2);
  CHECK(card.published[0].S_mean_um == 5.70);
  CHECK(card.published[1].S_std_um == 1.11);
}

TEST_CASE("a campaign card that is not there is refused by its name", "[io]") {
  CHECK_THROWS_WITH(thermfit::read_campaign_card("nowhere/campaign.json"),
                    "nowhere/campaign.json: cannot be opened; check the path and its permissions");
}
