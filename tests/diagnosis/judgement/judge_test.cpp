#include "thermfit/diagnosis/judgement/judge.hpp"

#include <algorithm>

#include "support/catch.hpp"
#include "thermfit/effects/catalogue.hpp"

using namespace thermfit;

namespace {

/// Two channels, one batch of 100 samples, each expected to be off by 1.
SearchResult two_channels() {
  SearchResult found;
  found.seen.names = {"K01"};
  found.seen.time_s = {Vector::LinSpaced(100, 0, 9900)};
  for (const char* name : {"T1", "T2"}) {
    ObservedChannel channel;
    channel.name = name;
    channel.floor = 1;
    found.seen.channels.push_back(channel);
  }
  return found;
}

ChannelResiduals constant(double first, double second) {
  return {{Vector::Constant(100, first)}, {Vector::Constant(100, second)}};
}

/// T1 in four batches: calibration leaves 4 K, a thermometer that lags leaves `left_K[b]`, by `nats` of evidence.
SearchResult lagging(const std::vector<double>& left_K, double nats) {
  SearchResult found;
  ObservedChannel channel;
  channel.name = "T1";
  channel.floor = 0.5;
  SeriesByBatch before, after;
  for (std::size_t b = 0; b < left_K.size(); ++b) {
    found.seen.names.push_back("K" + std::to_string(b));
    found.seen.time_s.push_back(Vector::LinSpaced(20, 0, 1900));
    Excitation own;  // no two batches repeat each other
    own.time_s = found.seen.time_s[b];
    own.inputs = Matrix::Constant(20, 1, static_cast<double>(b));
    found.seen.excitations.push_back(own);
    found.folds.push_back({b});
    channel.measured.push_back(Vector::LinSpaced(20, 20, 30));
    before.push_back(Vector::Constant(20, 4));
    after.push_back(Vector::Constant(20, left_K[b]));
  }
  found.seen.channels = {channel};
  found.machine.nodes = {{"head", 1000, 1}};
  found.machine.sensors.resize(1);
  found.machine.sensors[0].column = "T1";
  found.as_given = {before};
  found.calibrated.fit.prior = found.machine;
  found.calibrated.held.residual = {before};
  found.calibrated.held.by_channel = Vector::Zero(1);
  Account one = found.calibrated;
  one.effects = {{"sensor-lag", "T1", "", {{"lag_s", 60}}}};
  one.fit.prior.effects = one.effects;
  one.fit.log_evidence = nats;
  one.held.residual = {after};
  one.held.by_channel = Vector::Constant(1, nats);
  found.single = {one};
  found.screened.resize(1);
  return found;
}

Judgement judged(const SearchResult& found) {
  const EffectLibrary library = standard_effects();
  return judge(SearchContext{found.seen, found.machine, library, found.folds, 1}, found, {}, 1);
}

}  // namespace

TEST_CASE("an effect that shrinks the gap on every held-out batch is named, and the gap is told with it") {
  const SearchResult found = lagging({0.5, 0.6, 0.4, 0.5}, 30);
  const Judgement result = judged(found);
  CHECK(result.verdict == Verdict::effect);
  REQUIRE(result.effects.size() == 1);
  CHECK(result.effects[0].location == "T1");
  CHECK(result.best.list == AccountIndex::List::single);
  CHECK(result.levels.with_effect[0][1](0) == 0.6);
}

TEST_CASE("an effect that helps some batches and harms others is not named, and the gap is told without it") {
  const SearchResult found = lagging({0.2, 6, 0.2, 6}, 30);
  const Judgement result = judged(found);
  CHECK(result.verdict == Verdict::unknown);
  CHECK(result.effects.empty());
  CHECK(result.best.list == AccountIndex::List::calibrated);
  CHECK(result.levels.with_effect[0][1] == result.levels.calibrated[0][1]);
}

TEST_CASE("with two batches an effect is a suspicion, at even odds at most") {
  const Judgement result = judged(lagging({0.5, 0.5}, 30));
  CHECK(result.verdict == Verdict::ambiguous);
  REQUIRE(result.effects.size() == 1);
  CHECK(result.effects[0].confidence <= 0.5);
}

TEST_CASE("a machine is miscalibrated when calibration closes the gap, not when lumping leaves one") {
  SearchResult found = two_channels();
  found.placed.residual = constant(3, 1);
  found.calibrated.held.residual = constant(1, 1);
  CHECK(verdict_of_calibration(found, {}) == Verdict::miscalibration);
  found.calibrated.held.residual = constant(2.9, 1);
  CHECK(verdict_of_calibration(found, {}) == Verdict::none);
  found.placed.residual = constant(1.2, 1);
  found.calibrated.held.residual = constant(1, 1);
  CHECK(verdict_of_calibration(found, {}) == Verdict::none);
}

TEST_CASE("the best account of what a machine lacks too little to be named by is suspected, at even odds at most") {
  SearchResult found = lagging({0.5, 0.5, 0.5, 0.5}, 40);
  found.screened.resize(600);
  for (Vector& one : found.calibrated.held.residual[0]) one.setConstant(0.8);
  const Judgement result = judged(found);
  CHECK(result.effects.empty());
  CHECK(result.suspicions.parts.empty());
  REQUIRE(result.suspicions.suspected.size() == 1);
  const FoundEffect& suspect = result.suspicions.suspected[0];
  CHECK(suspect.effect == "sensor-lag");
  CHECK(suspect.confidence > 0.3);
  CHECK(suspect.confidence <= 0.5);
  CHECK(suspect.closes == 1);
  CHECK(result.levels.with_effect[0][1] == result.levels.calibrated[0][1]);
}

TEST_CASE("what a machine that lacks nothing gains is not suspected, nor what leaves more than it should") {
  SearchResult chance = lagging({0.5, 0.5, 0.5, 0.5}, 3);
  chance.screened.resize(600);
  for (Vector& one : chance.calibrated.held.residual[0]) one.setConstant(0.6);
  CHECK(judged(chance).suspicions.suspected.empty());
  SearchResult leaves = lagging({2, 2, 2, 2}, 30);
  leaves.screened.resize(600);
  CHECK(judged(leaves).suspicions.suspected.empty());
}

TEST_CASE("strong evidence that leaves much is a part of the cause, and the gap keeps having no name") {
  SearchResult found = lagging({2, 2.1, 1.9, 2}, 200);
  const Judgement result = judged(found);
  CHECK(result.verdict == Verdict::unknown);
  CHECK(result.effects.empty());
  REQUIRE(result.suspicions.parts.size() == 1);
  CHECK(result.suspicions.parts[0].location == "T1");
  CHECK(result.suspicions.parts[0].closes == Approx(1 - (15.0 / 63)).margin(0.02));
  CHECK(result.suspicions.parts[0].confidence <= 0.5);
  CHECK(result.suspicions.suspected.empty());
}

TEST_CASE("an account that helps some batches and harms others is no part of the cause") {
  CHECK(judged(lagging({0.2, 6, 0.2, 6}, 200)).suspicions.parts.empty());
}

TEST_CASE("a second effect short of a name is suspected beside the first") {
  SearchResult found = lagging({0.7, 0.7, 0.7, 0.7}, 100);
  Account pair = found.single[0];
  pair.effects.push_back({"sensor-gain", "T1", "", {{"gain", 0.1}}});
  pair.fit.prior.effects = pair.effects;
  pair.fit.log_evidence = 104;
  pair.held.by_channel = Vector::Constant(1, 104);
  for (Vector& one : pair.held.residual[0]) one.setConstant(0.5);
  found.several = {pair};
  const Judgement result = judged(found);
  REQUIRE(result.effects.size() == 1);
  CHECK(result.effects[0].effect == "sensor-lag");
  REQUIRE(result.suspicions.suspected.size() == 1);
  CHECK(result.suspicions.suspected[0].effect == "sensor-gain");
  CHECK(result.suspicions.suspected[0].confidence <= 0.5);
}
