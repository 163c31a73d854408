#pragma once

/// Diagnosis where the simulator is somebody else's and only its output is at hand.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/judgement/thresholds.hpp"
#include "thermfit/diagnosis/leading_channel.hpp"
#include "thermfit/diagnosis/outputs/output_sides.hpp"
#include "thermfit/diagnosis/outputs/suspects.hpp"
#include "thermfit/diagnosis/outputs/views.hpp"
#include "thermfit/diagnosis/sides/bad_cells.hpp"
#include "thermfit/diagnosis/sides/compare_clocks.hpp"
#include "thermfit/diagnosis/sides/compare_sides.hpp"
#include "thermfit/diagnosis/sides/free_datum.hpp"
#include "thermfit/diagnosis/sides/unlike_sides.hpp"
#include "thermfit/statistics/held_levels.hpp"
#include "thermfit/statistics/parallel.hpp"
#include "thermfit/statistics/reading_step.hpp"

namespace thermfit {

/// What diagnose_outputs() looks for and by which numbers it decides.
struct OutputsOptions {
  std::string room;                  ///< ambient temperature column; empty: recognised
  double reference_degC = 20;        ///< of gain and nonlinear expansion
  std::vector<std::string> effects;  ///< only these; empty: the whole library
  std::vector<std::string> without;  ///< not these
  unsigned seed = 1;                 ///< of resampling
  unsigned threads = 0;              ///< 0: all cores
  OutputThresholds thresholds;       ///< between outputs and verdict
  Thresholds shared;                 ///< of which rivals listed and folds that prove are the same as with a network
  SideLimits sides;                  ///< when the two sides are not written down alike
  std::function<void(const std::string&)> progress;  ///< told each step before it begins; empty: nobody is told
};

namespace detail {

/// The state of a diagnosis of outputs between its steps.
template <typename Scalar = double>
class OutputsDiagnosis {
 public:
  OutputsDiagnosis(const Campaign& real, const Campaign& sim, const EffectLibrary& library,
                   const OutputsOptions& options)
      : options_(options),
        limits_(options.thresholds),
        library_(library),
        campaign_(pair_campaigns(real, sim, options.room)),
        drives_(campaign_) {}

  /// What is wrong between the sides.
  std::vector<DataProblem> problems() const {
    return compare_sides(sides_of<Scalar>(campaign_, drives_), options_.sides);
  }

  /// What is said where it is certain.
  Diagnosis unlike(std::vector<DataProblem> problems) const {
    Diagnosis result = diagnosis_of_unlike_sides<Scalar>(sides_of<Scalar>(campaign_, drives_), std::move(problems));
    result.simulator = SimulatorKind::outputs;
    return result;
  }

  Diagnosis run(std::vector<DataProblem> problems) {
    result_.data_problems = std::move(problems);
    start();
    for (int round = 0; round < limits_.most_effects; ++round) {
      say("weighing effects, round " + std::to_string(round + 1));
      scan();
      if (!take_best(round > 0)) break;
    }
    conclude();
    return std::move(result_);
  }

 private:
  void say(const std::string& what) const {
    if (options_.progress) options_.progress(what);
  }
  const std::string& name(Index c) const { return campaign_.channels[static_cast<std::size_t>(c)]; }
  PairedChannel& channel(Index c) { return channels_[static_cast<std::size_t>(c)]; }
  const PairedChannel& channel(Index c) const { return channels_[static_cast<std::size_t>(c)]; }

  Index headline() const {
    return static_cast<Index>(leading_channel(
        channels_.size(), [&](std::size_t c) { return static_cast<Index>(c) >= campaign_.temperatures; },
        [&](std::size_t c) { return channels_[c].as_simulated; }));
  }

  /// Calibration alone in every channel.
  void start() {
    std::vector<double> looseness;
    for (Index c = 0; c < campaign_.channel_count(); ++c) {
      PairedChannel one;
      one.basis = calibration_basis<Scalar>(campaign_, drives_, c);
      VectorX<Scalar> gap(campaign_.rows());
      SeriesByBatch readings;
      for (std::size_t b = 0; b < campaign_.batches.size(); ++b) {
        const MatrixX<Scalar>&measured = campaign_.batches[b].measured, &simulated = campaign_.batches[b].simulated;
        readings.push_back(measured.col(c));
        campaign_.part(gap, b) = measured.col(c) - simulated.col(c);
      }
      one.resolution = resolution_sd(readings);
      one.as_simulated = rms_of<Scalar>(gap);
      one.gap = std::move(gap);
      judge_calibration<Scalar>(campaign_, one);
      if (campaign_.is_output(c)) looseness.push_back(best_looseness(one));
      channels_.push_back(std::move(one));
    }
    const auto median = looseness.begin() + static_cast<std::ptrdiff_t>(looseness.size() / 2);
    std::nth_element(looseness.begin(), median, looseness.end());
    const double common = std::min(limits_.loosest, *median);
    for (PairedChannel& one : channels_) {
      VectorX<Scalar>& prior_sd = one.basis.prior_sd;
      prior_sd *= common;
      judge_calibration<Scalar>(campaign_, one);
    }
    first_ = channels_;
  }

  static double best_looseness(const PairedChannel& channel) {
    double best = -std::numeric_limits<double>::infinity(), at = 1;
    const VectorX<Scalar>& prior_sd = channel.basis.prior_sd;
    for (const double looseness : {.06, .1, .2, .35, .6, 1.}) {
      const VectorX<Scalar> narrower = looseness * prior_sd;
      const double log = profiled_evidence<Scalar>(channel, channel.products, narrower).log;
      if (log > best) best = log, at = looseness;
    }
    return at;
  }

  bool wanted(const std::string& effect) const {
    const auto in = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), effect) != list.end();
    };
    return (options_.effects.empty() || in(options_.effects)) && !in(options_.without);
  }

  /// The displacements of a calibrated simulator, by output and batch.
  std::vector<std::vector<Vector>> calibrated_displacements() const {
    std::vector<std::vector<Vector>> result;
    for (Index c = campaign_.temperatures; c < campaign_.channel_count(); ++c) {
      const PairedChannel& one = channel(c);
      const MatrixX<Scalar>& regressors = one.basis.regressors;
      const VectorX<Scalar> gap =
          regressors *
          fit_with_prior(one.products, one.basis.prior_sd, one.calibrated * std::sqrt(one.correlation)).coefficients;
      result.emplace_back();
      for (std::size_t b = 0; b < campaign_.batches.size(); ++b) {
        const MatrixX<Scalar>& simulated = campaign_.batches[b].simulated;
        result.back().push_back(simulated.col(c) + campaign_.part(gap, b));
      }
    }
    return result;
  }

  /// Weighs the traces of all effects anew.
  void scan() {
    OutputTraces traces(campaign_, options_.reference_degC, calibrated_displacements());
    for (const auto& effect : library_.all())
      if (wanted(effect->name())) traces.add(*effect);
    scan_.traces = traces.take();
    scan_.scores.assign(scan_.traces.size(), {});
    in_parallel(scan_.traces.size(), options_.threads,
                [&](std::size_t i) { scan_.scores[i] = score_of<Scalar>(i, scan_.traces[i], channels_, campaign_); });
    std::sort(scan_.scores.begin(), scan_.scores.end(), [](const TraceScore& a, const TraceScore& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.trace < b.trace;
    });
  }

  /// A heat flow that leaves the displacement at its noise explains nothing worth naming.
  bool matters(const TraceScore& score) const {
    const PairedChannel& output = channel(headline());
    return score.channels.size() == 1 || output.as_simulated > limits_.none_below_noises * output.noise;
  }

  /// The strongest of `found` with its rivals, each with its probability among them.
  FoundEffect entry_of(const std::vector<Suspect>& found) const {
    const Suspect& best = found[0];
    FoundEffect effect = named(best, 0);
    for (const Suspect& one : found) {
      const bool same = one.effect == best.effect && one.driver == best.driver;
      if (same) effect.confidence += one.probability;
      if (&one == &best || one.probability < options_.shared.listed) continue;
      if (same)
        effect.same_place.push_back(one.location);
      else
        effect.alternatives.push_back({one.effect, one.location, one.driver, one.probability});
    }
    return effect;
  }

  /// Takes the best effect if it is decisive; returns whether another round makes sense.
  bool take_best(bool further) {
    const std::vector<Suspect> found = suspects_of(scan_, campaign_, limits_);
    if (!further) {
      note_ruled_out(found);
      note_leader(found);
    }
    const double needed = (further ? limits_.further : 1) * limits_.decisive_nats;
    if (found.empty() || found[0].gain < needed || !matters(*found[0].score)) return false;
    const Suspect& best = found[0];
    if (further && is_rival(best)) return false;
    const std::vector<PairedChannel> before = channels_;
    add_to_basis(scan_.trace_of(*best.score));
    if (further && !improves(before, *best.score)) {
      channels_ = before;
      return false;
    }
    result_.effects.push_back(entry_of(found));
    return true;
  }

  /// Keeps what the strongest effect rests on, be it taken or not.
  void note_leader(const std::vector<Suspect>& found) {
    if (found.empty() || !(found[0].gain > 0)) return;
    const Suspect& best = found[0];
    const OutputTrace& trace = scan_.trace_of(*best.score);
    leader_.effect = entry_of(found);
    leader_.trace = trace;
    leader_.score = *best.score;
    const auto rival = std::find_if(found.begin(), found.end(), [&](const Suspect& one) {
      return one.effect != best.effect || one.driver != best.driver;
    });
    leader_.rival = rival == found.end() ? 0 : rival->gain / best.gain;
    stage_ = trace.stage;
    told_ = leader_.score.channels.size() == 1 ? leader_.score.channels[0].channel : headline();
  }

  /// An entry of the diagnosis: what is fixed in the trace, then its strength, or where many channels answer, how large
  /// it is in the one that shows it most.
  FoundEffect named(const Suspect& suspect, double confidence) const {
    const TraceScore& score = *suspect.score;
    const OutputTrace& trace = scan_.trace_of(score);
    const Effect& effect = library_.at(trace.effect);
    FoundEffect result;
    result.effect = trace.effect;
    result.location = suspect.location;
    result.driver = trace.driver;
    result.confidence = confidence;
    for (const TraceNumber& one : trace.shape) result.parameters.push_back({one.name, one.unit, one.value, -1});
    const ChannelScore& first = score.channels[0];
    if (score.channels.size() == 1 && !trace.unit_strength)
      result.parameters.push_back(
          {trace.strength.name, trace.strength.unit, first.coefficients(0), first.standard_errors(0)});
    if (score.channels.size() > 1)
      if (const ChannelScore* most = strongest_sensor(score, campaign_.temperatures))
        result.parameters.push_back({"rms_on_" + name(most->channel) + "_K", "K", most->contribution, -1});
    result.meaning = effect.meaning();
    result.against_as_given = effect.calibration_does_the_same();
    return result;
  }

  bool is_rival(const Suspect& suspect) const {
    for (const FoundEffect& found : result_.effects)
      for (const Rival& rival : found.alternatives)
        if (rival.effect == suspect.effect && rival.location == suspect.location) return true;
    return false;
  }

  /// A further effect must lower the held-out gap where it counts: in the displacement, or in its own thermometer.
  bool improves(const std::vector<PairedChannel>& before, const TraceScore& score) const {
    const auto lowers = [&](Index c, double to) {
      return channel(c).calibrated < to * before[static_cast<std::size_t>(c)].calibrated;
    };
    return lowers(headline(), limits_.helps_displacement) ||
           (score.channels.size() == 1 && lowers(score.channels[0].channel, limits_.helps_thermometer));
  }

  /// The effect's columns join what is free, so that everything is refitted together.
  void add_to_basis(const OutputTrace& trace) {
    for (const Index c : trace.channels) {
      PairedChannel& one = channel(c);
      const TracePrior<Scalar> prior(trace, one);
      const MatrixX<Scalar>&columns = trace.columns, &known = one.basis.regressors;
      const VectorX<Scalar>&scale = prior.scale, &mean = prior.mean, &known_sd = one.basis.prior_sd, &own_sd = prior.sd;
      const MatrixX<Scalar> scaled = columns * scale.cwiseInverse().asDiagonal();
      VectorX<Scalar>& gap = one.gap;
      gap -= scaled * mean;
      MatrixX<Scalar> regressors(scaled.rows(), known.cols() + scaled.cols());
      regressors << known, scaled;
      VectorX<Scalar> sd(regressors.cols());
      sd << known_sd, own_sd;
      one.basis.regressors = std::move(regressors);
      one.basis.prior_sd = std::move(sd);
      judge_calibration<Scalar>(campaign_, one);
    }
  }

  /// What the best leaves behind, once an effect; then what cannot be its effect wherever it acts.
  void note_ruled_out(const std::vector<Suspect>& found) {
    std::vector<std::string> noted;
    const auto is_noted = [&](const std::string& effect) {
      return std::find(noted.begin(), noted.end(), effect) != noted.end();
    };
    for (const Suspect& one : found) {
      if (one.probability >= options_.shared.listed || is_noted(one.effect)) continue;
      noted.push_back(one.effect);
      if (one.effect == found[0].effect) continue;
      const bool no_better = one.gain < limits_.decisive_nats;
      result_.ruled_out.push_back({one.effect, one.location, no_better ? RuledOutBy::calibration : RuledOutBy::evidence,
                                   no_better ? one.gain : found[0].gain - one.gain});
    }
    for (const TraceScore& score : scan_.scores) {
      const std::string& effect = scan_.trace_of(score).effect;
      if (!score.implausible || is_noted(effect)) continue;
      if (std::any_of(found.begin(), found.end(), [&](const Suspect& one) { return one.effect == effect; })) continue;
      noted.push_back(effect);
      result_.ruled_out.push_back(
          {effect, location_of(scan_, score, campaign_), *score.implausible, score.channels[0].coefficients(0)});
    }
  }

  /// The strongest effect of the first round, be it taken or not, and what it rests on.
  struct Leader {
    FoundEffect effect;  ///< with its probability among its rivals
    OutputTrace trace;   ///< its own
    TraceScore score;    ///< of the trace; gain 0: there is none
    double rival = 0;    ///< share of its gain that another effect reaches
  };

  /// What the leader rests on. Channels weigh by what it gains in them: the gap of others speaks neither for nor
  /// against it.
  Support support() const {
    Support result;
    result.candidates = scan_.traces.size();
    if (!(leader_.score.gain > 0)) return result;
    result.nearest = {{leader_.effect.effect, leader_.effect.location, leader_.effect.driver, 0}};
    result.gain_nats = leader_.score.gain;
    result.rival = leader_.rival;
    double weights = 0;
    for (const ChannelScore& one : leader_.score.channels) {
      const PairedChannel &before = first_[static_cast<std::size_t>(one.channel)], &after = channel(one.channel);
      if (!(one.gain > 0) || before.noise <= 0) continue;
      const auto [closed, left] =
          closed_and_left(leader_.effect.against_as_given ? before.as_simulated : before.calibrated, after);
      weights += one.gain;
      result.closes += one.gain * closed;
      result.leaves += one.gain * left;
    }
    if (weights > 0) result.closes /= weights, result.leaves /= weights;
    return result;
  }

  /// Squared gaps of all outputs beyond their noise, in squares of it, with calibration alone and with the effects.
  std::pair<double, double> excess() const {
    double before = 0, after = 0;
    for (Index c = 0; c < campaign_.channel_count(); ++c) {
      const PairedChannel& one = channel(c);
      if (!campaign_.is_output(c) || one.noise <= 0) continue;
      before += beyond_noise(first_[static_cast<std::size_t>(c)].calibrated, one);
      after += beyond_noise(one.calibrated, one);
    }
    return {before, after};
  }

  /// Too much is left in the channels the effect should explain: the cause is something else.
  bool leaves_too_much() const {
    const auto [before, after] = excess();
    return after > limits_.left_per_channel * static_cast<double>(campaign_.channel_count()) &&
           after > limits_.left_share * before;
  }

  /// The gap that is told must shrink on batches left out, else the effect explains something else.
  bool told_gap_shrinks() const {
    const PairedChannel& before = first_[static_cast<std::size_t>(told_)];
    const double with_effect = rms_of<Scalar>(held_out_gap<Scalar>(campaign_, channel(told_)));
    return with_effect < (result_.effects[0].against_as_given
                              ? rms_of<Scalar>(before.gap)
                              : rms_of<Scalar>(held_out_gap<Scalar>(campaign_, before)));
  }

  /// A fault of a thermometer shows in its own reading alone, so that reading judges it whatever has no name elsewhere.
  /// Names the decisive one that closes a good part of its own gap and beats there whatever else could act on that
  /// reading.
  bool name_sensor_fault() {
    channels_ = first_;
    scan();
    for (const TraceScore& score : scan_.scores) {
      const OutputTrace& trace = scan_.trace_of(score);
      const bool thermometer =
          trace.stage == Stage::measurement && trace.channels.size() == 1 && trace.channels[0] < campaign_.temperatures;
      if (score.gain < limits_.decisive_nats) break;
      if (!thermometer || score.implausible || score.channels[0].contribution < limits_.placement_tolerance_K) continue;
      const Index own = trace.channels[0];
      std::vector<Suspect> rivals = suspects_in(own, scan_, campaign_, limits_);
      if (rivals.empty() || rivals[0].score != &score) continue;
      const double before =
          library_.at(trace.effect).calibration_does_the_same() ? channel(own).as_simulated : channel(own).calibrated;
      add_to_basis(trace);
      const double cause = known(closed_and_left(before, channel(own)).first, trace.like_lumping);
      if (channel(own).calibrated > limits_.fault_leaves * before ||
          cause * rivals[0].probability < limits_.least_named) {
        channels_ = first_;
        continue;
      }
      rivals[0].location = name(own);
      FoundEffect effect = named(rivals[0], cause * rivals[0].probability);
      for (std::size_t i = 1; i < rivals.size(); ++i)
        if (rivals[i].probability >= options_.shared.listed && rivals[i].effect != trace.effect)
          effect.alternatives.push_back(
              {rivals[i].effect, rivals[i].location, rivals[i].driver, cause * rivals[i].probability});
      result_.effects = {std::move(effect)};
      stage_ = trace.stage;
      told_ = own;
      return true;
    }
    channels_ = first_;
    return false;
  }

  /// What the gap that is told says where nothing is named.
  Verdict verdict_of_levels() const {
    const PairedChannel& one = channel(told_);
    if (one.as_simulated < limits_.none_below_noises * one.noise) return Verdict::none;
    const bool closed = one.calibrated < limits_.closed_below_noises * one.noise,
               nearly = one.calibrated < limits_.nearly_closed_noises * one.noise &&
                        one.calibrated < limits_.calibration_left * one.as_simulated;
    return closed || nearly ? Verdict::miscalibration : Verdict::unknown;
  }

  /// Probability that a trace which closes this share of its gap is the cause, not the nearest thing in the catalogue
  /// to another one.
  double known(double closes, bool like_lumping) const {
    return logistic(limits_.known_from + limits_.known_by_share * closes -
                    (like_lumping ? limits_.known_like_lumping : 0));
  }

  /// The square of a gap (rms) of a channel beyond its noise, in squares of it.
  static double beyond_noise(double rms, const PairedChannel& channel) {
    return std::max(0., std::pow(rms / channel.noise, 2) - 1);
  }

  /// Share of the squared gap `from` (rms) of a channel, beyond its noise, that is closed now, and what is left of it
  /// in squares of the noise.
  std::pair<double, double> closed_and_left(double from, const PairedChannel& now) const {
    const double open = beyond_noise(from, now), left = beyond_noise(now.calibrated, now);
    return {open > 0 ? std::clamp(1 - left / open, 0., 1.) : 1, left};
  }

  /// Suspects the leader where it is not decisive: true effects that are that faint gain little more than chance does.
  void suspect_leader() {
    FoundEffect suspect = leader_.effect;
    suspect.closes = result_.support.closes;
    suspect.confidence =
        std::min(.5, logistic(limits_.suspected_from + limits_.suspected_by_gain * std::log1p(leader_.score.gain) +
                              limits_.suspected_by_share * suspect.closes));
    suspect.alternatives.clear();
    if (suspect.confidence >= limits_.least_suspected) result_.suspected = {std::move(suspect)};
  }

  /// Leaves named what held-out batches bear out and is probable enough; the rest of it is a part of the cause,
  /// suspected or ruled out. Whether a gap without a name remains beside it.
  bool take_back() {
    const bool too_much = leaves_too_much(), shrinks = told_gap_shrinks();
    const double cause = known(result_.support.closes, leader_.trace.like_lumping);
    for (FoundEffect& one : result_.effects) {
      one.confidence *= cause;
      for (Rival& rival : one.alternatives) rival.confidence *= cause;
    }
    FoundEffect& nearest = result_.effects[0];
    nearest.closes = result_.support.closes;
    if (!too_much && shrinks && nearest.confidence >= limits_.least_named) return false;
    nearest.confidence = std::min(nearest.confidence, .5);
    if (nearest.confidence < limits_.least_suspected) {
      result_.ruled_out.insert(result_.ruled_out.begin(), {nearest.effect, nearest.location, RuledOutBy::remains, 0});
    } else if (too_much && shrinks) {
      result_.parts.push_back(nearest);
    } else {
      result_.suspected.push_back(nearest);
    }
    result_.effects.clear();
    return too_much || !shrinks;
  }

  /// Takes back what is no name, looks for a faulty thermometer beside a gap without a name, decides the verdict and
  /// tells the rest.
  void conclude() {
    const bool taken = !result_.effects.empty(), led = leader_.score.gain > 0;
    if (!taken && led) add_to_basis(leader_.trace);
    result_.support = support();
    const bool remains = taken && take_back();
    if (!taken && led) suspect_leader();
    if (result_.effects.empty() && !remains) {
      channels_ = first_;
      told_ = headline();
    }
    Verdict unnamed = Verdict::unknown;
    std::vector<std::string> beside;
    if (result_.effects.empty()) {
      if (!remains) unnamed = verdict_of_levels();
      if (unnamed == Verdict::unknown && name_sensor_fault())
        for (Index c = 0; c < campaign_.channel_count(); ++c)
          if (c != told_ && campaign_.is_output(c) &&
              channel(c).calibrated > limits_.closed_below_noises * channel(c).noise)
            beside.push_back(name(c));
    }
    const bool named = !result_.effects.empty(), few = campaign_.batches.size() < options_.shared.proving_folds;
    if (named && few)
      for (FoundEffect& one : result_.effects) one.confidence = std::min(one.confidence, .5);
    const bool unsure = named && (!result_.effects[0].alternatives.empty() || result_.effects[0].confidence < .5);
    result_.verdict = !named ? unnamed : few || unsure ? Verdict::ambiguous : Verdict::effect;
    tell(beside);
  }

  void tell(const std::vector<std::string>& beside) {
    result_.simulator = SimulatorKind::outputs;
    result_.judged_by = named_numbers(limits_);
    result_.judged_by.emplace_back("listed", options_.shared.listed);
    result_.judged_by.emplace_back("proving_folds", static_cast<double>(options_.shared.proving_folds));
    double hours = 0;
    for (const PairedBatch& batch : campaign_.batches) {
      result_.batches.push_back(batch.name);
      hours = std::max(hours, batch.time_s(batch.time_s.size() - 1) / 3600);
    }
    const bool named = !result_.effects.empty();
    const OutputViews<Scalar> views(campaign_, first_, channels_, named, told_);
    result_.gap = views.gap(options_.seed);
    result_.where = views.where();
    if (named) result_.where.stages.push_back({word_of(stage_), 1});
    result_.remaining = views.remaining(result_.gap.rms, options_.seed);
    for (DataProblem& one : pairing_problems(campaign_)) result_.data_problems.push_back(std::move(one));
    result_.weaker_claims = claims_of_outputs<Scalar>(campaign_, beside);
    result_.next_experiment = named ? experiment_by_kind(result_.effects[0], library_, hours)
                              : result_.suspected.empty()
                                  ? experiment_without_rivals(result_, hours)
                                  : experiment_for_suspect(result_.suspected[0], library_, hours);
    for (PlannedBlock& block : result_.next_experiment.plan)
      if (block.kind == ScheduleKind::toggle && !is_set(block.subject))
        block = block_that_shows(ScheduleKind::idle_day, "", block.machine_hours);
  }

  /// Whether somebody sets this input, so that it can be switched; no thermometer can.
  bool is_set(const std::string& input) const {
    const auto at = std::find(campaign_.inputs.begin(), campaign_.inputs.end(), input);
    if (at == campaign_.inputs.end()) return false;
    HeldLevels held;
    for (const PairedBatch& batch : campaign_.batches)
      count_held(held, batch.inputs.col(at - campaign_.inputs.begin()));
    return thermfit::is_set(std::move(held));
  }

  const OutputsOptions& options_;
  const OutputThresholds& limits_;
  const EffectLibrary& library_;
  PairedCampaign campaign_;
  Drives<Scalar> drives_;
  std::vector<PairedChannel> channels_;
  std::vector<PairedChannel> first_;  ///< with calibration alone
  OutputScan scan_;
  Stage stage_ = Stage::heat;
  Leader leader_;   ///< of the first round
  Index told_ = 0;  ///< the channel the gap is told for: the effect's own where it acts on one, else the headline
  Diagnosis result_;
};

}  // namespace detail

/// Diagnoses the gap between measured batches and a simulator's output for them, paired by name. The result is
/// complete. Cells that are no readings are left out; sides that are not written down alike are told, and nothing else.
///
/// Every effect of `library` acts through the trace it would leave in the outputs, given inputs, measured temperatures
/// and time; what the simulator's own parameters could change (gains and lags of each drive's contribution, learnt from
/// the simulated courses) is free in every comparison. An effect is named when its evidence beats calibration by
/// `decisive_nats`; the gap before and after is that of batches left out. Throws Error when the two sides do not pair.
/// Allocates.
template <typename Scalar = double>
Diagnosis diagnose_outputs(const Campaign& real, const Campaign& simulated, const EffectLibrary& library,
                           const OutputsOptions& options = {}) {
  WithoutBadCells measured = without_bad_cells(real, DataProblem::Side::measured),
                  outputs = without_bad_cells(simulated, DataProblem::Side::simulated);
  std::vector<DataProblem> problems = compare_clocks<Scalar>(measured.campaign, outputs.campaign);
  if (sides_unlike(problems)) {
    Diagnosis unlike = diagnosis_of_unlike_sides<Scalar>({}, std::move(problems));
    unlike.simulator = SimulatorKind::outputs;
    return unlike;
  }
  using OutputsDiagnosis = detail::OutputsDiagnosis<Scalar>;
  auto diagnosis = std::make_unique<OutputsDiagnosis>(measured.campaign, outputs.campaign, library, options);
  problems = diagnosis->problems();
  if (start_alike<Scalar>(measured.campaign, outputs.campaign, problems))
    diagnosis = std::make_unique<OutputsDiagnosis>(measured.campaign, outputs.campaign, library, options);
  for (WithoutBadCells* side : {&measured, &outputs})
    for (DataProblem& one : side->left_out) problems.push_back(std::move(one));
  return sides_unlike(problems) ? diagnosis->unlike(std::move(problems)) : diagnosis->run(std::move(problems));
}

THERMFIT_COMPILED_TEMPLATE(Diagnosis diagnose_outputs<double>(const Campaign&, const Campaign&, const EffectLibrary&,
                                                              const OutputsOptions&));

}  // namespace thermfit
