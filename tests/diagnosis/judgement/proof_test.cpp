#include "thermfit/diagnosis/judgement/proof.hpp"

#include "support/catch.hpp"
#include "thermfit/effects/catalogue.hpp"

using namespace thermfit;

namespace {

/// One temperature in `batches` batches; calibration leaves 1 K of one sign in each, the effect leaves `left_K[b]`.
struct Case {
  SearchResult found;
  Naming naming;
  GapResiduals levels;
  Proof proof = Proof::given;

  explicit Case(const std::vector<double>& left_K, std::size_t lone_batch = 99,
                const std::string& effect_name = "sensor-lag", double displacement_left_um = 0, double odds = 1) {
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
    if (displacement_left_um > 0) {
      channel.name = "Z";
      channel.displacement = true;
      found.seen.channels.push_back(channel);
    }
    found.machine.heat_sources.emplace_back();
    found.machine.heat_sources[0].input = "heater";
    found.folds = folds_of(found.machine, found.seen);
    found.calibrated.held.residual = {before};
    levels.as_simulated = {before};
    levels.calibrated = {before};
    levels.with_effect = {after};
    if (displacement_left_um > 0) {
      const SeriesByBatch left(left_K.size(), Vector::Constant(20, displacement_left_um));
      found.calibrated.held.residual.push_back(before);
      levels.as_simulated.push_back(before);
      levels.calibrated.push_back(before);
      levels.with_effect.push_back(left);
    }
    FoundEffect effect;
    effect.effect = effect_name;
    effect.location = "T1";
    effect.confidence = 0.99;
    naming.effects = {effect};
    naming.odds = odds;
    proof = proof_of(naming, levels, found, standard_effects(), {}, 1);
  }
};

}  // namespace

TEST_CASE("an effect that shrinks the gap on every held-out batch is borne out") {
  CHECK(Case({0.3, 0.4, 0.2, 0.3}).proof == Proof::given);
}

TEST_CASE("an effect that helps some batches and harms others is not") {
  CHECK(Case({0.2, 1.3, 0.9, 1.2}).proof == Proof::lacking);
}

TEST_CASE("nor is one by a shrink that is certain but next to nothing") {
  CHECK(Case({0.96, 0.97, 0.96, 0.97}).proof == Proof::lacking);
}

TEST_CASE("one or two batches prove nothing") {
  CHECK(Case({0.1, 0.1}).proof == Proof::suspicion);
  CHECK(Case({0.1}).proof == Proof::suspicion);
}

TEST_CASE("an effect on the machine that brings temperatures closer at the cost of the displacement harms") {
  const std::vector<double> closer{0.3, 0.4, 0.2, 0.3};
  CHECK(Case(closer, 99, "missing-link", 1.2).proof == Proof::harms);
  CHECK(Case(closer, 99, "missing-link", 0.7).proof == Proof::given);
  // A thermometer has no part in the displacement.
  CHECK(Case(closer, 99, "sensor-lag", 1.02).proof == Proof::given);
}

TEST_CASE(
    "a displacement adds up all parts: what calibration leaves of it tells of a gap sooner than one thermometer") {
  MachineRecord seen;
  seen.channels.resize(1);
  seen.channels[0].floor = 1;
  const ChannelResiduals twice{{Vector::Constant(20, 2)}};
  CHECK_FALSE(gap_is_real(seen, twice, {}));
  seen.channels[0].displacement = true;
  CHECK(gap_is_real(seen, twice, {}));
}

TEST_CASE("overwhelming evidence names an effect whose gap calibration nearly closes at a price") {
  const std::vector<double> hardly{0.96, 0.97, 0.96, 0.97};
  CHECK(Case(hardly, 99, "missing-link", 0, 6).proof == Proof::lacking);
  CHECK(Case(hardly, 99, "missing-link", 0, 8).proof == Proof::given);
  CHECK(Case(hardly, 99, "missing-link", 1.2, 8).proof == Proof::harms);
}
