#pragma once

/// Diagnosis where the simulator is somebody else's and only its output is at hand.

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/outputs/scan.hpp"
#include "thermfit/diagnosis/outputs/views.hpp"
#include "thermfit/statistics/parallel.hpp"
#include "thermfit/statistics/reading_step.hpp"

namespace thermfit {

struct PairedOptions {
  std::string room;                  ///< ambient temperature column; empty: recognised
  double reference_degC = 20;        ///< of gain and nonlinear expansion
  std::vector<std::string> effects;  ///< only these; empty: the whole library
  std::vector<std::string> without;  ///< not these
  unsigned seed = 1;
  unsigned threads = 0;       ///< 0: all cores
  double decisive_nats = 60;  ///< evidence over calibration that a named effect must have
  std::function<void(const std::string&)> progress;
};

namespace detail {

/// The state of a paired diagnosis between its steps.
class PairedDiagnosis {
 public:
  PairedDiagnosis(const Campaign& real, const Campaign& sim, const EffectLibrary& library, const PairedOptions& options)
      : options_(options), library_(library), campaign_(pair_campaigns(real, sim, options.room)), drives_(campaign_) {}

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
    result_.simulator = SimulatorKind::outputs;
    for (const PairedBatch& batch : campaign_.batches) result_.batches.push_back(batch.name);
    std::vector<double> looseness;
    for (Index c = 0; c < campaign_.channel_count(); ++c) {
      PairedChannel one;
      one.basis = calibration_basis(campaign_, drives_, c);
      one.gap.resize(campaign_.rows());
      SeriesByBatch measured;
      for (std::size_t b = 0; b < campaign_.batches.size(); ++b) {
        measured.push_back(campaign_.batches[b].measured.col(c));
        campaign_.part(one.gap, b) = measured[b] - campaign_.batches[b].simulated.col(c);
      }
      one.resolution = resolution_sd(measured);
      one.as_simulated = rms_of(one.gap);
      judge_calibration(campaign_, one);
      if (campaign_.is_output(c)) looseness.push_back(best_looseness(one));
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
          fit_with_prior(one.products, one.basis.prior_sd, one.calibrated * std::sqrt(one.correlation)).coefficients;
      predicted.emplace_back();
      for (std::size_t b = 0; b < campaign_.batches.size(); ++b)
        predicted.back().push_back(campaign_.batches[b].simulated.col(c) + campaign_.part(gap, b));
    }
    OutputTraces traces(campaign_, options_.reference_degC, std::move(predicted));
    for (const auto& effect : library_.all())
      if (wanted(effect->name())) traces.add(*effect);
    traces_ = traces.take();
    scores_.assign(traces_.size(), {});
    in_parallel(traces_.size(), options_.threads,
                [&](std::size_t i) { scores_[i] = score_of(i, traces_[i], channels_, campaign_); });
    std::sort(scores_.begin(), scores_.end(), [](const TraceScore& a, const TraceScore& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.trace < b.trace;
    });
  }

  /// Where a trace lies: its own location, else the sensor in which it shows most.
  std::string location_of(const TraceScore& score) const {
    const OutputTrace& trace = traces_[score.trace];
    if (!trace.location.empty()) return trace.location;
    const ChannelScore* strongest = strongest_sensor(score, campaign_.temperatures);
    return strongest ? name(strongest->channel) : "";
  }

  /// A hypothesis: the best variant of an effect at a place.
  struct Suspect {
    const TraceScore* score = nullptr;
    std::string effect, location, driver;
    double probability = 0;
  };

  std::vector<Suspect> candidates() const {
    std::vector<Suspect> found;
    for (const TraceScore& score : scores_) {
      const OutputTrace& trace = traces_[score.trace];
      if (score.implausible) continue;
      const std::string location = location_of(score);
      const bool known = std::any_of(found.begin(), found.end(), [&](const Suspect& one) {
        return one.effect == trace.effect && one.location == location && one.driver == trace.driver;
      });
      if (!known) found.push_back({&score, trace.effect, location, trace.driver, 0});
    }
    if (found.empty()) return found;
    // The traces are approximations: differences below a few percent of the evidence decide nothing.
    const double softness = std::max(3., .03 * found[0].score->gain);
    double sum = std::exp(std::min(0., (options_.decisive_nats - found[0].score->gain) / softness));
    for (Suspect& one : found) sum += one.probability = std::exp((one.score->gain - found[0].score->gain) / softness);
    for (Suspect& one : found) one.probability *= .99 / sum;
    return found;
  }

  /// A heat flow that leaves the displacement at its noise explains nothing worth naming.
  bool matters(const TraceScore& score) const {
    if (score.channels.size() == 1) {
      const PairedChannel& one = channels_[static_cast<std::size_t>(score.channels[0].channel)];
      return score.channels[0].contribution > 3 * one.noise;
    }
    const PairedChannel& output = channels_[static_cast<std::size_t>(headline())];
    return output.as_simulated > 1.7 * output.noise;
  }

  /// Takes the best effect if it is decisive; returns whether another round makes sense.
  bool decide(int round) {
    const std::vector<Suspect> found = candidates();
    if (round == 0) note_ruled_out(found);
    // What a first effect leaves is also the mismatch of its approximate trace: a further one must be clearer.
    const double needed = (round ? 2 : 1) * options_.decisive_nats;
    if (found.empty() || found[0].score->gain < needed || !matters(*found[0].score)) return false;
    const Suspect& best = found[0];
    if (round > 0 && is_rival(best)) return false;
    const OutputTrace& trace = traces_[best.score->trace];
    const std::vector<PairedChannel> before = channels_;
    add_to_basis(trace);
    if (round > 0 && !improves(before, *best.score)) {
      channels_ = before;
      return false;
    }
    FoundEffect effect = named(trace, best.location, 0);
    for (const Suspect& one : found) {
      const bool same = one.effect == best.effect && one.driver == best.driver;
      if (same) effect.confidence += one.probability;
      if (&one == &best || one.probability < .05) continue;
      if (same)
        effect.same_place.push_back(one.location);
      else
        effect.alternatives.push_back({one.effect, one.location, one.driver, one.probability});
    }
    const ChannelScore& first = best.score->channels[0];
    if (best.score->channels.size() == 1 && !trace.unit_strength)
      effect.parameters.push_back(
          {trace.strength.name, trace.strength.unit, first.coefficients(0), first.standard_errors(0)});
    if (best.score->channels.size() > 1)
      if (const ChannelScore* most = strongest_sensor(*best.score, campaign_.temperatures))
        effect.parameters.push_back({"rms_on_" + name(most->channel) + "_K", "K", most->contribution, -1});
    if (round == 0) {
      stage_ = trace.stage;
      told_ = best.score->channels.size() == 1 ? first.channel : headline();
    }
    result_.effects.push_back(std::move(effect));
    return true;
  }

  FoundEffect named(const OutputTrace& trace, const std::string& location, double confidence) const {
    const Effect& effect = library_.at(trace.effect);
    FoundEffect result;
    result.effect = trace.effect;
    result.location = location;
    result.driver = trace.driver;
    result.confidence = confidence;
    for (const TraceNumber& one : trace.shape) result.parameters.push_back({one.name, one.unit, one.value, -1});
    result.meaning = effect.meaning();
    result.against_as_given = effect.calibration_does_the_same();
    return result;
  }

  bool is_rival(const Suspect& candidate) const {
    for (const FoundEffect& found : result_.effects)
      for (const Rival& rival : found.alternatives)
        if (rival.effect == candidate.effect && rival.location == candidate.location) return true;
    return false;
  }

  /// A further effect must lower the held-out gap where it counts: by a fifth in the displacement, by half in a sensor.
  bool improves(const std::vector<PairedChannel>& before, const TraceScore& score) const {
    const std::size_t output = static_cast<std::size_t>(headline());
    if (channels_[output].calibrated < .8 * before[output].calibrated) return true;
    const std::size_t own = static_cast<std::size_t>(score.channels[0].channel);
    return score.channels.size() == 1 && channels_[own].calibrated < .5 * before[own].calibrated;
  }

  /// The effect's columns join what is free, so that everything is refitted together.
  void add_to_basis(const OutputTrace& trace) {
    for (const Index c : trace.channels) {
      PairedChannel& one = channel(c);
      const TracePrior prior(trace, one);
      const Matrix scaled = trace.columns * prior.scale.cwiseInverse().asDiagonal();
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

  void note_ruled_out(const std::vector<Suspect>& found) {
    std::vector<std::string> named;
    for (const Suspect& one : found) {
      if (one.probability >= .05 || std::count(named.begin(), named.end(), one.effect) > 0) continue;
      named.push_back(one.effect);
      if (one.effect == found[0].effect) continue;
      const bool no_better = one.score->gain < options_.decisive_nats;
      result_.ruled_out.push_back({one.effect, one.location, no_better ? RuledOutBy::calibration : RuledOutBy::evidence,
                                   no_better ? one.score->gain : found[0].score->gain - one.score->gain});
    }
    for (const TraceScore& score : scores_) {
      const OutputTrace& trace = traces_[score.trace];
      if (!score.implausible || std::count(named.begin(), named.end(), trace.effect) > 0) continue;
      if (std::any_of(found.begin(), found.end(), [&](const Suspect& one) { return one.effect == trace.effect; }))
        continue;
      named.push_back(trace.effect);
      result_.ruled_out.push_back(
          {trace.effect, location_of(score), *score.implausible, score.channels[0].coefficients(0)});
    }
  }

  /// Too much is left in the channels the effect should explain: the cause is something else.
  bool leaves_too_much() const {
    double before = 0, after = 0;
    for (Index c = 0; c < campaign_.channel_count(); ++c) {
      const PairedChannel& one = channels_[static_cast<std::size_t>(c)];
      if (!campaign_.is_output(c) || one.noise <= 0) continue;
      before += std::max(0., std::pow(first_[static_cast<std::size_t>(c)].calibrated / one.noise, 2) - 1);
      after += std::max(0., std::pow(one.calibrated / one.noise, 2) - 1);
    }
    const double outputs = static_cast<double>(campaign_.channel_count());
    return after > 15 * outputs && after > .3 * before;
  }

  /// The gap that is told must shrink on batches left out (an offset: against the simulator as given), else the effect
  /// explains something else.
  bool told_gap_shrinks() const {
    Diagnosis trial;
    trial.effects = result_.effects;
    OutputViews(campaign_, library_, first_, channels_, told_, options_.seed).tell(trial);
    const GapLevels& rms = trial.gap.rms;
    return rms.with_effect < (trial.effects[0].against_as_given ? rms.as_simulated : rms.calibrated);
  }

  /// What a thermometer may be off because of where it sits; beside a gap without a name, smaller faults are not told.
  static constexpr double placement_tolerance_K = .5;

  /// A fault of a thermometer shows in its own reading alone, so that reading judges it whatever has no name elsewhere.
  /// Names the decisive one that closes a third of its own gap and beats there whatever else could act on that reading.
  /// An offset counts against the simulator as given, since calibration moves offsets too.
  bool name_sensor_fault() {
    channels_ = first_;
    scan();
    for (const TraceScore& score : scores_) {
      const OutputTrace& trace = traces_[score.trace];
      const bool sensor =
          trace.stage == Stage::measurement && trace.channels.size() == 1 && trace.channels[0] < campaign_.temperatures;
      if (score.gain < options_.decisive_nats) break;
      if (!sensor || score.implausible || score.channels[0].contribution < placement_tolerance_K) continue;
      const Index own = trace.channels[0];
      std::vector<Suspect> rivals = candidates_in(own);
      if (rivals.empty() || rivals[0].score != &score) continue;
      const double before =
          library_.at(trace.effect).calibration_does_the_same() ? channel(own).as_simulated : channel(own).calibrated;
      add_to_basis(trace);
      if (channel(own).calibrated > .67 * before) {
        channels_ = first_;
        continue;
      }
      FoundEffect effect = named(trace, name(own), rivals[0].probability);
      for (std::size_t i = 1; i < rivals.size(); ++i)
        if (rivals[i].probability >= .05 && rivals[i].effect != trace.effect)
          effect.alternatives.push_back(
              {rivals[i].effect, rivals[i].location, rivals[i].driver, rivals[i].probability});
      if (!trace.unit_strength)
        effect.parameters.push_back({trace.strength.name, trace.strength.unit, score.channels[0].coefficients(0),
                                     score.channels[0].standard_errors(0)});
      result_.effects = {std::move(effect)};
      stage_ = trace.stage;
      told_ = own;
      return true;
    }
    channels_ = first_;
    return false;
  }

  /// Effects by what they are worth in one channel, each at its best there; strongest first.
  std::vector<Suspect> candidates_in(Index own) const {
    std::vector<Suspect> found;
    std::vector<double> gains;
    for (const TraceScore& score : scores_)
      for (const ChannelScore& part : score.channels) {
        if (part.channel != own || score.implausible) continue;
        const OutputTrace& trace = traces_[score.trace];
        std::size_t at = 0;
        while (at < found.size() && found[at].effect != trace.effect) ++at;
        if (at == found.size()) {
          found.push_back({&score, trace.effect, location_of(score), trace.driver, 0});
          gains.push_back(part.gain);
        } else if (part.gain > gains[at]) {
          found[at] = {&score, trace.effect, location_of(score), trace.driver, 0};
          gains[at] = part.gain;
        }
      }
    if (found.empty()) return found;
    const double best = *std::max_element(gains.begin(), gains.end()), softness = std::max(3., .03 * best);
    double sum = std::exp(std::min(0., (options_.decisive_nats - best) / softness));
    for (std::size_t i = 0; i < found.size(); ++i) sum += found[i].probability = std::exp((gains[i] - best) / softness);
    for (Suspect& one : found) one.probability *= .99 / sum;
    std::stable_sort(found.begin(), found.end(),
                     [](const Suspect& a, const Suspect& b) { return a.probability > b.probability; });
    return found;
  }

  void finish() {
    if (result_.effects.empty()) {
      told_ = headline();
      const PairedChannel& one = channel(told_);
      result_.verdict =
          one.as_simulated < 1.7 * one.noise ? Verdict::none
          : one.calibrated < 2 * one.noise || (one.calibrated < 4 * one.noise && one.calibrated < .4 * one.as_simulated)
              ? Verdict::miscalibration
              : Verdict::unknown;
    } else if (leaves_too_much() || !told_gap_shrinks()) {
      const FoundEffect& nearest = result_.effects[0];
      result_.verdict = Verdict::unknown;
      result_.ruled_out.insert(result_.ruled_out.begin(), {nearest.effect, nearest.location, RuledOutBy::remains});
      result_.effects.clear();
    } else {
      result_.verdict = result_.effects[0].alternatives.empty() ? Verdict::effect : Verdict::ambiguous;
    }
    std::vector<std::string> beside;
    if (result_.verdict == Verdict::unknown && name_sensor_fault()) {
      result_.verdict = result_.effects[0].alternatives.empty() ? Verdict::effect : Verdict::ambiguous;
      for (Index c = 0; c < campaign_.channel_count(); ++c)
        if (c != told_ && campaign_.is_output(c) && channel(c).calibrated > 2 * channel(c).noise)
          beside.push_back(name(c));
    }
    if (campaign_.batches.size() < 3 && !result_.effects.empty()) {
      result_.verdict = Verdict::ambiguous;  // a suspicion: too few batches to judge by
      for (FoundEffect& one : result_.effects) one.confidence = std::min(one.confidence, .5);
    }
    OutputViews(campaign_, library_, first_, channels_, told_, options_.seed).tell(result_);
    if (!beside.empty())
      result_.weaker_claims.push_back({WeakerClaim::Kind::gap_beside, "", "", beside, campaign_.batches.size()});
    if (!result_.effects.empty()) result_.where.stages.push_back({word_of(stage_), 1});
  }

  PairedOptions options_;
  const EffectLibrary& library_;
  PairedCampaign campaign_;
  Drives drives_;
  std::vector<PairedChannel> channels_;
  std::vector<PairedChannel> first_;  ///< with calibration alone
  std::vector<OutputTrace> traces_;
  std::vector<TraceScore> scores_;
  Stage stage_ = Stage::heat;
  Index told_ = 0;  ///< the channel the gap is told for: the effect's own where it acts on one, else the headline
  Diagnosis result_;
};

}  // namespace detail

/// Diagnoses the gap between measured batches and a simulator's output for them, paired by name.
///
/// Every effect of the library acts through the trace it would leave in the outputs, given inputs, measured
/// temperatures and time; what the simulator's own parameters could change (gains and lags of each drive's
/// contribution, learnt from the simulated courses) is free in every comparison. An effect is named when its evidence
/// beats calibration by `decisive_nats`; the gap before and after is that of batches left out. Throws Error when the
/// two sides do not pair.
inline Diagnosis diagnose_paired(const Campaign& real, const Campaign& sim, const EffectLibrary& library,
                                 const PairedOptions& options = {}) {
  return detail::PairedDiagnosis(real, sim, library, options).run();
}

}  // namespace thermfit
