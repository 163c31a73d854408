#include "thermfit/effects/output_traces.hpp"

#include "support/catch.hpp"
#include "support/small_machine.hpp"

using namespace thermfit;

namespace {

const EffectLibrary library = standard_effects();

/// Two batches of the small machine without noise: simulated as it is, measured with `added`.
PairedCampaign paired_with(const ThermalNetwork::AddedEffect& added) {
  ThermalNetwork machine = small_machine(), real = machine;
  real.effects = {added};
  Campaign measured, simulated;
  for (Batch batch : small_campaign(machine, 2)) {
    for (const auto& [network, campaign] : {std::pair(&real, &measured), std::pair(&machine, &simulated)}) {
      const Matrix channels = simulate(*network, {excitation_of(*network, batch)}, library)[0].channels;
      batch.temperatures.values.leftCols(3) = channels.leftCols(3);
      batch.errors.values = channels.rightCols(1);
      campaign->push_back(batch);
    }
  }
  return pair_campaigns(measured, simulated, "T4");
}

std::vector<OutputTrace> traces_of(const std::string& effect, const PairedCampaign& campaign) {
  std::vector<Vector> displacements;
  for (const PairedBatch& batch : campaign.batches) displacements.push_back(batch.simulated.col(4));
  OutputTraces traces(campaign, 20, {displacements});
  traces.add(library.at(effect));
  return traces.take();
}

Vector gap_in(const PairedCampaign& campaign, Index channel) {
  Vector gap(campaign.rows());
  for (std::size_t b = 0; b < campaign.batches.size(); ++b)
    campaign.part(gap, b) = campaign.batches[b].measured.col(channel) - campaign.batches[b].simulated.col(channel);
  return gap;
}

}  // namespace

TEST_CASE("what acts on one channel leaves there its trace times its strength", "[effects]") {
  struct Known {
    ThermalNetwork::AddedEffect added;
    Index channel;
    double strength;
  };
  const auto known =
      GENERATE(Known{{"sensor-offset", "T2", "", {{"offset_K", 1.5}}}, 1, 1.5},
               Known{{"sensor-gain", "T1", "", {{"gain", 1.05}}}, 0, .05},
               Known{{"sensor-drift", "T3", "", {{"rate_K_per_h", .2}}}, 2, .2},
               Known{{"probe-drift", "displacement", "time", {{"rate_um_per_h", 2}}}, 4, 2},
               Known{{"speed-shift", "displacement", "spindle_rpm", {{"shift_um", 3}, {"scale", 6000}}}, 4, 3},
               Known{{"nonlinear-expansion", "head", "", {{"um_per_K2", .1}}}, 4, .1});
  INFO(known.added.effect);
  const PairedCampaign campaign = paired_with(known.added);
  const Vector gap = gap_in(campaign, known.channel);
  REQUIRE(gap.norm() > 0);
  double nearest = 1;
  for (const OutputTrace& trace : traces_of(known.added.effect, campaign))
    if (trace.channels == std::vector<Index>{known.channel}) {
      CHECK_FALSE(trace.unit_strength);
      nearest = std::min(nearest, (gap - known.strength * trace.columns.col(0)).norm() / gap.norm());
    }
  CHECK(nearest < 1e-3);
}

TEST_CASE("a law of known strength leaves its trace once its shape is right", "[effects]") {
  const auto added = GENERATE(ThermalNetwork::AddedEffect{"hysteresis", "displacement", "", {{"half_width_um", 2}}},
                              ThermalNetwork::AddedEffect{"clock-offset", "displacement", "", {{"late_s", 400}}},
                              ThermalNetwork::AddedEffect{"sensor-lag", "T1", "", {{"lag_s", 600}}});
  INFO(added.effect);
  const PairedCampaign campaign = paired_with(added);
  const Index channel = added.effect == "sensor-lag" ? 0 : 4;
  const Vector gap = gap_in(campaign, channel);
  double best = 1e300, shape = 0;
  for (const OutputTrace& trace : traces_of(added.effect, campaign)) {
    if (trace.channels != std::vector<Index>{channel}) continue;
    CHECK(trace.unit_strength);
    if (const double left = (gap - trace.columns.col(0)).norm(); left < best) {
      best = left;
      shape = trace.shape.at(0).value;
    }
  }
  CHECK(best < .3 * gap.norm());
  CHECK(shape == Approx(added.parameters[0].second).epsilon(.25));
}

TEST_CASE("a heat flow answers through lags in every channel but the room's", "[effects]") {
  const PairedCampaign campaign = paired_with({"sensor-offset", "T1", "", {{"offset_K", 1}}});
  OutputTraces traces(campaign, 20, {});
  CHECK(traces.thermometers() == std::vector<Index>{0, 1, 2});
  CHECK(traces.displacements() == std::vector<Index>{4});
  CHECK(traces.place(4) == "displacement");
  const OutputTrace trace = traces.heat_flow("door", "time", [](const PairedBatch&, Index k) { return k ? 1. : 0.; });
  CHECK(trace.channels == std::vector<Index>{0, 1, 2, 4});
  REQUIRE(trace.columns.cols() == 4);
  REQUIRE(trace.columns.rows() == 242);
  for (Index c = 0; c < 4; ++c) {
    const double lag_s = traces.lag_s(static_cast<std::size_t>(c));
    CHECK(trace.columns(120, c) == Approx(1 - std::exp(-(21600. - 180) / lag_s)).epsilon(.2));
  }
}

TEST_CASE("every effect of the catalogue leaves a trace where the outputs can show it", "[effects]") {
  PairedCampaign campaign = paired_with({"sensor-offset", "T1", "", {{"offset_K", 1}}});
  campaign.room_is_simulated = false;
  campaign.inputs.push_back("pump");
  for (PairedBatch& batch : campaign.batches) {
    batch.inputs.conservativeResize(Eigen::NoChange, 2);
    for (Index k = 0; k < batch.inputs.rows(); ++k) batch.inputs(k, 1) = k % 40 < 20 ? 0 : 1;
  }
  for (const auto& effect : library.all()) {
    INFO(effect->name());
    const std::vector<OutputTrace> traces = traces_of(effect->name(), campaign);
    CHECK_FALSE(traces.empty());
    for (const OutputTrace& trace : traces) {
      CHECK(trace.effect == effect->name());
      CHECK(trace.stage == effect->stage());
      CHECK(trace.columns.allFinite());
      CHECK_FALSE(trace.channels.empty());
    }
  }
}

TEST_CASE("a law may be of one sample or of the whole batch", "[effects]") {
  PairedBatch batch;
  batch.time_s = Vector::LinSpaced(5, 0, 4);
  const auto sample = [](const PairedBatch& of, Index k) { return 2 * of.time_s(k); };
  const auto whole = [](const PairedBatch& of) { return Vector(2 * of.time_s); };
  CHECK(TraceLaw(sample)(batch) == TraceLaw(whole)(batch));
}
