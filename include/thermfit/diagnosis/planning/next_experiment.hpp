#pragma once

/// Which experiment tells the surviving explanations apart best per machine hour.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/map_fit.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/planning/schedules.hpp"
#include "thermfit/statistics/quantiles.hpp"

namespace thermfit {

/// An explanation as a fitted machine.
struct FittedRival {
  Rival rival;             ///< which explanation
  ThermalNetwork network;  ///< calibrated, with its effects at fitted values
};

/// Probability of taking one explanation for the other that a plan is to reach.
constexpr double wanted_confusion = .05;
/// Runs of one schedule that are asked for at most.
constexpr int most_runs = 4;

namespace detail {

inline double normal_below(double z) { return .5 * std::erfc(-z / std::sqrt(2.)); }

/// Distance between two machines on a schedule in standard deviations, after calibration has moved as far as prior and
/// the data so far let it: d = y_a - y_b whitened, D^2 = d'd - d'J (J'J + H)^-1 J'd.
template <typename Scalar = double>
double distance(const ThermalNetwork& a, const ThermalNetwork& b, const Schedule& schedule, const MachineRecord& seen,
                const MapFit& calibrated, const std::vector<ResidualNoise>& noise, const MatrixX<Scalar>& information,
                const EffectLibrary& library) {
  const std::vector<Excitation> plan{schedule.excitation};
  const Simulation own = simulate(with_swap(a, schedule), plan, library)[0],
                   other = simulate(with_swap(b, schedule), plan, library)[0];
  const Simulation base = simulate(calibrated.network(), plan, library, calibrated.parameters)[0];
  const VectorX<Scalar> slopes = calibrated.slopes();
  const MatrixX<Scalar>&ours = own.channels, &theirs = other.channels;
  const RowMatrixX<Scalar>& tangents = base.jacobian;
  const Index samples = schedule.excitation.samples();
  MatrixX<Scalar> normal = information;
  VectorX<Scalar> along = VectorX<Scalar>::Zero(slopes.size());
  double square = 0;
  for (std::size_t c = 0; c < seen.channels.size(); ++c) {
    const Index column = seen.channels[c].column;
    const Whitener whitener(noise[c], schedule.excitation.time_s);
    VectorX<Scalar> difference = ours.col(column) - theirs.col(column);
    MatrixX<Scalar> jacobian = tangents.middleRows(column * samples, samples) * slopes.asDiagonal();
    whitener.apply(difference);
    whitener.apply(jacobian);
    normal.noalias() += jacobian.transpose() * jacobian;
    along.noalias() += jacobian.transpose() * difference;
    square += difference.squaredNorm();
  }
  return std::sqrt(std::max(0., square - along.dot(normal.llt().solve(along))));
}

inline NextExperiment without_forecast() {
  NextExperiment result;
  result.expected_confidence = result.confusion_before = result.confusion_after =
      std::numeric_limits<double>::quiet_NaN();
  return result;
}

}  // namespace detail

/// Plans for the first two of `rivals` (strongest first), on the menu of schedules.
///
/// The probability of taking one for the other is Phi(-D/2), D their distance after calibration is projected out; with
/// equal detectability d and cosine c of the two signatures D^2 = 2 d^2 (1 - c), so this is Phi(-d sqrt((1 - c) / 2)).
/// The distance reached so far follows from their probabilities, and squares of distances add. The schedule with the
/// largest D^2 per hour is taken, as often (up to four times) as it takes to get below 5 %. `noise` is what the best
/// explanation leaves in each channel. Allocates.
template <typename Scalar = double>
NextExperiment next_experiment(const std::vector<FittedRival>& rivals, const MachineRecord& seen,
                               const MapFit& calibrated, const std::vector<ResidualNoise>& noise,
                               const EffectLibrary& library) {
  NextExperiment result;
  if (rivals.size() < 2) return result;
  const FittedRival &a = rivals[0], &b = rivals[1];
  for (const FittedRival& one : rivals) result.separates.push_back(one.rival);
  const double known = std::max(a.rival.confidence + b.rival.confidence, 1e-9);
  result.confusion_before = std::clamp(b.rival.confidence / known, 1e-6, .5);
  const double reached = std::pow(2 * normal_quantile(result.confusion_before), 2);
  const MatrixX<Scalar> information = calibrated.posterior_information();
  std::vector<Schedule> menu = experiment_menu(calibrated.prior, seen);
  std::vector<std::string> suspects;
  for (const FittedRival* rival : {&a, &b})
    for (const ThermalNetwork::AddedEffect& added : rival->network.effects) suspects.push_back(added.location);
  for (Schedule& swap : sensor_swaps(calibrated.prior, seen, suspects)) menu.push_back(std::move(swap));
  const PlannedBlock* best = nullptr;
  double best_square = 0;
  for (const Schedule& schedule : menu) {
    const double D =
        detail::distance<Scalar>(a.network, b.network, schedule, seen, calibrated, noise, information, library);
    const double hours = schedule.block.machine_hours;
    if (!std::isfinite(D) || (best && D * D / hours <= best_square / best->machine_hours)) continue;
    best = &schedule.block;
    best_square = D * D;
  }
  if (!best) return result;
  const double wanted = std::pow(2 * normal_quantile(wanted_confusion), 2);
  PlannedBlock plan = *best;
  while (plan.times < most_runs && reached + plan.times * best_square < wanted) ++plan.times;
  plan.machine_hours *= plan.times;
  result.confusion_after = detail::normal_below(-std::sqrt(reached + plan.times * best_square) / 2);
  result.expected_confidence = 1 - result.confusion_after;
  result.plan.push_back(std::move(plan));
  if (result.confusion_after > wanted_confusion) result.remark = NextExperiment::Remark::nothing_separates;
  return result;
}

/// A plan without a network: what shows the effect found by itself, then what shows its strongest rival. How far it
/// separates them is not known.
inline NextExperiment experiment_by_kind(const FoundEffect& found, const EffectLibrary& library, double batch_hours) {
  NextExperiment result = detail::without_forecast();
  if (found.alternatives.empty()) return result;
  const Rival& rival = found.alternatives[0];
  result.separates = {{found.effect, found.location, found.driver, found.confidence}, rival};
  for (const Rival& one : result.separates) {
    PlannedBlock block = library.at(one.effect).shown_by({one.effect, one.location, one.driver, {}}, batch_hours);
    const bool new_kind = result.plan.empty() || result.plan[0].kind != block.kind ||
                          (block.kind == ScheduleKind::toggle && result.plan[0].subject != block.subject);
    if (new_kind) result.plan.push_back(std::move(block));
  }
  result.remark = NextExperiment::Remark::not_foreseeable;
  return result;
}

/// A plan without a network for an effect that is only suspected: what shows it by itself.
inline NextExperiment experiment_for_suspect(const FoundEffect& suspect, const EffectLibrary& library,
                                             double batch_hours) {
  NextExperiment result = detail::without_forecast();
  result.separates = {{suspect.effect, suspect.location, suspect.driver, suspect.confidence}};
  result.plan = {
      library.at(suspect.effect).shown_by({suspect.effect, suspect.location, suspect.driver, {}}, batch_hours)};
  result.remark = NextExperiment::Remark::not_foreseeable;
  return result;
}

namespace detail {

/// By how much the share of the gap must exceed that of the time for a condition to be worth a schedule.
constexpr double telling_share = .05;
/// Prior deviations that a parameter must have moved to be worth a schedule.
constexpr double worth_pinning = .5;

/// The condition under which the gap arises more than its time explains, or null.
inline const ConditionShare* telling_condition(const std::vector<ConditionShare>& conditions) {
  const ConditionShare* telling = nullptr;
  for (const ConditionShare& one : conditions)
    if (one.factor != "batch" && one.factor != "phase" && one.settable &&
        (!telling || one.share - one.share_of_time > telling->share - telling->share_of_time))
      telling = &one;
  return telling && telling->share > telling->share_of_time + telling_share ? telling : nullptr;
}

}  // namespace detail

/// What to measure when no two explanations compete: after a miscalibration the schedule that pins the parameter that
/// moved most and is least pinned; for a gap without a name one that isolates where and when it arises.
inline NextExperiment experiment_without_rivals(const Diagnosis& diagnosis, double batch_hours) {
  NextExperiment result = detail::without_forecast();
  const auto plan = [&](ScheduleKind kind, SchedulePurpose purpose, const std::string& subject, double batches) {
    result.plan.push_back({kind, purpose, subject, "", "", 0, 1, batches * batch_hours});
  };
  if (diagnosis.verdict == Verdict::unknown) {
    if (const ConditionShare* telling = detail::telling_condition(diagnosis.where.conditions))
      plan(ScheduleKind::toggle, SchedulePurpose::locates, telling->factor, 1);
    plan(ScheduleKind::idle_day, SchedulePurpose::locates, "", 4);
    if (!diagnosis.where.places.empty()) {
      result.remark = NextExperiment::Remark::thermometer_near;
      result.subject = diagnosis.where.places[0].name;
    }
  } else if (diagnosis.verdict == Verdict::miscalibration) {
    for (const CalibrationMove& move : diagnosis.calibration)
      if (!move.pinned && std::abs(move.prior_sds) > detail::worth_pinning) {
        result.remark = NextExperiment::Remark::not_pinned;
        result.subject = move.parameter;
        plan(ScheduleKind::cool_down, SchedulePurpose::pins, "", 1.5);
        break;
      }
  }
  return result;
}

THERMFIT_COMPILED_TEMPLATE(NextExperiment next_experiment<double>(const std::vector<FittedRival>&, const MachineRecord&,
                                                                  const MapFit&, const std::vector<ResidualNoise>&,
                                                                  const EffectLibrary&));

}  // namespace thermfit
