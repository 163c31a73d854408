#pragma once

/// What a diagnosis of a network says beside its verdict: where the gap lies, what remains, what it costs a
/// compensation model, what to measure next.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/lone_input.hpp"
#include "thermfit/diagnosis/diagnose.hpp"
#include "thermfit/diagnosis/planning/next_experiment.hpp"
#include "thermfit/diagnosis/where/chain.hpp"
#include "thermfit/diagnosis/where/conditions.hpp"
#include "thermfit/diagnosis/where/periods.hpp"
#include "thermfit/diagnosis/where/places.hpp"
#include "thermfit/diagnosis/where/remaining.hpp"
#include "thermfit/diagnosis/where/transfer.hpp"
#include "thermfit/findings/findings.hpp"

namespace thermfit {

namespace detail {

class Elaboration {
 public:
  Elaboration(Diagnosed& found, const ThermalNetwork& given, const Campaign& real, const EffectLibrary& library,
              unsigned seed)
      : found_(found), seen_(found.investigation.seen), given_(given), real_(real), library_(library), seed_(seed) {}

  void run() {
    pick_channel();
    conditions();
    places();
    stages();
    remaining();
    transfer();
    next();
    data_problems();
    claims_of_lone_inputs();
  }

 private:
  Diagnosis& diagnosis() { return found_.diagnosis; }

  /// The channel the views speak of: the first displacement, else the temperature with the largest calibrated gap.
  void pick_channel() {
    double largest = -1;
    for (std::size_t c = 0; c < seen_.channels.size(); ++c) {
      double square = seen_.channels[c].displacement ? 1e300 : 0;
      for (const Vector& r : series(found_.residuals.calibrated[c])) square += r.squaredNorm();
      if (square > largest) {
        largest = square;
        channel_ = c;
      }
    }
  }

  /// Missing samples leave no gap.
  static std::vector<Vector> series(const SeriesByBatch& residual) {
    std::vector<Vector> result;
    for (const Vector& one : residual) result.push_back(one.array().isNaN().select(0., one));
    return result;
  }

  std::string ambient_column() const {
    for (const ThermalNetwork::Sensor& sensor : given_.sensors)
      if (sensor.node == ThermalNetwork::ambient_node) return sensor.column;
    return given_.ambient.column;
  }

  void conditions() {
    Where& where = diagnosis().where;
    const std::vector<Vector> gap = series(found_.residuals.calibrated[channel_]);
    where.conditions = condition_shares(real_, gap, ambient_column());
    where.frequency = period_shares(seen_.time_s, gap);
    where.chain = chain_split(found_.calibrated, real_, found_.investigation.calibrated.fit.simulated);
  }

  void places() {
    if (diagnosis().verdict == Verdict::none) return;
    places_ = disturbed_places(seen_, found_.investigation.calibrated.fit, library_);
    double sum = 0;
    for (const DisturbedPlace& one : places_) sum += one.gain_beside;
    if (sum <= 0) return;
    for (const DisturbedPlace& one : places_)
      if (one.gain_beside > 0) diagnosis().where.places.push_back({one.name, one.gain_beside / sum});
    if (!diagnosis().effects.empty()) compare_views();
  }

  /// Whether a place of the effect-free view is what the effect acts on.
  static bool names_place(const FoundEffect& effect, const std::string& place) {
    std::vector<std::string> own{effect.location};
    own.insert(own.end(), effect.same_place.begin(), effect.same_place.end());
    for (const std::string& one : own)
      if (one.find(place) != std::string::npos) return true;
    return (effect.effect == "clock-offset" && place == "clock") ||
           (effect.effect == "initial-gradient" && place == "start");
  }

  void compare_views() {
    const FoundEffect& effect = diagnosis().effects[0];
    double strongest = 0;
    for (const DisturbedPlace& one : places_) strongest = std::max(strongest, one.gain);
    for (const DisturbedPlace& one : places_)
      if (one.gain >= .8 * strongest && names_place(effect, one.name)) return;
    for (const auto& source : given_.heat_sources)
      if (source.name == effect.location)
        for (const auto& [node, share] : source.into)
          if (given_.nodes[static_cast<std::size_t>(node)].name == places_[0].name) return;
    diagnosis().where.agrees = false;
    diagnosis().where.difference = "without assuming an effect, " + places_[0].name +
                                   " explains the gap best; the effect acts at " + effect.location +
                                   ": neighbours, spread effects and nodes without a sensor look alike in this view";
  }

  void stages() {
    std::vector<std::pair<Stage, double>> weights;
    if (!diagnosis().effects.empty())
      for (const FoundEffect& one : diagnosis().effects)
        weights.emplace_back(library_.at(one.effect).stage(), std::max(.01, one.confidence));
    else
      for (const DisturbedPlace& one : places_) weights.emplace_back(one.stage, one.gain_beside);
    double sum = 0;
    for (const auto& [stage, weight] : weights) sum += weight;
    for (const Stage stage :
         {Stage::heat, Stage::boundary, Stage::conduction, Stage::expansion, Stage::measurement, Stage::initial}) {
      double share = 0;
      for (const auto& [own, weight] : weights) share += own == stage ? weight : 0;
      if (sum > 0 && share > 0) diagnosis().where.stages.push_back({word_of(stage), share / sum});
    }
  }

  /// What remains in the channel of the gap; where the gap is that of all temperatures, in each of them.
  void remaining() {
    const Gap& gap = diagnosis().gap;
    Remaining& all = diagnosis().remaining;
    const bool displacement = seen_.channels[channel_].displacement;
    all.white = true;
    for (std::size_t c = 0; c < seen_.channels.size(); ++c) {
      if (displacement && c != channel_) continue;
      const GapLevels& rms = gap.per_sensor[c].rms;
      const Remaining one = remaining_gap(real_, series(found_.residuals.with_effect[c]), rms.with_effect, rms.noise,
                                          gap.per_sensor[c].unit, seed_);
      all.white = all.white && one.white;
      if (!displacement) all.looks_like += (all.looks_like.empty() ? "" : "; ") + seen_.channels[c].name + ": ";
      all.looks_like += one.looks_like;
    }
    all.unexplained_um =
        std::sqrt(std::max(0., gap.rms.with_effect * gap.rms.with_effect - gap.rms.noise * gap.rms.noise));
  }

  /// The campaign as a machine would have measured it.
  Campaign simulated(const ThermalNetwork& network) const {
    Campaign result = real_;
    const std::vector<Simulation> all = simulate(network, excitations_of(network, real_), library_);
    for (std::size_t b = 0; b < result.size(); ++b) {
      Batch& batch = result[b];
      for (std::size_t s = 0; s < network.sensors.size(); ++s)
        if (const Index at = batch.temperatures.find(network.sensors[s].column); at >= 0)
          batch.temperatures.values.col(at) = all[b].channels.col(static_cast<Index>(s));
      for (std::size_t d = 0; d < network.displacements.size(); ++d)
        if (const Index at = batch.errors.find(network.displacements[d].output); at >= 0)
          batch.errors.values.col(at) = all[b].channels.col(static_cast<Index>(network.sensors.size() + d));
    }
    return result;
  }

  void transfer() {
    if (!seen_.channels[channel_].displacement) return;
    for (const Batch& batch : real_)
      if (!batch.temperatures.values.allFinite() || !batch.errors.values.allFinite()) return;
    diagnosis().gap.transfer = transfer_of({simulated(given_), simulated(found_.calibrated), simulated(found_.best)},
                                           real_, seen_.channels[channel_].name);
  }

  void next() {
    std::vector<FittedRival> rivals;
    if (!diagnosis().effects.empty() && !found_.rivals.empty()) {
      const FoundEffect& best = diagnosis().effects[0];
      rivals.push_back({best.effect + " at " + best.location, found_.best, best.confidence});
      for (std::size_t i = 0; i < found_.rivals.size() && i < best.alternatives.size(); ++i) {
        const Rival& rival = best.alternatives[i];
        rivals.push_back({rival.effect + " at " + rival.location, found_.rivals[i], rival.confidence});
      }
    }
    const Account& nearest =
        found_.investigation.single.empty() ? found_.investigation.calibrated : found_.investigation.single[0];
    double hours = 0;
    for (const Vector& time_s : seen_.time_s) hours = std::max(hours, time_s(time_s.size() - 1) / 3600);
    diagnosis().next_experiment =
        rivals.size() > 1
            ? next_experiment(rivals, seen_, found_.investigation.calibrated.fit, nearest.fit.noise, library_)
            : experiment_without_rivals(diagnosis(), hours);
  }

  void data_problems() {
    std::string missing, unknown;
    for (const ThermalNetwork::Sensor& sensor : given_.sensors)
      if (real_[0].temperatures.find(sensor.column) < 0) missing += (missing.empty() ? "" : ", ") + sensor.column;
    for (const std::string& name : real_[0].temperatures.names)
      if (std::none_of(given_.sensors.begin(), given_.sensors.end(),
                       [&](const ThermalNetwork::Sensor& sensor) { return sensor.column == name; }))
        unknown += (unknown.empty() ? "" : ", ") + name;
    if (!missing.empty())
      diagnosis().data_problems.push_back({"sensors", "the batches lack " + missing + "; the machine file has them"});
    if (!unknown.empty())
      diagnosis().data_problems.push_back({"sensors", "the machine file lacks " + unknown + "; left out"});
    for (const Batch& batch : real_)
      for (const Finding& one : find_faults(batch)) {
        if (one.rule == FindingRule::collinear || one.rule == FindingRule::unit) continue;
        diagnosis().data_problems.push_back(
            {batch.name + " " + one.channel,
             std::string(rule_name(one.rule)) + (one.note.empty() ? "" : ": " + one.note)});
      }
  }

  void claims_of_lone_inputs() {
    for (const LoneInput& one : lone_inputs(given_, seen_))
      diagnosis().weaker_claims.push_back(
          "Input " + seen_.excitations[0].input_names[static_cast<std::size_t>(one.input)] + " is on in batch " +
          seen_.names[one.batch] +
          " alone: what it drives cannot be judged on batches not used for fitting, and that batch judges nothing.");
  }

  Diagnosed& found_;
  const MachineRecord& seen_;
  const ThermalNetwork& given_;
  const Campaign& real_;
  const EffectLibrary& library_;
  unsigned seed_;
  std::size_t channel_ = 0;
  std::vector<DisturbedPlace> places_;
};

}  // namespace detail

/// Completes `found.diagnosis`, which diagnose_fully() made of `real` and the machine `given`, with the views, the
/// remaining gap, transfer, the next experiment and data problems.
inline void elaborate(Diagnosed& found, const ThermalNetwork& given, const Campaign& real, const EffectLibrary& library,
                      unsigned seed = 1) {
  detail::Elaboration(found, given, real, library, seed).run();
}

}  // namespace thermfit
