#pragma once

/// One blind case: a machine, a campaign on it, what the nominal machine does not know, and the truth.

#include <nlohmann/json.hpp>

#include "lumping.hpp"
#include "thermfit/number.hpp"
#include "unknown_effects.hpp"

namespace blind {

/// What kind of case to make; `effects` empty with `miscalibrated` false is the null case.
struct Card {
  std::vector<std::string> effects;
  bool miscalibrated = false;
  bool removed = false;  ///< the effect is taken out of the diagnoser's catalogue
  bool poor = false;     ///< one speed only
};

struct Case {
  nlohmann::ordered_json machine, truth;
  std::vector<std::pair<std::string, std::string>> batches;  ///< `real/K01.csv`, CSV text
};

/// Noise of the instruments.
struct Instruments {
  double sensor_noise_K, sensor_step_K, output_noise_um;
};

namespace detail {

inline double rounded(double value, int digits) {
  return thermfit::parse_number(thermfit::general_text(value, digits)).value_or(value);
}

/// The plant with the effects in it, run through the campaign: thermometers and displacement before noise.
inline Signals shown(const Machine& machine, const Campaign& campaign, const std::vector<Effect>& effects,
                     bool disturbed, bool fresh = false) {
  Plant plant = machine.plant;
  std::vector<HeatFlow> heats;
  for (const Effect& effect : effects) {
    if (effect.rebuild) effect.rebuild(plant);
    if (effect.heat) heats.push_back(effect.heat);
  }
  const auto sensors = part_sensors(machine);
  Signals signals;
  const std::size_t from = fresh ? campaign.recorded : 0;
  const std::size_t to = fresh ? campaign.batches.size() : campaign.recorded;
  for (std::size_t b = from; b < to; ++b) {
    const Experiment& given = campaign.batches[b];
    const Experiment batch = disturbed ? given : calm(given);
    Vector start = at_rest(plant, batch);
    for (const Effect& effect : effects)
      if (effect.start) effect.start(b, start);
    const Matrix trace = simulate(plant, batch, b, start, heats);
    Vector output = trace * plant.um_per_K;
    output.array() -= output[0];
    for (const Effect& effect : effects)
      if (effect.displacement) effect.displacement(b, batch, trace, output);
    output.array() -= output[0];
    Matrix fine(trace.rows(), static_cast<Index>(sensors.size()) + 1);
    for (std::size_t s = 0; s < sensors.size(); ++s) {
      Vector reading = trace.col(sensors[s].cell);
      for (const Effect& effect : effects)
        if (effect.reading && effect.sensor == sensors[s].name) effect.reading(b, batch, trace, reading);
      fine.col(static_cast<Index>(s)) = reading;
    }
    fine.rightCols(1) = output;
    signals.push_back(every(fine, batch.steps));
  }
  return signals;
}

inline Signals difference(Signals a, const Signals& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

inline nlohmann::ordered_json machine_json(const Machine& machine, const std::string& name, bool constant_air) {
  nlohmann::ordered_json json;
  json["format"] = "thermfit-machine/1";
  json["name"] = name;
  json["reference_temperature_C"] = 20.0;
  if (constant_air)
    json["ambient"] = "initial";
  else
    json["ambient"] = machine.ambient_sensor();
  const Plant& lumped = machine.lumped;
  for (Index i = 0; i < lumped.cells(); ++i)
    json["nodes"].push_back({{"name", machine.name(i)},
                             {"capacity_J_per_K", rounded(lumped.capacity_J_per_K[i], 5)},
                             {"ambient_W_per_K", rounded(lumped.ambient_W_per_K[i], 5)}});
  for (const Link& link : lumped.links)
    json["links"].push_back(
        {{"between", {machine.name(link.a), machine.name(link.b)}}, {"conductance_W_per_K", rounded(link.W_per_K, 5)}});
  for (const Source& source : lumped.sources) {
    nlohmann::ordered_json into;
    for (const auto& [lump, share] : source.into) into[machine.name(lump)] = share;
    json["heat_sources"].push_back({{"name", source.name},
                                    {"input", source.input},
                                    {"scale", source.scale},
                                    {"exponent", rounded(source.exponent, 5)},
                                    {"power_W", rounded(source.power_W, 5)},
                                    {"into", into}});
  }
  nlohmann::ordered_json expansion;
  for (Index i = 0; i < lumped.cells(); ++i)
    if (lumped.um_per_K[i] != 0) expansion[machine.name(i)] = rounded(lumped.um_per_K[i], 5);
  json["displacement"] = {{"output", machine.output}, {"zero", "first_sample"}, {"um_per_K", expansion}};
  for (const Sensor& sensor : machine.sensors)
    json["sensors"][sensor.name] = {{"node", sensor.lump < 0 ? "ambient" : machine.name(sensor.lump)}};
  return json;
}

inline std::string batch_text(const Machine& machine, const Experiment& batch, const Matrix& shown,
                              const Instruments& instruments, bool minutes, Random& random) {
  std::string text = minutes ? "time_min" : "time_s";
  for (const std::string& input : batch.inputs) text += "," + input;
  for (const Sensor& sensor : machine.sensors) text += "," + sensor.name;
  text += "," + machine.output + "\n";
  const int decimals = instruments.sensor_step_K < .05 ? 2 : 1;
  const auto reading = [&](double degC) {
    const double noisy = degC + instruments.sensor_noise_K * random.normal();
    return thermfit::fixed_text(std::round(noisy / instruments.sensor_step_K) * instruments.sensor_step_K, decimals);
  };
  for (Index row = 0; row < batch.samples(); ++row) {
    text += std::to_string(static_cast<Index>(batch.interval_s) * row / (minutes ? 60 : 1));
    for (Index i = 0; i < batch.input.cols(); ++i) text += "," + thermfit::fixed_text(batch.input(row, i), 0);
    Index channel = 0;
    for (const Sensor& sensor : machine.sensors)
      text += "," + reading(sensor.lump < 0 ? batch.air_degC[row * batch.steps] : shown(row, channel++));
    text += "," + thermfit::fixed_text(shown(row, channel) + instruments.output_noise_um * random.normal(), 2) + "\n";
  }
  return text;
}

inline bool possible(const std::string& effect, const Machine& machine, const Campaign& campaign) {
  const Experiment& batch = campaign.batches.front();
  if (effect == "coolant") return batch.column("coolant") >= 0;
  if (effect == "missing-link") return machine.lumps.size() >= 9;
  return true;
}

inline Effect make_effect(const std::string& name, const Machine& machine, const Campaign& campaign,
                          const Random& random, double size) {
  const auto& from = name.rfind("x-", 0) == 0 ? unknown_effects() : known_effects();
  return from.at(name).first(Scene{machine, campaign, random}, size);
}

/// Size at which calibration leaves `goal_um` of the displacement or `goal_um / 5` K of a thermometer, the larger.
inline double size_for(const std::string& name, double goal_um, const Machine& machine, const Campaign& campaign,
                       const Random& random, const Lumping& lumping, const Signals& without) {
  if (name == "ambient-drift") return 1;
  if (name == "sensor-offset") return goal_um < 1 ? 1.2 : goal_um < 3 ? 2.2 : 3.5;
  const auto& from = name.rfind("x-", 0) == 0 ? unknown_effects() : known_effects();
  const double greatest = from.at(name).second;
  double size = 1;
  for (int pass = 0; pass < 3; ++pass) {
    const Effect effect = make_effect(name, machine, campaign, random, size);
    const Vector left = lumping.left_after_calibration(difference(shown(machine, campaign, {effect}, false), without));
    const Index last = left.size() - 1;
    const double reached = std::max(left[last], last ? 5 * left.head(last).maxCoeff() : 0);
    size = std::clamp(size * std::clamp(goal_um / std::max(reached, 1e-6), .1, 10.), .02, greatest);
  }
  return size;
}

}  // namespace detail

/// Case number `number` of `seed`. Throws nothing and repeats byte for byte.
inline Case make_case(std::uint64_t seed, std::uint64_t number, const Card& card) {
  using namespace detail;
  for (std::uint64_t trial = 0;; ++trial) {
    const Random base = Random(seed).fork(number).fork(trial);
    Random random = base;
    Machine machine = random_machine(random);
    const std::string protocol =
        card.poor ? "one-speed" : random.pick(std::vector<std::string>{"rich", "rich", "rich", "stairs", "levels"});
    Campaign campaign = random_campaign(random, machine, protocol);
    const std::string strength = random.pick(std::vector<std::string>{"weak", "medium", "strong"});
    const double goal_um = strength == "weak" ? .4 : strength == "medium" ? 1.5 : 5;
    bool fits = true;
    for (const std::string& name : card.effects) fits = fits && possible(name, machine, campaign);
    if (!fits) continue;
    const bool constant_air =
        std::find(card.effects.begin(), card.effects.end(), "ambient-drift") != card.effects.end();
    if (constant_air) {
      const double wanted_K = strength == "weak" ? 1 : strength == "medium" ? 2 : 4;
      for (Experiment& batch : campaign.batches)
        batch.air_degC =
            (batch.air_degC[0] + wanted_K / campaign.air_swing_K * (batch.air_degC.array() - batch.air_degC[0]))
                .matrix();
      campaign.air_swing_K = wanted_K;
    }

    // What the nominal machine leaves out is left out before lumping; sizes follow from what calibration leaves.
    for (std::size_t e = 0; e < card.effects.size(); ++e)
      if (const Effect effect = make_effect(card.effects[e], machine, campaign, base.fork(10 + e), 1); effect.nominal)
        effect.nominal(machine);
    const std::vector<Experiment> recorded(campaign.batches.begin(),
                                           campaign.batches.begin() + static_cast<std::ptrdiff_t>(campaign.recorded));
    const Lumping lumping(machine, recorded);
    const Vector lumping_error = lumping.lumping_error();
    const Index last = lumping_error.size() - 1;
    if (trial < 20 && (lumping_error[last] > .15 || (last && lumping_error.head(last).maxCoeff() > .6))) continue;
    const Signals plain = shown(machine, campaign, {}, false);
    std::vector<Effect> effects;
    std::vector<double> sizes;
    for (std::size_t e = 0; e < card.effects.size(); ++e) {
      const Random own = base.fork(10 + e);
      sizes.push_back(size_for(card.effects[e], goal_um, machine, campaign, own, lumping, plain));
      effects.push_back(make_effect(card.effects[e], machine, campaign, own, sizes.back()));
    }

    const Instruments instruments{random.uniform(.025, .05), random.chance(.7) ? .01 : .1,
                                  random.pick(std::vector<double>{.15, .25, .25, .25, .4})};
    const Signals real = shown(machine, campaign, effects, true);
    Case made;
    bool faint = false;
    const bool minutes = random.chance(.85);
    Random noise = base.fork(3);
    const Signals later = shown(machine, campaign, effects, true, true);
    for (std::size_t b = 0; b < campaign.batches.size(); ++b) {
      const bool fresh = b >= campaign.recorded;
      const Experiment& batch = campaign.batches[b];
      made.batches.push_back(
          {(fresh ? "fresh/" : "real/") + batch.name + ".csv",
           batch_text(machine, batch, fresh ? later[b - campaign.recorded] : real[b], instruments, minutes, noise)});
    }

    // Channel by channel: instrument noise, what lumping leaves, what draughts do.
    const Signals calm_signals = shown(machine, campaign, effects, false);
    const Vector draughts = lumping.channel_rms(stacked(difference(real, calm_signals)));
    Vector floor = (lumping_error.array().square() + draughts.array().square()).matrix();
    for (Index c = 0; c < last; ++c)
      floor[c] += std::pow(instruments.sensor_noise_K, 2) + std::pow(instruments.sensor_step_K, 2) / 12;
    floor[last] += std::pow(instruments.output_noise_um, 2);
    floor = floor.cwiseSqrt();

    auto& truth = made.truth;
    truth["seed"] = seed;
    truth["number"] = number;
    truth["machine"] = machine.kind;
    truth["truth"] = nlohmann::ordered_json::array();
    double hours = 0;
    for (const Experiment& batch : recorded)
      hours += batch.interval_s * static_cast<double>(batch.samples() - 1) / 3600;
    for (std::size_t e = 0; e < effects.size(); ++e) {
      std::vector<Effect> others = effects;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(e));
      Signals less = shown(machine, campaign, others, false);
      if (effects[e].forgets_ambient) {
        Campaign constant = campaign;
        for (Experiment& batch : constant.batches) batch.air_degC.setConstant(batch.air_degC[0]);
        less = shown(machine, constant, others, false);
      }
      const Vector left = lumping.left_after_calibration(difference(calm_signals, less));
      // An offset is told from a thermometer's placement (prior .5 K) by its size alone.
      const double detectability = effects[e].name == "sensor-offset"
                                       ? sizes[e] / .25
                                       : std::sqrt(hours * left.cwiseQuotient(floor).squaredNorm());
      faint = faint || detectability < 8;
      const bool outside = effects[e].name.rfind("x-", 0) == 0;
      nlohmann::ordered_json entry;
      entry["family"] = card.removed ? "removed-" + effects[e].name : effects[e].name;
      if (outside || card.removed)
        entry["verdict"] = "unknown";
      else
        entry["effect"] = effects[e].name;
      if (card.removed) entry["removed"] = effects[e].name;
      entry[outside || card.removed ? "near" : "location"] = effects[e].places;
      if (!effects[e].also.empty()) entry["also"] = effects[e].also;
      if (!effects[e].driver.empty()) entry["driver"] = effects[e].driver;
      entry["size"] = rounded(sizes[e], 3);
      entry["left_after_calibration"] = {{"output_um", rounded(left[last], 3)},
                                         {"sensor_K", rounded(last ? left.head(last).maxCoeff() : 0, 3)}};
      entry["detectability"] = rounded(detectability, 3);
      truth["truth"].push_back(entry);
    }
    if (faint && strength != "weak" && !card.poor && trial < 12) continue;
    if (effects.empty()) {
      const std::string verdict = card.miscalibrated ? "miscalibration" : "none";
      truth["truth"].push_back({{"family", verdict}, {"verdict", verdict}});
    }
    if (card.removed) {
      truth["without"] = {effects[0].name};
      for (const std::string& twin : effects[0].also) truth["without"].push_back(twin);
    }
    truth["campaign"] = campaign.protocol;
    truth["strength"] = strength;
    truth["noise_um"] = instruments.output_noise_um;
    truth["sensor_step_K"] = instruments.sensor_step_K;
    truth["lumping_error"] = {{"output_um", rounded(lumping_error[last], 3)},
                              {"sensor_K", rounded(last ? lumping_error.head(last).maxCoeff() : 0, 3)}};
    truth["draughts"] = {{"output_um", rounded(draughts[last], 3)},
                         {"sensor_K", rounded(last ? draughts.head(last).maxCoeff() : 0, 3)}};

    const bool null_case = effects.empty() && !card.miscalibrated;
    Random nominal = base.fork(4);
    const double off = card.miscalibrated ? nominal.uniform(.15, .3) : nominal.uniform(.03, .12);
    if (!null_case) miscalibrate(machine.lumped, nominal, off);
    truth["miscalibrated_by"] = null_case ? 0 : rounded(off, 3);
    made.machine =
        machine_json(machine, "machine " + std::to_string(seed) + "/" + std::to_string(number), constant_air);
    return made;
  }
}

}  // namespace blind
