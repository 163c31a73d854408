#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/judgement/gap_levels.hpp"
#include "thermfit/diagnosis/judgement/judge.hpp"
#include "thermfit/diagnosis/judgement/proof.hpp"
#include "thermfit/diagnosis/search/search.hpp"
#include "thermfit/effects/setting.hpp"

namespace thermfit {

struct DiagnoseOptions {
  std::vector<std::string> effects;  ///< look for these only; empty: the whole library
  std::vector<std::string> without;  ///< leave these out
  std::uint64_t seed = 1;            ///< of resampling
  SearchOptions search;
  JudgingOptions judging;
};

/// A diagnosis with what it was made from, for views that need the machines and the residuals.
struct Diagnosed {
  Diagnosis diagnosis;
  SearchResult investigation;
  GapResiduals residuals;              ///< held out where the batches allow
  ThermalNetwork calibrated;           ///< the machine after calibration alone
  ThermalNetwork best;                 ///< with the effects found; equal to `calibrated` where none is named
  std::vector<ThermalNetwork> rivals;  ///< fitted machines of the explanations that were listed, best first
};

namespace detail {

inline bool wanted(const std::string& effect, const DiagnoseOptions& options) {
  const auto holds = [&](const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), effect) != list.end();
  };
  return (options.effects.empty() || holds(options.effects)) && !holds(options.without);
}

/// How far the parameters of the machine itself moved, largest first.
inline std::vector<CalibrationMove> calibration_moves(const MapFit& fit) {
  const Index n = fit.coordinates.size();
  const Matrix covariance = fit.covariance();
  std::vector<CalibrationMove> result;
  for (Index j = 0; j < n; ++j) {
    const Parameter& one = fit.parameter(j);
    if (one.kind == Parameter::Kind::effect) continue;
    result.push_back(
        {one.name, one.unit, one.value(0), one.value(fit.coordinates(j)), fit.coordinates(j), covariance(j, j) < 0.5});
  }
  std::stable_sort(result.begin(), result.end(), [](const CalibrationMove& a, const CalibrationMove& b) {
    return std::abs(a.prior_sds) > std::abs(b.prior_sds);
  });
  return result;
}

inline std::vector<RuledOut> ruled_out(const SearchResult& found, const Judgement& judgement) {
  std::vector<RuledOut> result;
  const double before = excess_of(misfit_of(found.seen, found.calibrated.held.residual));
  const bool nothing_lacks = judgement.verdict == Verdict::none || judgement.verdict == Verdict::miscalibration;
  if (before <= 0 || nothing_lacks) return result;
  const auto percent = [](double share) {
    return std::to_string(static_cast<int>(std::lround(100 * std::clamp(share, 0.0, 1.0)))) + " %";
  };
  std::vector<std::string> said;
  for (const FoundEffect& one : judgement.effects) {
    said.push_back(one.effect);
    for (const Rival& rival : one.alternatives) said.push_back(rival.effect);
  }
  for (const Account& one : found.single) {
    const ThermalNetwork::AddedEffect& added = one.effects[0];
    if (std::find(said.begin(), said.end(), added.effect) != said.end()) continue;
    said.push_back(added.effect);
    const double share = 1 - excess_of(misfit_of(found.seen, one.held.residual)) / before;
    std::string reason = share < 0.005 ? "does not shrink the gap on held-out batches"
                                       : "closes " + percent(share) + " of the gap on held-out batches";
    if (share >= 0.005 && !judgement.effects.empty())
      reason +=
          ", the best " + percent(1 - excess_of(misfit_of(found.seen, judgement.nearest->held.residual)) / before);
    result.push_back({added.effect, added.location, std::move(reason)});
  }
  return result;
}

inline std::vector<std::string> weaker_claims(const SearchResult& found, const Setting& setting) {
  std::vector<std::string> result;
  const std::size_t batches = found.seen.batches();
  if (batches < 2)
    result.push_back(
        "One batch only: nothing can be judged on data not used for fitting. Every figure is that of the "
        "fit itself, and a wrong effect may look right.");
  else if (batches < 4)
    result.push_back("Only " + std::to_string(batches) +
                     " batches: held-out figures rest on few data and the interval "
                     "of the shrink is wide.");
  for (const std::string& input : setting.constant_inputs)
    result.push_back("Input " + input + " never changes: effects that it drives cannot be told from calibration.");
  return result;
}

}  // namespace detail

/// Diagnoses why `network` disagrees with `real`. Throws Error on a campaign that cannot drive it, an unknown name in
/// `effects` or `without`, or missing times.
inline Diagnosed diagnose_fully(const ThermalNetwork& network, const Campaign& real, const EffectLibrary& library,
                                const DiagnoseOptions& options = {}) {
  for (const auto* list : {&options.effects, &options.without})
    for (const std::string& name : *list) library.at(name);
  if (real.empty()) throw Error("campaign", "no batches", "at least one, better five or more");
  for (const Batch& batch : real)
    if (batch.rows() < 8)
      throw Error(batch.source.empty() ? "batch " + batch.name : batch.source,
                  std::to_string(batch.rows()) + " samples", "at least 8", "a diagnosis compares courses in time");
  const Setting setting = setting_of(network, real);
  std::vector<ThermalNetwork::AddedEffect> candidates;
  for (ThermalNetwork::AddedEffect& one : library.candidates(setting))
    if (detail::wanted(one.effect, options)) candidates.push_back(std::move(one));

  Diagnosed result;
  result.investigation = investigate(network, real, library, candidates, options.search);
  const SearchResult& found = result.investigation;
  const SearchContext inquiry{found.seen, found.machine, library, found.folds, options.search.threads};
  Judgement judgement = judge(inquiry, found, options.judging);

  result.residuals.as_simulated = found.as_given;
  result.residuals.calibrated = found.calibrated.held.residual;
  result.residuals.with_effect = judgement.best->held.residual;
  demand_proof(judgement, result.residuals, found, library, options.judging, options.seed);

  Diagnosis& diagnosis = result.diagnosis;
  diagnosis.machine = network.name;
  diagnosis.batches = found.seen.names;
  diagnosis.verdict = judgement.verdict;
  diagnosis.effects = judgement.effects;
  diagnosis.grounds = judgement.grounds;
  result.residuals.noise = noise_floor(found.seen, judgement.nearest->held.residual);
  diagnosis.gap = gap_of(found.seen, result.residuals, options.seed, !found.folds.empty());
  diagnosis.calibration = detail::calibration_moves(judgement.best->fit);
  diagnosis.ruled_out = detail::ruled_out(found, judgement);
  diagnosis.weaker_claims = detail::weaker_claims(found, setting);
  result.calibrated = found.calibrated.fit.network();
  result.best = judgement.best->fit.network();
  const auto fitted = [&](const Rival& rival) {
    for (const auto* accounts : {&found.single, &found.several})
      for (const Account& account : *accounts) {
        if (account.effects.size() != judgement.best->effects.size()) continue;
        for (const ThermalNetwork::AddedEffect& added : account.effects)
          if (added.effect == rival.effect && added.location == rival.location && added.driver == rival.driver)
            return &account;
      }
    return static_cast<const Account*>(nullptr);
  };
  for (const FoundEffect& one : judgement.effects)
    for (const Rival& rival : one.alternatives)
      if (const Account* account = fitted(rival)) result.rivals.push_back(account->fit.network());
  return result;
}

inline Diagnosis diagnose(const ThermalNetwork& network, const Campaign& real, const EffectLibrary& library,
                          const DiagnoseOptions& options = {}) {
  return diagnose_fully(network, real, library, options).diagnosis;
}

}  // namespace thermfit
