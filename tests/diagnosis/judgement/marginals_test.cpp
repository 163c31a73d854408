#include "thermfit/diagnosis/judgement/marginals.hpp"

#include "support/catch.hpp"

using namespace thermfit;

TEST_CASE("a place off the list must be worth the nodes it could have taken") {
  Account listed, walked;
  listed.fit.prior.nodes.resize(16);
  walked.fit.prior.nodes.resize(16);
  walked.steps = 1;
  walked.fit.log_evidence = 0.5 * std::log(16) / evidence_power;
  CHECK(plausibility(walked) < plausibility(listed));
  walked.fit.log_evidence = 2 * std::log(16) / evidence_power;
  CHECK(plausibility(walked) > plausibility(listed));
  CHECK(probabilities({listed, walked})[1] > 0.5);
}

TEST_CASE("accounts of one effect at several places add up to its probability, and those places are told") {
  std::vector<Account> accounts(3);
  accounts[0].effects = {{"heat-source", "head", "spindle_rpm", {}}};
  accounts[1].effects = {{"heat-source", "column", "spindle_rpm", {}}};
  accounts[2].effects = {{"coolant", "head", "coolant", {}}};
  const std::vector<Marginal> ranked = marginals(accounts, {0.5, 0.2, 0.3}, "", 0.05);
  REQUIRE(ranked.size() == 2);
  CHECK(ranked[0].probability == Approx(0.7));
  CHECK(ranked[0].places == std::vector<std::string>{"head", "column"});
  CHECK(ranked[1].leader == 2);
}
