#pragma once

/// What a diagnosis of outputs found, in figures: gap by level, where it lies, what remains, what cannot be said.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/claims.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/judgement/shrink.hpp"
#include "thermfit/diagnosis/outputs/paired_channel.hpp"
#include "thermfit/diagnosis/planning/next_experiment.hpp"
#include "thermfit/diagnosis/where/conditions.hpp"
#include "thermfit/diagnosis/where/periods.hpp"
#include "thermfit/diagnosis/where/remaining.hpp"

namespace thermfit {

/// What the simulator leaves of a channel on batches left out: without the measured temperatures that judged the
/// displacement, which it would not have. All batches below each other. Allocates.
template <typename Scalar = double>
VectorX<Scalar> held_out_gap(const PairedCampaign& campaign, const PairedChannel& one) {
  const MatrixX<Scalar>& all = one.basis.regressors;
  const VectorX<Scalar>& sd = one.basis.prior_sd;
  MatrixX<Scalar> regressors(all.rows(), all.cols());
  VectorX<Scalar> prior_sd(sd.size());
  Index kept = 0;
  for (Index column = 0; column < all.cols(); ++column) {
    if (std::count(one.basis.borrowed.begin(), one.basis.borrowed.end(), column) > 0) continue;
    regressors.col(kept) = all.col(column);
    prior_sd(kept++) = sd(column);
  }
  const MatrixX<Scalar> own = regressors.leftCols(kept);
  const VectorX<Scalar> own_sd = prior_sd.head(kept);
  return held_out_residual<Scalar>(campaign, own, one.gap, own_sd, one.calibrated * std::sqrt(one.correlation));
}

namespace detail {

template <typename Scalar = double>
class OutputViews {
 public:
  /// `first` are the channels with calibration alone, `last` with all effects, of which there are `named`; `told` is
  /// the channel the gap is told for.
  OutputViews(const PairedCampaign& campaign, const std::vector<PairedChannel>& first,
              const std::vector<PairedChannel>& last, bool named, Index told)
      : campaign_(campaign), first_(first), last_(last), told_(static_cast<std::size_t>(told)) {
    for (std::size_t c = 0; c < first.size(); ++c) {
      before_.push_back(held_out_gap<Scalar>(campaign, first[c]));
      after_.push_back(named ? held_out_gap<Scalar>(campaign, last[c]) : before_[c]);
    }
  }

  Gap gap(unsigned seed) const {
    Gap gap;
    const std::size_t all = campaign_.batches.size();
    gap.output = campaign_.channels[told_];
    gap.unit = told_ < static_cast<std::size_t>(campaign_.temperatures) ? "K" : "um";
    gap.rms = levels(told_, all);
    gap.held_out = all > 1;
    gap.shrink_percent = shrink_percent(gap.rms.calibrated, gap.rms.with_effect);
    gap.shrink_of_explainable_percent =
        shrink_of_explainable_percent(gap.rms.calibrated, gap.rms.with_effect, gap.rms.noise);
    gap.shrink_ci95_percent = shrink_interval(squares(before_[told_]), squares(after_[told_]), .95, seed);
    for (std::size_t b = 0; b < all; ++b) gap.per_batch.push_back({campaign_.batches[b].name, levels(told_, b)});
    for (Index c = 0; c < campaign_.temperatures; ++c)
      if (campaign_.is_output(c))
        gap.per_sensor.push_back(
            {campaign_.channels[static_cast<std::size_t>(c)], "K", levels(static_cast<std::size_t>(c), all)});
    return gap;
  }

  Where where() const {
    Where where;
    where.conditions = condition_shares(measured(), by_batch(before_[told_]), campaign_.room);
    where.frequency = period_shares(times_s(), by_batch(before_[told_]));
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
    return where;
  }

  Remaining remaining(const GapLevels& rms, unsigned seed) const {
    auto [look, white] = remaining_look(measured(), by_batch(after_[told_]), rms.with_effect, rms.noise, seed);
    return {white, unexplained(rms.with_effect, rms.noise), {std::move(look)}};
  }

 private:
  /// rms by level of one channel, over all rows or those of one batch.
  GapLevels levels(std::size_t c, std::size_t batch) const {
    const auto rms = [&](const VectorX<Scalar>& stack) {
      return batch == campaign_.batches.size() ? rms_of<Scalar>(stack) : rms_of<Scalar>(campaign_.part(stack, batch));
    };
    return {rms(first_[c].gap), rms(before_[c]), rms(after_[c]), last_[c].noise};
  }

  BatchSquares squares(const VectorX<Scalar>& residual) const {
    const Index all = static_cast<Index>(campaign_.batches.size());
    BatchSquares result{VectorX<Scalar>(all), VectorX<Scalar>(all)};
    for (Index b = 0; b < all; ++b) {
      const VectorX<Scalar> part = campaign_.part(residual, static_cast<std::size_t>(b));
      result.sum(b) = part.squaredNorm();
      result.count(b) = static_cast<double>(part.size());
    }
    return result;
  }

  std::vector<Vector> by_batch(const VectorX<Scalar>& stack) const {
    std::vector<Vector> result;
    for (std::size_t b = 0; b < campaign_.batches.size(); ++b) result.push_back(campaign_.part(stack, b));
    return result;
  }

  std::vector<Vector> times_s() const {
    std::vector<Vector> result;
    for (const PairedBatch& pair : campaign_.batches) result.push_back(pair.time_s);
    return result;
  }

  /// What was measured in the samples that pair.
  Campaign measured() const {
    Campaign result;
    for (const PairedBatch& pair : campaign_.batches) {
      const MatrixX<Scalar>& channels = pair.measured;
      Batch batch;
      batch.name = pair.name;
      batch.time_s = pair.time_s;
      batch.inputs = {campaign_.inputs, pair.inputs};
      batch.temperatures = {{campaign_.channels.begin(), campaign_.channels.begin() + campaign_.temperatures},
                            channels.leftCols(campaign_.temperatures)};
      result.push_back(std::move(batch));
    }
    return result;
  }

  const PairedCampaign& campaign_;
  const std::vector<PairedChannel>& first_;
  const std::vector<PairedChannel>& last_;
  std::size_t told_;
  std::vector<VectorX<Scalar>> before_, after_;  ///< by channel: held out, with calibration alone, with all effects
};

}  // namespace detail

/// Inputs that have one value in all batches.
template <typename Scalar = double>
std::vector<std::string> constant_inputs(const PairedCampaign& campaign) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < campaign.inputs.size(); ++i) {
    const double first = campaign.batches[0].inputs(0, static_cast<Index>(i));
    if (std::all_of(campaign.batches.begin(), campaign.batches.end(), [&](const PairedBatch& batch) {
          const MatrixX<Scalar>& inputs = batch.inputs;
          return (inputs.col(static_cast<Index>(i)).array() == first).all();
        }))
      result.push_back(campaign.inputs[i]);
  }
  return result;
}

/// What pairing left out or changed.
inline std::vector<DataProblem> pairing_problems(const PairedCampaign& campaign) {
  using Kind = DataProblem::Kind;
  std::vector<DataProblem> result;
  if (!campaign.not_simulated.empty()) result.push_back({Kind::not_simulated, campaign.not_simulated, "", "", "", ""});
  for (const std::string& batch : campaign.not_paired) result.push_back({Kind::not_paired, {batch}, "", "", "", ""});
  if (campaign.resampled) result.push_back({Kind::resampled, {}, "", "", "", ""});
  return result;
}

/// What outputs alone, few batches, constant inputs and missing channels do not allow to say; `beside` are channels
/// with a gap that has no name.
template <typename Scalar = double>
std::vector<WeakerClaim> claims_of_outputs(const PairedCampaign& campaign, const std::vector<std::string>& beside) {
  using Kind = WeakerClaim::Kind;
  const std::size_t batches = campaign.batches.size();
  std::vector<WeakerClaim> result{{Kind::no_network, "", "", {}, batches}};
  if (campaign.room.empty()) result.push_back({Kind::no_ambient, "", "", {}, batches});
  for (WeakerClaim& one : weaker_claims(batches, constant_inputs<Scalar>(campaign))) result.push_back(std::move(one));
  if (campaign.temperatures == campaign.channel_count()) result.push_back({Kind::no_displacement, "", "", {}, batches});
  if (!beside.empty()) result.push_back({Kind::gap_beside, "", "", beside, batches});
  return result;
}

}  // namespace thermfit
