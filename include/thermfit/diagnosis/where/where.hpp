#pragma once

/// Where the gap that calibration leaves lies: its stages, places, conditions and periods, put together.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/judgement/judge.hpp"
#include "thermfit/diagnosis/leading_channel.hpp"
#include "thermfit/diagnosis/where/chain.hpp"
#include "thermfit/diagnosis/where/conditions.hpp"
#include "thermfit/diagnosis/where/periods.hpp"
#include "thermfit/diagnosis/where/places.hpp"

namespace thermfit {

/// The column that holds the room: of a thermometer in the air, else of the ambient rule; empty where there is none.
inline std::string ambient_column(const ThermalNetwork& network) {
  for (const ThermalNetwork::Sensor& sensor : network.sensors)
    if (sensor.node == ThermalNetwork::ambient_node) return sensor.column;
  return network.ambient.column;
}

/// One residual, missing samples (NaN) as no gap. Allocates the result.
template <typename Scalar = double>
std::vector<Vector> without_missing(const SeriesByBatch& residual) {
  std::vector<Vector> result;
  for (const VectorX<Scalar>& one : residual) result.push_back(one.array().isNaN().select(Scalar(0), one));
  return result;
}

/// The channel that views of a single course speak of, see leading_channel(). Allocates.
template <typename Scalar = double>
std::size_t viewed_channel(const MachineRecord& seen, const ChannelResiduals& gap) {
  const auto square = [&](std::size_t c) {
    double sum = 0;
    for (const VectorX<Scalar>& r : without_missing<Scalar>(gap[c])) sum += r.squaredNorm();
    return sum;
  };
  return leading_channel(
      seen.channels.size(), [&](std::size_t c) { return seen.channels[c].displacement; }, square);
}

namespace detail {

/// A place that gains at least this share of what the strongest gains is as good as it.
constexpr double as_strong = .8;

/// Whether a place of the effect-free view is what the effect acts on.
inline bool names_place(const EffectLibrary& library, const FoundEffect& effect, const std::string& place) {
  const auto holds = [&](const std::string& own) { return own.find(place) != std::string::npos; };
  return holds(effect.location) || std::any_of(effect.same_place.begin(), effect.same_place.end(), holds) ||
         library.at(effect.effect).disturbs({effect.effect, effect.location, effect.driver, {}}) == place;
}

/// Whether a strong place of the effect-free view is where the effect acts; a source acts at every node it heats.
inline bool views_agree(const std::vector<DisturbedPlace>& places, const FoundEffect& effect,
                        const ThermalNetwork& given, const EffectLibrary& library) {
  double strongest = 0;
  for (const DisturbedPlace& one : places) strongest = std::max(strongest, one.gain);
  for (const DisturbedPlace& one : places)
    if (one.gain >= as_strong * strongest && names_place(library, effect, one.name)) return true;
  for (const auto& source : given.heat_sources)
    if (source.name == effect.location)
      for (const auto& into : source.into)
        if (given.nodes[static_cast<std::size_t>(into.first)].name == places[0].name) return true;
  return false;
}

/// Shares of the stages of the chain: of the effects found by their confidence, else of the places by what they gain.
inline std::vector<NamedShare> stage_shares(const std::vector<FoundEffect>& effects,
                                            const std::vector<DisturbedPlace>& places, const EffectLibrary& library) {
  std::vector<std::pair<Stage, double>> weights;
  for (const FoundEffect& one : effects)
    weights.emplace_back(library.at(one.effect).stage(), std::max(.01, one.confidence));
  if (effects.empty())
    for (const DisturbedPlace& one : places) weights.emplace_back(one.stage, one.gain_beside);
  double sum = 0;
  for (const auto& weight : weights) sum += weight.second;
  std::vector<NamedShare> result;
  for (const Stage stage :
       {Stage::heat, Stage::boundary, Stage::conduction, Stage::expansion, Stage::measurement, Stage::initial}) {
    double share = 0;
    for (const auto& [own, weight] : weights) share += own == stage ? weight : 0;
    if (sum > 0 && share > 0) result.push_back({word_of(stage), share / sum});
  }
  return result;
}

}  // namespace detail

/// Of a judged campaign: `given` is the machine as given, `real` the campaign that was searched. Allocates.
template <typename Scalar = double>
Where where_of(const SearchResult& found, const Judgement& judgement, const ThermalNetwork& given, const Campaign& real,
               const EffectLibrary& library) {
  Where where;
  const std::size_t channel = viewed_channel<Scalar>(found.seen, judgement.levels.calibrated);
  const std::vector<Vector> gap = without_missing<Scalar>(judgement.levels.calibrated[channel]);
  const MapFit& calibrated = found.calibrated.fit;
  where.conditions = condition_shares(real, gap, ambient_column(given));
  where.frequency = period_shares(found.seen.time_s, gap);
  where.chain = chain_split(calibrated.network(), real, calibrated.simulated);
  std::vector<DisturbedPlace> places;
  if (judgement.verdict != Verdict::none) places = disturbed_places(found.seen, calibrated, library);
  double sum = 0;
  for (const DisturbedPlace& one : places) sum += one.gain_beside;
  for (const DisturbedPlace& one : places)
    if (sum > 0 && one.gain_beside > 0) where.places.push_back({one.name, one.gain_beside / sum});
  where.stages = detail::stage_shares(judgement.effects, places, library);
  const std::vector<FoundEffect>& told = judgement.effects.empty() ? judgement.suspicions.parts : judgement.effects;
  if (sum > 0 && !told.empty() && !detail::views_agree(places, told[0], given, library)) {
    where.agrees = false;
    where.free_place = places[0].name;
    where.effect_place = told[0].location;
  }
  return where;
}

THERMFIT_COMPILED_TEMPLATE(Where where_of<double>(const SearchResult&, const Judgement&, const ThermalNetwork&,
                                                  const Campaign&, const EffectLibrary&));

}  // namespace thermfit
