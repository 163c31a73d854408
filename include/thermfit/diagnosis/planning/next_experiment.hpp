#pragma once

/// Which experiment tells the surviving explanations apart best per machine hour.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "thermfit/calibration/map_fit.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/planning/schedules.hpp"

namespace thermfit {

/// An explanation as a fitted machine.
struct FittedRival {
  std::string name;
  ThermalNetwork network;
  double probability = 0;
};

namespace detail {

inline double normal_below(double z) { return .5 * std::erfc(-z / std::sqrt(2.)); }

/// z with normal_below(z) = p, by bisection; p between 1e-9 and 1 - 1e-9.
inline double normal_quantile(double p) {
  double low = -6, high = 6;
  for (int k = 0; k < 60; ++k) (normal_below((low + high) / 2) < p ? low : high) = (low + high) / 2;
  return (low + high) / 2;
}

/// Distance between two machines on a schedule in standard deviations, after calibration has moved as far as prior and
/// the data so far let it: d = y_a - y_b whitened, D^2 = d'd - d'J (J'J + H)^-1 J'd.
inline double distance(const FittedRival& a, const FittedRival& b, const Schedule& schedule, const MachineRecord& seen,
                       const MapFit& calibrated, const std::vector<ResidualNoise>& noise, const Matrix& information,
                       const EffectLibrary& library) {
  const std::vector<Excitation> plan{schedule.excitation};
  const Simulation own = simulate(with_swap(a.network, schedule), plan, library)[0],
                   other = simulate(with_swap(b.network, schedule), plan, library)[0];
  const Simulation base = simulate(calibrated.network(), plan, library, calibrated.parameters)[0];
  const Vector slopes = calibrated.slopes();
  const Index samples = schedule.excitation.samples();
  Matrix normal = information;
  Vector along = Vector::Zero(slopes.size());
  double square = 0;
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    const Index column = seen.channels[c].column;
    const Whitener whitener(noise[c], schedule.excitation.time_s);
    Vector difference = own.channels.col(column) - other.channels.col(column);
    Matrix jacobian = base.jacobian.middleRows(column * samples, samples) * slopes.asDiagonal();
    whitener.apply(difference);
    whitener.apply(jacobian);
    normal.noalias() += jacobian.transpose() * jacobian;
    along.noalias() += jacobian.transpose() * difference;
    square += difference.squaredNorm();
  }
  return std::sqrt(std::max(0., square - along.dot(normal.llt().solve(along))));
}

}  // namespace detail

/// Plans for the first two of `rivals` (strongest first), on the menu of schedules.
///
/// The probability of taking one for the other is Phi(-D/2), D their distance after calibration is projected out; with
/// equal detectability d and cosine c of the two signatures D^2 = 2 d^2 (1 - c), so this is Phi(-d sqrt((1 - c) / 2)).
/// The distance reached so far follows from their probabilities, and squares of distances add. The schedule with the
/// largest D^2 per hour is taken, as often (up to four times) as it takes to get below 5 %. `noise` is what the best
/// explanation leaves in each channel.
inline NextExperiment next_experiment(const std::vector<FittedRival>& rivals, const MachineRecord& seen,
                                      const MapFit& calibrated, const std::vector<ResidualNoise>& noise,
                                      const EffectLibrary& library) {
  NextExperiment result;
  if (rivals.size() < 2) return result;
  const FittedRival &a = rivals[0], &b = rivals[1];
  for (const FittedRival& one : rivals) result.separates.push_back(one.name);
  result.confusion_before = std::clamp(b.probability / std::max(a.probability + b.probability, 1e-9), 1e-6, .5);
  const double reached = std::pow(2 * detail::normal_quantile(result.confusion_before), 2);
  const Matrix information = calibrated.posterior_information();
  const Schedule* best = nullptr;
  std::vector<Schedule> menu = experiment_menu(calibrated.prior, seen);
  std::vector<std::string> suspects;
  for (const FittedRival* rival : {&a, &b})
    for (const ThermalNetwork::AddedEffect& added : rival->network.effects) suspects.push_back(added.location);
  for (Schedule& swap : sensor_swaps(calibrated.prior, seen, suspects)) menu.push_back(std::move(swap));
  double best_square = 0;
  for (const Schedule& schedule : menu) {
    const double D = detail::distance(a, b, schedule, seen, calibrated, noise, information, library);
    if (!std::isfinite(D) || (best && D * D / schedule.hours() <= best_square / best->hours())) continue;
    best = &schedule;
    best_square = D * D;
  }
  if (!best) return result;
  const double wanted = std::pow(2 * detail::normal_quantile(.05), 2);
  int times = 1;
  while (times < 4 && reached + times * best_square < wanted) ++times;
  result.confusion_after = detail::normal_below(-std::sqrt(reached + times * best_square) / 2);
  result.expected_confidence = 1 - result.confusion_after;
  result.plan.push_back(
      {best->name, best->how + (times > 1 ? ", " + std::to_string(times) + " times" : ""), times * best->hours()});
  if (result.confusion_after > .05)
    result.why = "no schedule of the menu separates " + a.name + " from " + b.name +
                 " well; a sensor at the place in question would";
  return result;
}

/// The schedule that shows an effect by itself, where no network tells what each would show.
inline PlannedBlock isolating_block(const FoundEffect& effect, double batch_hours) {
  const auto one_of = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), effect.effect) != names.end();
  };
  if (one_of({"sensor-offset", "sensor-gain", "sensor-drift", "sensor-lag"}))
    return {"sensor swap", "exchange " + effect.location + " with a trusted thermometer, then repeat a batch",
            batch_hours};
  if (one_of({"friction-law", "forced-convection", "speed-shift", "joint-conductance"}))
    return {"speed stair", "each speed held until the machine settles", 1.25 * batch_hours};
  if (one_of({"probe-drift", "ambient-drift", "missing-link"}))
    return {"idle day", "everything off, room logged", 4 * batch_hours};
  if (one_of({"coolant", "heat-source"}) && !effect.driver.empty() && effect.driver != "constant")
    return {effect.driver + " toggle", "only " + effect.driver + " on and off, twice, everything else held",
            batch_hours};
  if (one_of({"initial-gradient"})) return {"repeat", "the first batch again, after a night at rest", batch_hours};
  return {"cool-down", "full speed, then off for twice as long", 1.5 * batch_hours};
}

/// A plan without a network: what isolates the effect found, then what isolates its strongest rival. How far it
/// separates them is not known.
inline NextExperiment experiment_by_kind(const FoundEffect& found, double batch_hours) {
  NextExperiment result;
  result.expected_confidence = result.confusion_before = result.confusion_after = std::nan("");
  if (found.alternatives.empty()) return result;
  const Rival& rival = found.alternatives[0];
  result.separates = {found.effect + " at " + found.location, rival.effect + " at " + rival.location};
  FoundEffect other;
  other.effect = rival.effect;
  other.location = rival.location;
  other.driver = rival.driver;
  result.plan = {isolating_block(found, batch_hours), isolating_block(other, batch_hours)};
  if (result.plan[0].schedule == result.plan[1].schedule) result.plan.pop_back();
  result.why = "without the network the probability of confusion after the plan cannot be given";
  return result;
}

/// What to measure when no two explanations compete: after a miscalibration the schedule that pins the parameter that
/// moved most and is least pinned; for a gap without a name one that isolates where and when it arises.
inline NextExperiment experiment_without_rivals(const Diagnosis& diagnosis, double batch_hours) {
  NextExperiment result;
  result.expected_confidence = result.confusion_before = result.confusion_after = std::nan("");
  if (diagnosis.verdict == Verdict::unknown) {
    const ConditionShare* telling = nullptr;
    for (const ConditionShare& one : diagnosis.where.conditions)
      if (one.factor != "batch" && one.factor != "phase" &&
          (!telling || one.share - one.share_of_time > telling->share - telling->share_of_time))
        telling = &one;
    if (telling && telling->share > telling->share_of_time + .05)
      result.plan.push_back(
          {telling->factor + " toggle",
           "hold everything else, step only " + telling->factor + " on and off, twice, long enough to settle",
           batch_hours});
    result.plan.push_back(
        {"idle day", "everything off, room logged: what remains then is not driven by the spindle", 4 * batch_hours});
    if (!diagnosis.where.places.empty())
      result.why = "add a temperature sensor near " + diagnosis.where.places[0].name + ", where the gap lies most";
  } else if (diagnosis.verdict == Verdict::miscalibration) {
    for (const CalibrationMove& move : diagnosis.calibration)
      if (!move.pinned && std::abs(move.prior_sds) > .5) {
        result.why = move.parameter + " is not pinned by these data";
        result.plan.push_back({"cool-down",
                               "full speed, then off for twice as long: capacities and conductances separate",
                               1.5 * batch_hours});
        break;
      }
  }
  return result;
}

}  // namespace thermfit
