#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/calibration/fitted_batches.hpp"
#include "thermfit/calibration/lone_input.hpp"
#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/claims.hpp"
#include "thermfit/diagnosis/data_problems.hpp"
#include "thermfit/diagnosis/planning/next_experiment.hpp"
#include "thermfit/diagnosis/sides/bad_cells.hpp"
#include "thermfit/diagnosis/sides/compare_machine.hpp"
#include "thermfit/diagnosis/sides/free_datum.hpp"
#include "thermfit/diagnosis/sides/unlike_sides.hpp"
#include "thermfit/diagnosis/sides/warm_side.hpp"
#include "thermfit/diagnosis/where/remaining.hpp"
#include "thermfit/diagnosis/where/transfer.hpp"
#include "thermfit/diagnosis/where/where.hpp"
#include "thermfit/effects/setting.hpp"

namespace thermfit {

/// What diagnose() looks for, how hard, and by which numbers it decides.
struct DiagnoseOptions {
  std::vector<std::string> effects;  ///< look for these only; empty: the whole library
  std::vector<std::string> without;  ///< leave these out
  std::uint32_t seed = 1;            ///< of resampling
  SearchOptions search;              ///< how hard to look
  Thresholds thresholds;             ///< between evidence and verdict
  SideLimits sides;                  ///< when data and machine are not written down alike
};

/// Fewest samples of a batch whose course in time can be compared.
constexpr Index least_samples = 8;

namespace detail {

/// The candidates of the effects that are asked for.
inline std::vector<ThermalNetwork::AddedEffect> wanted_candidates(const EffectLibrary& library, const Setting& setting,
                                                                  const DiagnoseOptions& options) {
  for (const auto* list : {&options.effects, &options.without})
    for (const std::string& name : *list) library.at(name);
  const auto holds = [](const std::vector<std::string>& list, const std::string& effect) {
    return std::find(list.begin(), list.end(), effect) != list.end();
  };
  std::vector<ThermalNetwork::AddedEffect> result;
  for (ThermalNetwork::AddedEffect& one : library.candidates(setting))
    if ((options.effects.empty() || holds(options.effects, one.effect)) && !holds(options.without, one.effect))
      result.push_back(std::move(one));
  return result;
}

/// A posterior variance below this share of the prior's: the data, not the prior, decide the parameter.
constexpr double decided_variance = 0.5;

/// How far the parameters of the machine itself moved, largest first.
template <typename Scalar = double>
std::vector<CalibrationMove> calibration_moves(const MapFit& fit) {
  const MatrixX<Scalar> covariance = fit.covariance();
  std::vector<CalibrationMove> result;
  for (Index j = 0; j < covariance.rows(); ++j) {
    const Parameter& one = fit.parameter(j);
    if (one.kind == Parameter::Kind::effect || one.of_batch()) continue;
    const double moved = fit.coordinates(j);
    result.push_back({one.name, one.unit, one.value(0), one.value(moved), moved, covariance(j, j) < decided_variance});
  }
  std::stable_sort(result.begin(), result.end(), [](const CalibrationMove& a, const CalibrationMove& b) {
    return std::abs(a.prior_sds) > std::abs(b.prior_sds);
  });
  return result;
}

/// Half a percent of the gap: less is no shrink.
constexpr double least_share = 0.005;

/// The best place of every effect that is neither named nor a rival, with what it closes.
template <typename Scalar = double>
std::vector<RuledOut> ruled_out(const SearchResult& found, const Judgement& judgement) {
  std::vector<RuledOut> result;
  const auto excess = [&](const Account& one) { return excess_of(misfit_of<Scalar>(found.seen, one.held.residual)); };
  const double before = excess(found.calibrated);
  const bool nothing_lacks = judgement.verdict == Verdict::none || judgement.verdict == Verdict::miscalibration;
  if (before <= 0 || nothing_lacks) return result;
  std::vector<std::string> said;
  for (const auto* told : {&judgement.effects, &judgement.suspicions.parts, &judgement.suspicions.suspected})
    for (const FoundEffect& one : *told) {
      said.push_back(one.effect);
      for (const Rival& rival : one.alternatives) said.push_back(rival.effect);
    }
  for (const Account& one : found.single) {
    const ThermalNetwork::AddedEffect& added = one.effects[0];
    if (std::find(said.begin(), said.end(), added.effect) != said.end()) continue;
    said.push_back(added.effect);
    RuledOut entry{added.effect, added.location, RuledOutBy::no_shrink, 1 - excess(one) / before};
    if (entry.value >= least_share) {
      entry.by = RuledOutBy::share;
      if (!judgement.effects.empty()) entry.best = 1 - excess(found.at(judgement.nearest)) / before;
    }
    result.push_back(std::move(entry));
  }
  const auto most = std::max_element(result.begin(), result.end(),
                                     [](const RuledOut& a, const RuledOut& b) { return a.value < b.value; });
  if (most != result.end() && most->by == RuledOutBy::share && !(most->value < most->best))
    most->by = RuledOutBy::remains;  // what closes most is not ruled out
  return result;
}

/// That something acts just there is not beyond doubt where the effect-free view says another place: suspected at most.
inline void doubt_parts(Diagnosis& diagnosis, double doubt, const Thresholds& thresholds) {
  for (FoundEffect& one : std::exchange(diagnosis.parts, {})) {
    one.confidence *= doubt;
    for (Rival& rival : one.alternatives) rival.confidence *= doubt;
    if (one.confidence < thresholds.least_suspected)
      diagnosis.ruled_out.insert(diagnosis.ruled_out.begin(),
                                 {one.effect, one.location, RuledOutBy::remains, one.closes});
    else
      diagnosis.suspected.push_back(std::move(one));
  }
}

/// What few batches, constant inputs and inputs that are on in one batch alone do not allow to say.
template <typename Scalar = double>
std::vector<WeakerClaim> claims_of(const SearchResult& found, const ThermalNetwork& given, const Setting& setting) {
  std::vector<WeakerClaim> result = weaker_claims(found.seen.batches(), setting.constant_inputs);
  for (const LoneInput& one : lone_inputs(given, found.seen))
    result.push_back({WeakerClaim::Kind::lone_input,
                      found.seen.excitations[0].input_names[static_cast<std::size_t>(one.input)],
                      found.seen.names[one.batch],
                      {},
                      found.seen.batches()});
  return result;
}

/// What remains in the channel of the gap; where the gap is that of all temperatures, in each of them.
template <typename Scalar = double>
Remaining remaining_of(const SearchResult& found, const Judgement& judgement, const Gap& gap, const Campaign& real,
                       unsigned seed) {
  Remaining result;
  result.white = true;
  result.unexplained = unexplained(gap.rms.with_effect, gap.rms.noise);
  for (const std::size_t c : told_channels(found.seen)) {
    const GapLevels& rms = gap.per_sensor[c].rms;
    auto [look, white] = remaining_look(real, without_missing<Scalar>(judgement.levels.with_effect[c]), rms.with_effect,
                                        rms.noise, seed);
    if (!found.seen.channels[c].displacement) look.channel = found.seen.channels[c].name;
    result.white = result.white && white;
    result.looks.push_back(std::move(look));
  }
  return result;
}

/// What the gap costs a compensation model, where the displacement was measured and nothing is missing.
template <typename Scalar = double>
Transfer transfer_by_level(const SearchResult& found, const Judgement& judgement, const ThermalNetwork& given,
                           const Campaign& real, const EffectLibrary& library) {
  const ObservedChannel& told = found.seen.channels[told_channels(found.seen)[0]];
  if (!told.displacement) return {};
  for (const Batch& batch : real) {
    const MatrixX<Scalar>&temperatures = batch.temperatures.values, &errors = batch.errors.values;
    if (!temperatures.allFinite() || !errors.allFinite()) return {};
  }
  const auto simulated = [&](const ThermalNetwork& network) {
    return simulated_campaign<Scalar>(network, real, library);
  };
  return transfer_of(
      {simulated(given), simulated(found.calibrated.fit.network()), simulated(found.at(judgement.best).fit.network())},
      real, told.name);
}

/// The fitted machines of the first effect and of those of its rivals that were fitted beside as many effects.
template <typename Scalar = double>
std::vector<FittedRival> fitted_rivals(const SearchResult& found, const Judgement& judgement) {
  std::vector<FittedRival> result;
  if (judgement.effects.empty()) return result;
  const Account& best = found.at(judgement.best);
  const FoundEffect& first = judgement.effects[0];
  result.push_back({{first.effect, first.location, first.driver, first.confidence}, best.fit.network()});
  const auto fitted = [&](const Rival& rival) -> const Account* {
    for (const auto* accounts : {&found.single, &found.several})
      for (const Account& account : *accounts) {
        if (account.effects.size() != best.effects.size()) continue;
        for (const ThermalNetwork::AddedEffect& added : account.effects)
          if (same_place(added, {rival.effect, rival.location, rival.driver, {}})) return &account;
      }
    return nullptr;
  };
  for (const Rival& rival : first.alternatives)
    if (const Account* account = fitted(rival)) result.push_back({rival, account->fit.network()});
  return result;
}

/// The rival of an effect that is only suspected.
constexpr const char* calibration_alone = "calibration alone";

template <typename Scalar = double>
NextExperiment experiment_after(const SearchResult& found, const Judgement& judgement, const Diagnosis& diagnosis,
                                const EffectLibrary& library) {
  std::vector<FittedRival> rivals = fitted_rivals<Scalar>(found, judgement);
  if (judgement.effects.empty() && !diagnosis.suspected.empty()) {
    const FoundEffect& one = diagnosis.suspected[0];
    rivals = {{{one.effect, one.location, one.driver, one.confidence}, found.single[0].fit.network()},
              {{calibration_alone, "", "", 1 - one.confidence}, found.calibrated.fit.network()}};
  }
  const Account& nearest = found.single.empty() ? found.calibrated : found.single[0];
  if (rivals.size() > 1) return next_experiment(rivals, found.seen, found.calibrated.fit, nearest.fit.noise, library);
  double hours = 0;
  for (const Vector& time_s : found.seen.time_s) hours = std::max(hours, time_s(time_s.size() - 1) / 3600);
  return experiment_without_rivals(diagnosis, hours);
}

inline void require_courses(const Campaign& real) {
  if (real.empty()) throw Error("campaign", "no batches", "at least one, better five or more");
  for (const Batch& batch : real)
    if (batch.rows() < least_samples)
      throw Error(batch.source.empty() ? "batch " + batch.name : batch.source,
                  std::to_string(batch.rows()) + " samples", "at least " + std::to_string(least_samples),
                  "a diagnosis compares courses in time");
}

}  // namespace detail

/// Diagnoses why the machine `given` disagrees with the measured batches `recorded`: leaves out cells that are no
/// readings; looks whether both are written down alike (units, signs, clocks, columns), and says so and nothing else
/// where they are not; leaves the zero of a probe free that is set anew; fits the starts of batches that begin out of
/// equilibrium one by one unless the machine file says how they start; calibrates it, tries every effect of `library`
/// at every place together with the calibration, judges on batches not used, and says where the gap lies, what remains
/// and what to measure next. The result is complete. Throws Error on a campaign that cannot drive the machine, an
/// unknown name in `options`, or missing times. Allocates.
template <typename Scalar = double>
Diagnosis diagnose(const ThermalNetwork& given, const Campaign& recorded, const EffectLibrary& library,
                   const DiagnoseOptions& options = {}) {
  detail::require_courses(recorded);
  ThermalNetwork machine = given;
  WithoutBadCells clean = without_bad_cells(recorded, DataProblem::Side::measured);
  Campaign& real = clean.campaign;
  std::vector<DataProblem> problems = std::move(clean.left_out);
  const auto note = [&](std::vector<DataProblem> more) {
    for (DataProblem& one : more) problems.push_back(std::move(one));
  };
  {
    std::vector<DataProblem> warm = warm_start_problem(machine, excitations_of(machine, real));
    ThermalNetwork placed =
        with_complete_effects(with_placements(warm.empty() ? machine : with_fitted_start(machine)), library);
    const MachineRecord seen = observations_of(placed, real);
    placed.uncertainty.start_share = start_share_sd(placed, seen);
    placed = with_batch_numbers(std::move(placed), seen);
    note(compare_machine(placed, real, library, options.sides));
    if (sides_unlike(problems)) {
      note(data_problems(machine, real, clean.others));
      Diagnosis unlike =
          diagnosis_of_unlike_sides<Scalar>(sides_of<Scalar>(placed, seen, library), std::move(problems));
      unlike.machine = machine.name;
      return unlike;
    }
    if (!warm.empty()) {
      machine = with_fitted_start(std::move(machine));
      warm[0].rule = starts_were_fitted;
    }
    note(std::move(warm));
  }
  note(data_problems(machine, real, clean.others));
  free_datums<Scalar>(machine, real, problems);
  const Setting setting = setting_of(machine, real);
  const SearchResult found =
      search(machine, real, library, detail::wanted_candidates(library, setting, options), options.search);
  const SearchContext context{found.seen, found.machine, library, found.folds, options.search.threads};
  const Judgement judgement = judge(context, found, options.thresholds, options.seed);

  Diagnosis diagnosis;
  diagnosis.machine = machine.name;
  diagnosis.batches = found.seen.names;
  diagnosis.verdict = judgement.verdict;
  diagnosis.effects = judgement.effects;
  diagnosis.parts = judgement.suspicions.parts;
  diagnosis.suspected = judgement.suspicions.suspected;
  diagnosis.support = judgement.support;
  diagnosis.gap = gap_of(found.seen, judgement.levels, options.seed, !found.folds.empty());
  diagnosis.gap.transfer = detail::transfer_by_level<Scalar>(found, judgement, machine, real, library);
  diagnosis.where = where_of(found, judgement, machine, real, library);
  diagnosis.remaining = detail::remaining_of<Scalar>(found, judgement, diagnosis.gap, real, options.seed);
  diagnosis.calibration = detail::calibration_moves<Scalar>(found.at(judgement.best).fit);
  diagnosis.fitted_batches = fitted_batches<Scalar>(found.at(judgement.best).fit, found.seen);
  diagnosis.ruled_out = detail::ruled_out<Scalar>(found, judgement);
  if (!diagnosis.where.agrees) detail::doubt_parts(diagnosis, judgement.suspicions.doubt, options.thresholds);
  diagnosis.data_problems = std::move(problems);
  diagnosis.weaker_claims = detail::claims_of<Scalar>(found, machine, setting);
  diagnosis.judged_by = named_numbers(options.thresholds);
  diagnosis.judged_by.emplace_back("evidence_power", evidence_power);
  diagnosis.with_effects = with_own_datums(found.at(judgement.best).fit.network());
  diagnosis.with_effects.batches.clear();
  diagnosis.next_experiment = detail::experiment_after<Scalar>(found, judgement, diagnosis, library);
  return diagnosis;
}

THERMFIT_COMPILED_TEMPLATE(Diagnosis diagnose<double>(const ThermalNetwork&, const Campaign&, const EffectLibrary&,
                                                      const DiagnoseOptions&));

}  // namespace thermfit
