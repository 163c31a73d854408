#include "thermfit/gap/proof.hpp"

#include "support/catch.hpp"

using namespace thermfit;

namespace {

/// One temperature in `batches` batches; calibration leaves 1 K of one sign in each, the effect leaves `left_K[b]`.
struct Case {
  Investigation found;
  Judgement judgement;
  StageResiduals stages;

  explicit Case(const std::vector<double>& left_K, std::size_t lone_batch = 99) {
    ObservedChannel channel;
    channel.name = "T1";
    channel.floor = 0.1;
    found.seen.channels = {channel};
    SeriesByBatch before, after;
    for (std::size_t b = 0; b < left_K.size(); ++b) {
      found.seen.names.push_back("K" + std::to_string(b));
      found.seen.time_s.push_back(Vector::LinSpaced(20, 0, 1900));
      Excitation drive;
      drive.input_names = {"heater"};
      drive.inputs = Matrix::Zero(20, 1);
      if (b == lone_batch) drive.inputs.bottomRows(10).setConstant(50);
      found.seen.excitations.push_back(drive);
      before.push_back(Vector::Constant(20, 1));
      after.push_back(Vector::Constant(20, left_K[b]));
    }
    found.machine.heat_sources.emplace_back();
    found.machine.heat_sources[0].input = "heater";
    found.folds = folds_of(found.machine, found.seen);
    found.calibrated.held.residual = {before};
    stages.as_simulated = {before};
    stages.calibrated = {before};
    stages.with_effect = {after};
    FoundEffect effect;
    effect.effect = "sensor-lag";
    effect.location = "T1";
    effect.confidence = 0.99;
    judgement.verdict = Verdict::effect;
    judgement.effects = {effect};
    demand_proof(judgement, stages, found, {}, 1);
  }
};

}  // namespace

TEST_CASE("an effect that shrinks the gap on every held-out batch keeps its name") {
  const Case one({0.3, 0.4, 0.2, 0.3});
  CHECK(one.judgement.verdict == Verdict::effect);
  CHECK(one.judgement.effects.size() == 1);
}

TEST_CASE("an effect that helps some batches and harms others is not named, and the gap is told without it") {
  const Case one({0.2, 1.3, 0.9, 1.2});
  CHECK(one.judgement.verdict == Verdict::unknown);
  CHECK(one.judgement.effects.empty());
  CHECK(one.judgement.best == &one.found.calibrated);
  CHECK(one.stages.with_effect[0][1] == one.stages.calibrated[0][1]);
}

TEST_CASE("a shrink that is certain but next to nothing names no effect") {
  const Case one({0.96, 0.97, 0.96, 0.97});
  CHECK(one.judgement.verdict == Verdict::unknown);
}

TEST_CASE("with one or two batches an effect is a suspicion, at even odds at most") {
  CHECK(Case({0.1, 0.1}).judgement.verdict == Verdict::ambiguous);
  const Case one({0.1});
  CHECK(one.judgement.verdict == Verdict::ambiguous);
  REQUIRE(one.judgement.effects.size() == 1);
  CHECK(one.judgement.effects[0].confidence <= 0.5);
}
