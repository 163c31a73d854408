#pragma once

/// What is run on the machine: speeds, feeds, coolant and air of the batches of a campaign.

#include "machine.hpp"

namespace blind {

/// `rich`: everything changes at random times; `stairs`: speed steps up, then a cool-down; `levels`: one speed a batch,
/// then a cool-down; `one-speed`: the same speed in every batch, the poorest protocol.
struct Campaign {
  std::string protocol;
  double air_swing_K;    ///< standard deviation of the slow course of the air in a batch
  bool pump_logged;      ///< there is a fourth input, the hydraulic pump
  std::size_t recorded;  ///< the first of `batches`; the rest are fresh, kept from the diagnosis
  std::vector<Experiment> batches;
};

/// Batches kept back in every case, to see how far a claimed shrink holds.
constexpr int fresh_batches = 20;  ///< so many that the shrink on them is as good as the true one

/// An Ornstein-Uhlenbeck course of standard deviation 1 at equal steps.
inline Vector wander(Random& random, Index rows, double step_s, double memory_s) {
  Vector course(rows);
  const double keep = std::exp(-step_s / memory_s), fresh = std::sqrt(1 - keep * keep);
  double value = random.normal();
  for (Index row = 0; row < rows; ++row, value = keep * value + fresh * random.normal()) course[row] = value;
  return course;
}

/// A level that is drawn anew after random times between `shortest` and `longest` samples.
inline Vector random_levels(Random& random, Index samples, const std::vector<double>& levels, int shortest,
                            int longest) {
  Vector course(samples);
  for (Index row = 0; row < samples;) {
    const double level = random.pick(levels);
    for (Index end = row + random.integer(shortest, longest); row < std::min(end, samples); ++row) course[row] = level;
    row = std::min(row, samples);
  }
  return course;
}

inline Vector speed_course(Random& random, const std::string& protocol, Index samples,
                           const std::vector<double>& levels, double only) {
  Vector speed = Vector::Zero(samples);
  const double top = levels.back();
  if (protocol == "rich") return random_levels(random, samples, levels, 4, 50);
  if (protocol == "one-speed") return Vector::Constant(samples, only);
  const Index stop = static_cast<Index>(static_cast<double>(samples) * random.uniform(.55, .85));
  if (protocol == "levels") {
    speed.head(stop).setConstant(random.pick(levels));
    if (speed[0] == 0) speed.head(stop).setConstant(top * .5);
    return speed;
  }
  const int steps = random.integer(3, 5);
  const bool down = random.chance(.3);
  for (Index row = 0; row < stop; ++row) {
    const double stair = static_cast<double>(1 + row * steps / stop) / steps;
    speed[row] = std::round(top * (down ? 1 + 1. / steps - stair : stair) / 100) * 100;
  }
  return speed;
}

inline Campaign random_campaign(Random& random, const Machine& machine, const std::string& protocol) {
  Campaign campaign{protocol, random.log_uniform(.2, 1.2), random.chance(.15), 0, {}};
  const bool poor = protocol == "one-speed";
  const bool coolant_logged = poor ? false : random.chance(.85);
  const int count = poor ? random.integer(6, 7) : random.integer(6, 10);
  const Index samples = random.pick(std::vector<Index>{81, 97, 121, 121, 121, 151, 161});
  const double interval_s = random.pick(std::vector<double>{120, 180, 180, 180, 240});
  std::vector<double> levels;
  for (const double share : {0., 1. / 6, 1. / 3, .5, 2. / 3, .75, 1.})
    levels.push_back(std::round(machine.top_speed_rpm * share / 100) * 100);
  const double only = random.pick(std::vector<double>{levels[3], levels[4], levels[5]});
  const bool seasons = !poor && random.chance(.7);
  const double coldest = seasons ? random.uniform(2, 10) : random.uniform(17, 22);
  const double warmest = seasons ? random.uniform(26, 34) : coldest + random.uniform(1, 4);
  const double draught = random.chance(.6) ? random.log_uniform(.01, .08) : random.log_uniform(.08, .4);
  const double draught_memory_s = random.log_uniform(600, 3000);

  campaign.recorded = static_cast<std::size_t>(count);
  Random later = random.fork(1);
  for (int b = 0; b < count + fresh_batches; ++b) {
    // Fresh batches spread over the same range of room temperatures.
    const double place = b < count ? b : (b - count + .5) * (count - 1) / fresh_batches;
    Random& draw = b < count ? random : later;
    Experiment batch;
    const int label = 1 + (b < count ? b : b - count);
    batch.name = (b < count ? "K" : "F") + std::string(label < 10 ? "0" : "") + std::to_string(label);
    batch.interval_s = interval_s;
    batch.steps = static_cast<int>(interval_s / 10);
    batch.inputs = {"spindle_rpm"};
    if (machine.feeds) batch.inputs.push_back("feed_mm_min");
    if (coolant_logged) batch.inputs.push_back("coolant");
    if (campaign.pump_logged) batch.inputs.push_back("pump");
    batch.input = Matrix::Zero(samples, static_cast<Index>(batch.inputs.size()));
    batch.input.col(0) = speed_course(draw, protocol, samples, levels, only);
    if (machine.feeds && !poor)
      batch.input.col(batch.column("feed_mm_min")) = random_levels(draw, samples, {0, 1500, 3000}, 4, 60);
    if (coolant_logged) batch.input.col(batch.column("coolant")) = random_levels(draw, samples, {0, 1}, 5, 50);
    if (campaign.pump_logged) batch.input.col(batch.column("pump")) = random_levels(draw, samples, {0, 1}, 12, 60);

    const Index rows = batch.fine_rows();
    const double at = coldest + (warmest - coldest) * (place + draw.uniform(-.3, .3)) / std::max(1, count - 1);
    const double period_s = draw.uniform(4, 12) * 3600, phase = draw.uniform(0, 6.283185307179586);
    const Vector slow = wander(draw, rows, batch.step_s(), 5400);
    batch.air_degC.resize(rows);
    for (Index row = 0; row < rows; ++row)
      batch.air_degC[row] =
          at + campaign.air_swing_K *
                   (std::sin(phase + 6.283185307179586 * batch.step_s() * static_cast<double>(row) / period_s) -
                    std::sin(phase) + .7 * (slow[row] - slow[0]));

    // Draughts: one course for the room and one for each part, felt through its own exchange with the air.
    batch.draught_K = Matrix::Zero(rows, machine.plant.cells());
    const Vector room = wander(draw, rows, batch.step_s(), draught_memory_s);
    for (const Lump& lump : machine.lumps) {
      const Vector own = draught * (.5 * room + wander(draw, rows, batch.step_s(), draught_memory_s));
      for (const Index cell : lump.cells) batch.draught_K.col(cell) = own;
    }
    campaign.batches.push_back(std::move(batch));
  }
  return campaign;
}

}  // namespace blind
