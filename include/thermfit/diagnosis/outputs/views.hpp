#pragma once

/// What a paired diagnosis found, told in figures: gap by stage, where it lies, what remains, what cannot be said.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "thermfit/diagnosis/claims.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/judgement/shrink.hpp"
#include "thermfit/diagnosis/outputs/paired_channel.hpp"
#include "thermfit/diagnosis/planning/next_experiment.hpp"
#include "thermfit/diagnosis/where/conditions.hpp"
#include "thermfit/diagnosis/where/periods.hpp"
#include "thermfit/diagnosis/where/remaining.hpp"

namespace thermfit::detail {

class OutputViews {
 public:
  /// `first` are the channels with calibration alone, `last` with all effects; `told` is the channel the gap is told
  /// for.
  OutputViews(const PairedCampaign& campaign, const EffectLibrary& library, const std::vector<PairedChannel>& first,
              const std::vector<PairedChannel>& last, Index told, unsigned seed)
      : campaign_(campaign), library_(library), first_(first), last_(last), told_(told), seed_(seed) {}

  void tell(Diagnosis& result) {
    tell_gap(result);
    tell_where(result);
    tell_limits(result);
    double hours = 0;
    for (const PairedBatch& batch : campaign_.batches)
      hours = std::max(hours, batch.time_s(batch.time_s.size() - 1) / 3600);
    result.next_experiment = result.effects.empty() ? experiment_without_rivals(result, hours)
                                                    : experiment_by_kind(result.effects[0], library_, hours);
  }

 private:
  /// What the simulator leaves on batches left out: without the measured temperatures that judged the displacement.
  static Vector residual_of(const PairedCampaign& campaign, const PairedChannel& one) {
    Matrix regressors(one.gap.size(), one.basis.regressors.cols());
    Vector prior_sd(one.basis.prior_sd.size());
    Index kept = 0;
    for (Index column = 0; column < regressors.cols(); ++column) {
      if (std::count(one.basis.borrowed.begin(), one.basis.borrowed.end(), column) > 0) continue;
      regressors.col(kept) = one.basis.regressors.col(column);
      prior_sd(kept++) = one.basis.prior_sd(column);
    }
    return held_out_residual(campaign, regressors.leftCols(kept), one.gap, prior_sd.head(kept),
                             one.calibrated * std::sqrt(one.correlation));
  }

  /// rms by stage of one channel, over all rows or those of one batch.
  GapLevels staged(Index c, std::size_t batch) const {
    const std::size_t k = static_cast<std::size_t>(c);
    const auto rms = [&](const Vector& stack) {
      return batch == campaign_.batches.size() ? rms_of(stack) : rms_of(campaign_.part(stack, batch));
    };
    return {rms(first_[k].gap), rms(first_residuals_[k]), rms(last_residuals_[k]), last_[k].noise};
  }

  void tell_gap(Diagnosis& result) {
    for (std::size_t c = 0; c < first_.size(); ++c) {
      first_residuals_.push_back(residual_of(campaign_, first_[c]));
      last_residuals_.push_back(result.effects.empty() ? first_residuals_[c] : residual_of(campaign_, last_[c]));
    }
    Gap& gap = result.gap;
    const std::size_t all = campaign_.batches.size();
    gap.output = campaign_.channels[static_cast<std::size_t>(told_)];
    gap.unit = told_ < campaign_.temperatures ? "K" : "um";
    gap.rms = staged(told_, all);
    gap.held_out = all > 1;
    gap.shrink_percent = shrink_percent(gap.rms.calibrated, gap.rms.with_effect);
    gap.shrink_of_explainable_percent =
        shrink_of_explainable_percent(gap.rms.calibrated, gap.rms.with_effect, gap.rms.noise);
    gap.shrink_ci95_percent = shrink_interval(squares_of(first_residuals_), squares_of(last_residuals_), .95, seed_);
    for (std::size_t b = 0; b < all; ++b) gap.per_batch.push_back({campaign_.batches[b].name, staged(told_, b)});
    for (Index c = 0; c < campaign_.temperatures; ++c)
      if (campaign_.is_output(c))
        gap.per_sensor.push_back({campaign_.channels[static_cast<std::size_t>(c)], "K", staged(c, all)});
  }

  /// Squares by batch of the channel that is told.
  BatchSquares squares_of(const std::vector<Vector>& residuals) const {
    const Index all = static_cast<Index>(campaign_.batches.size());
    BatchSquares result{Vector(all), Vector(all)};
    for (Index b = 0; b < all; ++b) {
      const Vector part = campaign_.part(residuals[static_cast<std::size_t>(told_)], static_cast<std::size_t>(b));
      result.sum(b) = part.squaredNorm();
      result.count(b) = static_cast<double>(part.size());
    }
    return result;
  }

  void tell_where(Diagnosis& result) const {
    Campaign measured;
    std::vector<Vector> residuals, last, times_s;
    for (std::size_t b = 0; b < campaign_.batches.size(); ++b) {
      const PairedBatch& pair = campaign_.batches[b];
      Batch batch;
      batch.name = pair.name;
      batch.time_s = pair.time_s;
      batch.inputs = {campaign_.inputs, pair.inputs};
      batch.temperatures = {{campaign_.channels.begin(), campaign_.channels.begin() + campaign_.temperatures},
                            pair.measured.leftCols(campaign_.temperatures)};
      measured.push_back(std::move(batch));
      times_s.push_back(pair.time_s);
      residuals.push_back(campaign_.part(first_residuals_[static_cast<std::size_t>(told_)], b));
      last.push_back(campaign_.part(last_residuals_[static_cast<std::size_t>(told_)], b));
    }
    Where& where = result.where;
    where.conditions = condition_shares(measured, residuals, campaign_.room);
    where.frequency = period_shares(times_s, residuals);
    double sum = 0;
    for (Index c = 0; c < campaign_.channel_count(); ++c) {
      const PairedChannel& one = first_[static_cast<std::size_t>(c)];
      if (!campaign_.is_output(c) || one.noise <= 0) continue;
      where.places.push_back(
          {campaign_.channels[static_cast<std::size_t>(c)], std::max(0., std::pow(one.calibrated / one.noise, 2) - 1)});
      sum += where.places.back().share;
    }
    for (NamedShare& place : where.places) place.share = sum > 0 ? place.share / sum : 0;
    std::stable_sort(where.places.begin(), where.places.end(),
                     [](const NamedShare& a, const NamedShare& b) { return a.share > b.share; });
    auto [look, white] = remaining_look(measured, last, result.gap.rms.with_effect, result.gap.rms.noise, seed_);
    result.remaining = {white, unexplained(result.gap.rms.with_effect, result.gap.rms.noise), {std::move(look)}};
  }

  std::vector<std::string> constant_inputs() const {
    std::vector<std::string> result;
    for (std::size_t i = 0; i < campaign_.inputs.size(); ++i) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const PairedBatch& batch : campaign_.batches) {
        low = std::min(low, batch.inputs.col(static_cast<Index>(i)).minCoeff());
        high = std::max(high, batch.inputs.col(static_cast<Index>(i)).maxCoeff());
      }
      if (!(low < high)) result.push_back(campaign_.inputs[i]);
    }
    return result;
  }

  void tell_limits(Diagnosis& result) const {
    using Claim = WeakerClaim::Kind;
    using Problem = DataProblem::Kind;
    if (!campaign_.not_simulated.empty())
      result.data_problems.push_back({Problem::not_simulated, campaign_.not_simulated, "", "", "", ""});
    for (const std::string& batch : campaign_.not_paired)
      result.data_problems.push_back({Problem::not_paired, {batch}, "", "", "", ""});
    if (campaign_.resampled) result.data_problems.push_back({Problem::resampled, {}, "", "", "", ""});
    const std::size_t batches = campaign_.batches.size();
    result.weaker_claims.push_back({Claim::no_network, "", "", {}, batches});
    if (campaign_.room.empty()) result.weaker_claims.push_back({Claim::no_ambient, "", "", {}, batches});
    for (WeakerClaim& one : weaker_claims(batches, constant_inputs())) result.weaker_claims.push_back(std::move(one));
    if (campaign_.temperatures == campaign_.channel_count())
      result.weaker_claims.push_back({Claim::no_displacement, "", "", {}, batches});
  }

  const PairedCampaign& campaign_;
  const EffectLibrary& library_;
  const std::vector<PairedChannel>& first_;
  const std::vector<PairedChannel>& last_;
  Index told_;
  unsigned seed_;
  std::vector<Vector> first_residuals_, last_residuals_;
};

}  // namespace thermfit::detail
