#pragma once

/// Diagnosis where the simulator is somebody else's and only its output is at hand.

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "thermfit/gap/conditions.hpp"
#include "thermfit/gap/diagnosis.hpp"
#include "thermfit/gap/paired_scan.hpp"
#include "thermfit/gap/remaining.hpp"
#include "thermfit/gap/where_periods.hpp"

namespace thermfit {

struct PairedOptions {
  std::string room;                  ///< ambient temperature column; empty: recognised
  double reference_degC = 20;        ///< of gain and nonlinear expansion
  std::vector<std::string> effects;  ///< only these; empty: the whole catalogue
  std::vector<std::string> without;  ///< not these
  unsigned seed = 1;
  unsigned threads = 1;
  double decisive_nats = 60;  ///< evidence over calibration that a named effect must have
  std::function<void(const std::string&)> progress;
};

namespace detail {

/// The state of a paired diagnosis between its steps.
class PairedDiagnosis {
 public:
  PairedDiagnosis(const Campaign& real, const Campaign& sim, const PairedOptions& options)
      : options_(options), campaign_(pair_campaigns(real, sim, options.room)), drives_(campaign_) {}

  Diagnosis run() {
    start();
    for (int round = 0; round < 3; ++round) {
      say("weighing effects, round " + std::to_string(round + 1));
      scan();
      if (!decide(round)) break;
    }
    finish();
    return std::move(result_);
  }

 private:
  void say(const std::string& what) const {
    if (options_.progress) options_.progress(what);
  }
  const std::string& name(Index c) const { return campaign_.channels[static_cast<std::size_t>(c)]; }
  PairedChannel& channel(Index c) { return channels_[static_cast<std::size_t>(c)]; }
  bool is_output(Index c) const { return c >= campaign_.temperatures || name(c) != campaign_.room; }
  /// The channel the gap is told for: the first displacement, else the temperature with the largest gap.
  Index headline() const {
    if (campaign_.temperatures < campaign_.channel_count()) return campaign_.temperatures;
    Index largest = 0;
    for (Index c = 1; c < campaign_.channel_count(); ++c)
      if (channels_[static_cast<std::size_t>(c)].as_simulated >
          channels_[static_cast<std::size_t>(largest)].as_simulated)
        largest = c;
    return largest;
  }

  void start() {
    result_.mode = "paired";
    result_.machine = "";
    for (const PairedBatch& batch : campaign_.batches) result_.batches.push_back(batch.name);
    std::vector<double> looseness;
    for (Index c = 0; c < campaign_.channel_count(); ++c) {
      PairedChannel one;
      one.basis = calibration_basis(campaign_, drives_, c);
      one.gap.resize(campaign_.rows());
      for (std::size_t b = 0; b < campaign_.batches.size(); ++b)
        campaign_.part(one.gap, b) = campaign_.batches[b].measured.col(c) - campaign_.batches[b].simulated.col(c);
      one.as_simulated = rms_of(one.gap);
      judge_calibration(campaign_, one);
      if (is_output(c)) looseness.push_back(best_looseness(one));
      channels_.push_back(std::move(one));
    }
    // Calibration is as loose as the median channel needs, but never so loose that it hides an effect.
    std::nth_element(looseness.begin(), looseness.begin() + static_cast<std::ptrdiff_t>(looseness.size() / 2),
                     looseness.end());
    const double common = std::min(.5, looseness[looseness.size() / 2]);
    for (PairedChannel& one : channels_) {
      one.basis.prior_sd *= common;
      judge_calibration(campaign_, one);
    }
    first_ = channels_;
  }

  static double best_looseness(const PairedChannel& channel) {
    double best = -1e300, at = 1;
    for (const double looseness : {.06, .1, .2, .35, .6, 1.}) {
      const double log = profiled_evidence(channel, channel.products, looseness * channel.basis.prior_sd).log;
      if (log > best) best = log, at = looseness;
    }
    return at;
  }

  bool wanted(const std::string& effect) const {
    const auto in = [&](const std::vector<std::string>& list) {
      return std::count(list.begin(), list.end(), effect) > 0;
    };
    return (options_.effects.empty() || in(options_.effects)) && !in(options_.without);
  }

  void scan() {
    std::vector<std::vector<Vector>> predicted;
    for (Index c = campaign_.temperatures; c < campaign_.channel_count(); ++c) {
      const PairedChannel& one = channel(c);
      const Vector gap =
          one.basis.regressors *
          ridge(one.products, one.basis.prior_sd, one.calibrated * std::sqrt(one.correlation)).coefficients;
      predicted.emplace_back();
      for (std::size_t b = 0; b < campaign_.batches.size(); ++b)
        predicted.back().push_back(campaign_.batches[b].simulated.col(c) + campaign_.part(gap, b));
    }
    signatures_.clear();
    for (PairedSignature& one : SignatureBuilder(campaign_, options_.reference_degC, predicted).all())
      if (wanted(one.effect)) signatures_.push_back(std::move(one));
    scores_.assign(signatures_.size(), {});
    const std::size_t workers = std::max(1u, options_.threads);
    const auto work = [&](std::size_t first) {
      for (std::size_t i = first; i < signatures_.size(); i += workers)
        scores_[i] = score_of(i, signatures_[i], channels_, campaign_);
    };
    std::vector<std::thread> pool;
    for (std::size_t worker = 1; worker < workers; ++worker) pool.emplace_back(work, worker);
    work(0);
    for (std::thread& thread : pool) thread.join();
    std::sort(scores_.begin(), scores_.end(), [](const SignatureScore& a, const SignatureScore& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.signature < b.signature;
    });
  }

  /// Where a signature lies: its own location, else the sensor in which it shows most.
  std::string location_of(const SignatureScore& score) const {
    const PairedSignature& signature = signatures_[score.signature];
    if (!signature.location.empty()) return signature.location;
    const ChannelScore* strongest = strongest_sensor(score, campaign_.temperatures);
    return strongest ? name(strongest->channel) : "";
  }

  /// A hypothesis: the best variant of an effect at a place.
  struct Candidate {
    const SignatureScore* score = nullptr;
    std::string effect, location, driver;
    double probability = 0;
  };

  std::vector<Candidate> candidates() const {
    std::vector<Candidate> found;
    for (const SignatureScore& score : scores_) {
      const PairedSignature& signature = signatures_[score.signature];
      if (!score.implausible.empty()) continue;
      const std::string location = location_of(score);
      const bool known = std::any_of(found.begin(), found.end(), [&](const Candidate& one) {
        return one.effect == signature.effect && one.location == location && one.driver == signature.driver;
      });
      if (!known) found.push_back({&score, signature.effect, location, signature.driver, 0});
    }
    if (found.empty()) return found;
    // The signatures are approximations: differences below a few percent of the evidence decide nothing.
    const double softness = std::max(3., .03 * found[0].score->gain);
    double sum = std::exp(std::min(0., (options_.decisive_nats - found[0].score->gain) / softness));
    for (Candidate& one : found) sum += one.probability = std::exp((one.score->gain - found[0].score->gain) / softness);
    for (Candidate& one : found) one.probability *= .99 / sum;
    return found;
  }

  /// A heat flow that leaves the displacement at its noise explains nothing worth naming.
  bool matters(const SignatureScore& score) const {
    if (score.channels.size() == 1) {
      const PairedChannel& one = channels_[static_cast<std::size_t>(score.channels[0].channel)];
      return score.channels[0].contribution > 3 * one.noise;
    }
    const PairedChannel& output = channels_[static_cast<std::size_t>(headline())];
    return output.as_simulated > 1.7 * output.noise;
  }

  /// Takes the best effect if it is decisive; returns whether another round makes sense.
  bool decide(int round) {
    const std::vector<Candidate> found = candidates();
    if (round == 0) note_ruled_out(found);
    // What a first effect leaves is also the mismatch of its approximate trace: a further one must be clearer.
    const double needed = (round ? 2 : 1) * options_.decisive_nats;
    if (found.empty() || found[0].score->gain < needed || !matters(*found[0].score)) return false;
    const Candidate& best = found[0];
    const PairedSignature& signature = signatures_[best.score->signature];
    const std::vector<PairedChannel> before = channels_;
    add_to_basis(signature);
    if (round > 0 && !improves(before, *best.score)) {
      channels_ = before;
      return false;
    }
    FoundEffect effect{best.effect, best.location, best.driver, 0, signature.shape, {}, {}};
    for (const Candidate& one : found) {
      const bool same = one.effect == best.effect && one.driver == best.driver;
      if (same) effect.confidence += one.probability;
      if (&one == &best || one.probability < .05) continue;
      if (same)
        effect.same_place.push_back(one.location);
      else
        effect.alternatives.push_back({one.effect, one.location, one.driver, one.probability});
    }
    const ChannelScore& first = best.score->channels[0];
    if (best.score->channels.size() == 1 && !signature.unit_strength)
      effect.parameters.push_back(
          {signature.strength.name, signature.strength.unit, first.coefficients(0), first.standard_errors(0)});
    if (best.score->channels.size() > 1)
      if (const ChannelScore* most = strongest_sensor(*best.score, campaign_.temperatures))
        effect.parameters.push_back({"rms_on_" + name(most->channel) + "_K", "K", most->contribution, -1});
    if (round == 0) {
      stage_ = signature.stage;
      told_ = best.score->channels.size() == 1 ? first.channel : headline();
    }
    result_.effects.push_back(std::move(effect));
    return true;
  }

  /// A further effect must lower the held-out gap where it counts: by a fifth in the displacement, by half in a sensor.
  bool improves(const std::vector<PairedChannel>& before, const SignatureScore& score) const {
    const std::size_t output = static_cast<std::size_t>(headline());
    if (channels_[output].calibrated < .8 * before[output].calibrated) return true;
    const std::size_t own = static_cast<std::size_t>(score.channels[0].channel);
    return score.channels.size() == 1 && channels_[own].calibrated < .5 * before[own].calibrated;
  }

  /// The effect's columns join what is free, so that everything is refitted together.
  void add_to_basis(const PairedSignature& signature) {
    for (const Index c : signature.channels) {
      PairedChannel& one = channel(c);
      const SignaturePrior prior(signature, one);
      const Matrix scaled = signature.columns * prior.scale.cwiseInverse().asDiagonal();
      one.gap -= scaled * prior.mean;
      Matrix regressors(scaled.rows(), one.basis.regressors.cols() + scaled.cols());
      regressors << one.basis.regressors, scaled;
      Vector sd(regressors.cols());
      sd << one.basis.prior_sd, prior.sd;
      one.basis.regressors = std::move(regressors);
      one.basis.prior_sd = std::move(sd);
      judge_calibration(campaign_, one);
    }
  }

  void note_ruled_out(const std::vector<Candidate>& found) {
    std::vector<std::string> named;
    for (const Candidate& one : found) {
      if (one.probability >= .05 || std::count(named.begin(), named.end(), one.effect) > 0) continue;
      named.push_back(one.effect);
      if (!found.empty() && one.effect == found[0].effect && one.driver == found[0].driver) continue;
      result_.ruled_out.push_back(
          {one.effect, one.location,
           one.score->gain < options_.decisive_nats
               ? "no better than calibration (" + fixed_text(std::max(0., one.score->gain), 0) + " nats)"
               : fixed_text(found[0].score->gain - one.score->gain, 0) + " nats behind the best"});
    }
    for (const SignatureScore& score : scores_) {
      const PairedSignature& signature = signatures_[score.signature];
      if (score.implausible.empty() || std::count(named.begin(), named.end(), signature.effect) > 0) continue;
      if (std::any_of(found.begin(), found.end(), [&](const Candidate& one) { return one.effect == signature.effect; }))
        continue;
      named.push_back(signature.effect);
      result_.ruled_out.push_back({signature.effect, location_of(score), score.implausible});
    }
  }

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

  /// Too much is left in the channels the effect should explain: the cause is something else.
  bool leaves_too_much() const {
    double before = 0, after = 0;
    for (Index c = 0; c < campaign_.channel_count(); ++c) {
      const PairedChannel& one = channels_[static_cast<std::size_t>(c)];
      if (!is_output(c) || one.noise <= 0) continue;
      before += std::max(0., std::pow(first_[static_cast<std::size_t>(c)].calibrated / one.noise, 2) - 1);
      after += std::max(0., std::pow(one.calibrated / one.noise, 2) - 1);
    }
    const double outputs = static_cast<double>(campaign_.channel_count());
    return after > 15 * outputs && after > .3 * before;
  }

  void finish() {
    if (result_.effects.empty()) {
      told_ = headline();
      const PairedChannel& one = channel(told_);
      result_.verdict = one.as_simulated < 1.7 * one.noise ? Verdict::none
                        : one.calibrated < 2 * one.noise || one.calibrated < .4 * one.as_simulated
                            ? Verdict::miscalibration
                            : Verdict::unknown;
    } else if (leaves_too_much()) {
      const FoundEffect& nearest = result_.effects[0];
      result_.verdict = Verdict::unknown;
      result_.ruled_out.insert(result_.ruled_out.begin(), {nearest.effect, nearest.location,
                                                           "comes nearest, but leaves too much on batches left out"});
      result_.effects.clear();
    } else {
      result_.verdict = result_.effects[0].alternatives.empty() ? Verdict::effect : Verdict::ambiguous;
    }
    tell_gap();
    tell_where();
    tell_limits();
  }

  /// rms by stage of one channel, over all rows or those of one batch.
  StagedGap staged(Index c, std::size_t batch) const {
    const std::size_t k = static_cast<std::size_t>(c);
    const auto rms = [&](const Vector& stack) {
      return batch == campaign_.batches.size() ? rms_of(stack) : rms_of(campaign_.part(stack, batch));
    };
    return {rms(first_[k].gap), rms(first_residuals_[k]), rms(last_residuals_[k]), channels_[k].noise};
  }

  void tell_gap() {
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      first_residuals_.push_back(residual_of(campaign_, first_[c]));
      last_residuals_.push_back(result_.effects.empty() ? first_residuals_[c] : residual_of(campaign_, channels_[c]));
    }
    Gap& gap = result_.gap;
    const std::size_t all = campaign_.batches.size();
    gap.output = name(told_);
    gap.unit = told_ < campaign_.temperatures ? "K" : "um";
    gap.rms = staged(told_, all);
    gap.held_out = all > 1;
    gap.shrink_percent = 100 * (1 - gap.rms.with_effect / std::max(gap.rms.calibrated, 1e-12));
    const double noise2 = gap.rms.noise * gap.rms.noise, open = gap.rms.calibrated * gap.rms.calibrated - noise2;
    if (open > 0)
      gap.shrink_of_explainable_percent =
          100 *
          std::min(1., (gap.rms.calibrated * gap.rms.calibrated - gap.rms.with_effect * gap.rms.with_effect) / open);
    gap.shrink_ci95_percent = shrink_interval();
    for (std::size_t b = 0; b < all; ++b) gap.per_batch.push_back({campaign_.batches[b].name, staged(told_, b)});
    for (Index c = 0; c < campaign_.temperatures; ++c)
      if (is_output(c)) gap.per_sensor.push_back({name(c), "K", staged(c, all)});
  }

  /// 95 % interval of the shrink from 1000 draws of whole batches.
  Interval shrink_interval() const {
    const std::size_t all = campaign_.batches.size();
    std::vector<double> before, after, shrinks;
    for (std::size_t b = 0; b < all; ++b) {
      before.push_back(Vector(campaign_.part(first_residuals_[static_cast<std::size_t>(told_)], b)).squaredNorm());
      after.push_back(Vector(campaign_.part(last_residuals_[static_cast<std::size_t>(told_)], b)).squaredNorm());
    }
    std::minstd_rand random(options_.seed);
    for (int draw = 0; draw < 1000; ++draw) {
      double sum_before = 0, sum_after = 0;
      for (std::size_t k = 0; k < all; ++k) {
        const std::size_t b = random() % all;
        sum_before += before[b];
        sum_after += after[b];
      }
      shrinks.push_back(100 * (1 - std::sqrt(sum_after / std::max(sum_before, 1e-300))));
    }
    std::sort(shrinks.begin(), shrinks.end());
    return {shrinks[25], shrinks[974]};
  }

  void tell_where() {
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
    Where& where = result_.where;
    where.conditions = condition_shares(measured, residuals, campaign_.room);
    where.frequency = period_shares(times_s, residuals);
    if (!result_.effects.empty()) where.stages.push_back({word_of(stage_), 1});
    double sum = 0;
    for (Index c = 0; c < campaign_.channel_count(); ++c) {
      const PairedChannel& one = first_[static_cast<std::size_t>(c)];
      if (!is_output(c) || one.noise <= 0) continue;
      where.places.push_back({name(c), std::max(0., std::pow(one.calibrated / one.noise, 2) - 1)});
      sum += where.places.back().share;
    }
    for (NamedShare& place : where.places) place.share = sum > 0 ? place.share / sum : 0;
    std::stable_sort(where.places.begin(), where.places.end(),
                     [](const NamedShare& a, const NamedShare& b) { return a.share > b.share; });
    result_.remaining = remaining_gap(measured, last, result_.gap.rms.with_effect, result_.gap.rms.noise,
                                      result_.gap.unit, options_.seed);
  }

  void tell_limits() {
    for (const std::string& remark : campaign_.remarks) result_.data_problems.push_back({"pairing", remark});
    for (std::size_t i = 0; i < campaign_.inputs.size(); ++i) {
      double low = 1e300, high = -1e300;
      for (const PairedBatch& batch : campaign_.batches) {
        low = std::min(low, batch.inputs.col(static_cast<Index>(i)).minCoeff());
        high = std::max(high, batch.inputs.col(static_cast<Index>(i)).maxCoeff());
      }
      if (low < high) continue;
      result_.data_problems.push_back({campaign_.inputs[i], "never changes: effects it drives look like calibration"});
    }
    std::vector<std::string>& claims = result_.weaker_claims;
    claims.push_back(
        "without the network no power in W, no node between the sensors, and no machine with the effect can "
        "be given; a place is the sensor that responds");
    if (campaign_.room.empty())
      claims.push_back("no ambient temperature is known (--ambient NAME): effects of the room cannot be told apart");
    if (campaign_.batches.size() == 1)
      claims.push_back("one batch only: the figures are those of the fit itself, nothing is proven on unseen data");
    else if (campaign_.batches.size() < 4)
      claims.push_back("only " + std::to_string(campaign_.batches.size()) +
                       " batches: the interval of the shrink is rough");
    if (campaign_.temperatures == campaign_.channel_count())
      claims.push_back("no displacement is paired: expansion and probe effects were not looked for");
  }

  PairedOptions options_;
  PairedCampaign campaign_;
  Drives drives_;
  std::vector<PairedChannel> channels_;
  std::vector<PairedChannel> first_;  ///< with calibration alone
  std::vector<Vector> first_residuals_, last_residuals_;
  std::vector<PairedSignature> signatures_;
  std::vector<SignatureScore> scores_;
  Stage stage_ = Stage::heat;
  Index told_ = 0;  ///< the channel the gap is told for: the effect's own where it acts on one, else the headline
  Diagnosis result_;
};

}  // namespace detail

/// Diagnoses the gap between measured batches and a simulator's output for them, paired by name.
///
/// Every effect of the catalogue acts through the trace it would leave in the outputs, given inputs, measured
/// temperatures and time; what the simulator's own parameters could change (gains and lags of each drive's
/// contribution, learnt from the simulated courses) is free in every comparison. An effect is named when its evidence
/// beats calibration by `decisive_nats`; the gap before and after is that of batches left out. Throws Error when the
/// two sides do not pair.
inline Diagnosis diagnose_paired(const Campaign& real, const Campaign& sim, const PairedOptions& options = {}) {
  return detail::PairedDiagnosis(real, sim, options).run();
}

}  // namespace thermfit
