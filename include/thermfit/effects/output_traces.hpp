#pragma once

/// What effects leave in the outputs of a simulator whose network is not known.

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "thermfit/batch/paired_campaign.hpp"
#include "thermfit/network/effect.hpp"
#include "thermfit/statistics/filters.hpp"

namespace thermfit {

/// A number of a trace: a coefficient to be fitted, or what is fixed in this variant.
struct TraceNumber {
  std::string name;  ///< with its unit, as a parameter of the effect: "lag_s"
  std::string unit;  ///< "s"; empty for a pure number
  double value = 0;  ///< where it is fixed, in `unit`
};

/// One effect at one place, with its shape parameter (a lag, a delay, an exponent) fixed: its regressors in each batch.
struct OutputTrace {
  std::string effect;                          ///< name in the library
  std::string location;                        ///< empty: the thermometer in which it shows most
  std::string driver;                          ///< empty where the effect has none
  Stage stage = Stage::heat;                   ///< of the effect
  std::vector<Index> channels;                 ///< in which the regressors count, each with coefficients of its own
  Matrix columns;                              ///< all batches below each other
  TraceNumber strength;                        ///< name and unit of the coefficient of a single column
  std::vector<TraceNumber> shape;              ///< what is fixed in this variant
  bool unit_strength = false;                  ///< the coefficient is 1 by its law: the shape alone sets the size
  bool like_lumping = false;                   ///< lags alone shape it: what coarse lumps leave looks much alike
  std::vector<std::pair<Index, int>> acts_on;  ///< where its heat flow acts, with the sign of the response (0: either)
};

/// A law along a batch: of one sample, `double(const PairedBatch&, Index sample)`, or of the whole batch,
/// `Vector(const PairedBatch&)`. It refers to the law and does not keep it: for use as an argument only.
class TraceLaw {
 public:
  /// Refers to `law`, of either kind.
  template <typename Law>
  TraceLaw(const Law& law) : law_(&law) {  // NOLINT(google-explicit-constructor)
    if constexpr (std::is_invocable_v<const Law&, const PairedBatch&, Index>)
      sample_ = [](const void* of, const PairedBatch& batch, Index k) -> double {
        return (*static_cast<const Law*>(of))(batch, k);
      };
    else
      whole_ = [](const void* of, const PairedBatch& batch) -> Vector { return (*static_cast<const Law*>(of))(batch); };
  }
  /// Its value in every sample of a batch. Allocates.
  Vector operator()(const PairedBatch& batch) const {
    if (whole_) return whole_(law_, batch);
    Vector result(batch.time_s.size());
    for (Index k = 0; k < result.size(); ++k) result(k) = sample_(law_, batch, k);
    return result;
  }

 private:
  const void* law_;
  double (*sample_)(const void*, const PairedBatch&, Index) = nullptr;
  Vector (*whole_)(const void*, const PairedBatch&) = nullptr;
};

/// An input that is not always zero.
struct TraceInput {
  Index column = 0;     ///< in PairedBatch::inputs
  std::string name;     ///< of the column
  double largest = 0;   ///< largest absolute value in the campaign
  bool on_off = false;  ///< never anything but 0 and 1

  /// Its value in a sample.
  double at(const PairedBatch& batch, Index k) const { return batch.inputs(k, column); }
  /// Absolute value as a share of the largest.
  double share(const PairedBatch& batch, Index k) const { return std::abs(at(batch, k)) / largest; }
};

/// Lags (s) that span a batch: from its fiftieth to its fourfold duration.
inline std::vector<double> lag_ladder_s(const PairedCampaign& campaign) {
  double duration_s = 0;
  for (const PairedBatch& batch : campaign.batches)
    duration_s = std::max(duration_s, batch.time_s(batch.time_s.size() - 1));
  return {.02 * duration_s, .07 * duration_s, .25 * duration_s, .8 * duration_s, 4 * duration_s};
}

/// What the traces of effects are built from, and to which each effect adds its own in Effect::trace().
///
/// A heat flow into an unknown network answers through unknown lags: heat_flow() gives it a ladder of them in every
/// channel. What acts on one reading alone is added_to() that channel, or bends() its course. The campaign must outlive
/// this.
class OutputTraces {
 public:
  /// `calibrated` holds the simulated displacements after calibration, by output and batch.
  OutputTraces(const PairedCampaign& campaign, double reference_degC, std::vector<std::vector<Vector>> calibrated)
      : campaign_(campaign),
        reference_degC_(reference_degC),
        calibrated_(std::move(calibrated)),
        lags_s_(lag_ladder_s(campaign)) {}

  /// Lets an effect add its traces.
  void add(const Effect& effect) {
    effect_ = effect.name();
    stage_ = effect.stage();
    effect.trace(*this);
  }
  /// All traces in the order in which they were added; none remain.
  std::vector<OutputTrace> take() { return std::move(found_); }

  /// Temperature at which expansion and gain are zero.
  double reference_degC() const { return reference_degC_; }
  /// Duration of the longest batch.
  double longest_batch_s() const { return lags_s_[4] / 4; }
  /// A rung, 0…4, of lag_ladder_s().
  double lag_s(std::size_t rung) const { return lags_s_[rung]; }
  /// Whether the temperature of the room is known.
  bool has_room() const { return !campaign_.room.empty(); }
  /// Whether the simulator used it.
  bool room_is_simulated() const { return campaign_.room_is_simulated; }
  /// Of a channel.
  const std::string& name(Index channel) const { return campaign_.channels[static_cast<std::size_t>(channel)]; }

  /// Channels of the thermometers on the machine; the room's is an input.
  std::vector<Index> thermometers() const {
    std::vector<Index> result;
    for (Index c = 0; c < campaign_.temperatures; ++c)
      if (campaign_.is_output(c)) result.push_back(c);
    return result;
  }
  /// Channels of the displacements.
  std::vector<Index> displacements() const {
    std::vector<Index> result;
    for (Index c = campaign_.temperatures; c < campaign_.channel_count(); ++c) result.push_back(c);
    return result;
  }
  /// What a channel is called as a place: a thermometer by its name, the only displacement `displacement`.
  std::string place(Index channel) const {
    const bool only = channel >= campaign_.temperatures && campaign_.channel_count() == campaign_.temperatures + 1;
    return only ? "displacement" : name(channel);
  }
  /// Inputs that are not always zero.
  std::vector<TraceInput> inputs() const {
    std::vector<TraceInput> result;
    for (std::size_t i = 0; i < campaign_.inputs.size(); ++i) {
      TraceInput one{static_cast<Index>(i), campaign_.inputs[i], 0, true};
      for (const PairedBatch& batch : campaign_.batches)
        for (Index k = 0; k < batch.inputs.rows(); ++k) {
          const double value = one.at(batch, k);
          one.largest = std::max(one.largest, std::abs(value));
          one.on_off = one.on_off && (value == 0 || value == 1);
        }
      if (one.largest > 0) result.push_back(std::move(one));
    }
    return result;
  }
  /// Largest range (um, K) of a channel within a batch, as a calibrated simulator gives it.
  double range_of(Index channel) const {
    double range = 0;
    for (std::size_t b = 0; b < campaign_.batches.size(); ++b) {
      const Vector course = simulated(channel, b);
      const auto [low, high] = std::minmax_element(course.data(), course.data() + course.size());
      range = std::max(range, *high - *low);
    }
    return range;
  }

  /// K since the first sample of the batch.
  static double rise_K(const PairedBatch& batch, Index channel, Index k) {
    return batch.measured(k, channel) - batch.measured(0, channel);
  }
  /// K since the first sample of the batch.
  static double room_rise_K(const PairedBatch& batch, Index k) { return batch.room_degC(k) - batch.room_degC(0); }
  /// K above the room; since the first sample where no room is known.
  double rise_over_room_K(const PairedBatch& batch, Index channel, Index k) const {
    return has_room() ? batch.measured(k, channel) - batch.room_degC(k) : rise_K(batch, channel, k);
  }

  /// A trace in one channel alone, with a free coefficient named by `strength`. Displacements that count from their
  /// first sample show only its change since then.
  OutputTrace& added_to(Index channel, std::string location, std::string driver, TraceNumber strength,
                        const TraceLaw& course) {
    OutputTrace& one = begin(std::move(location), std::move(driver), {channel}, 1);
    one.strength = std::move(strength);
    for (std::size_t b = 0; b < campaign_.batches.size(); ++b) {
      const Vector values = course(campaign_.batches[b]);
      put(one, 0, b, values, channel >= campaign_.temperatures && campaign_.zeroed ? values(0) : 0);
    }
    return one;
  }

  /// One channel whose course is bent by a law of known strength: what `law(time_s, course)` differs from `course`, the
  /// one that a calibrated simulator gives. `shape` is what is fixed in the law.
  OutputTrace& bends(Index channel, TraceNumber shape, const std::function<Vector(const Vector&, const Vector&)>& law) {
    OutputTrace& one = begin(place(channel), {}, {channel}, 1);
    one.strength = {"strength", "1"};
    one.unit_strength = true;
    one.like_lumping = channel < campaign_.temperatures;
    one.shape = {std::move(shape)};
    for (std::size_t b = 0; b < campaign_.batches.size(); ++b) {
      const Vector course = simulated(channel, b);
      Vector values = law(campaign_.batches[b].time_s, course);
      for (Index k = 0; k < values.size(); ++k) values(k) -= course(k);
      put(one, 0, b, values);
    }
    return one;
  }

  /// Heat flows of an unknown size into an unknown place: each through four lags, in every channel. An empty location
  /// is where it shows most.
  OutputTrace& heat_flow(std::string location, std::string driver, const std::vector<TraceLaw>& flows) {
    OutputTrace& one =
        begin(std::move(location), std::move(driver), every_channel(), rungs * static_cast<Index>(flows.size()));
    one.like_lumping = true;
    for (std::size_t b = 0; b < campaign_.batches.size(); ++b)
      for (std::size_t f = 0; f < flows.size(); ++f) {
        const Vector flow = flows[f](campaign_.batches[b]);
        for (Index k = 0; k < rungs; ++k)
          put(one, static_cast<Index>(f) * rungs + k, b,
              low_pass(campaign_.batches[b].time_s, flow, lags_s_[static_cast<std::size_t>(k)], 0));
      }
    return one;
  }
  /// One such heat flow.
  OutputTrace& heat_flow(std::string location, std::string driver, TraceLaw flow) {
    return heat_flow(std::move(location), std::move(driver), std::vector<TraceLaw>{std::move(flow)});
  }

  /// A start of its own that fades: through four lags, in every channel.
  OutputTrace& fading_start() {
    OutputTrace& one = begin({}, {}, every_channel(), rungs);
    one.like_lumping = true;
    for (std::size_t b = 0; b < campaign_.batches.size(); ++b)
      for (Index k = 0; k < rungs; ++k) {
        Vector left = campaign_.batches[b].time_s;
        for (Index i = 0; i < left.size(); ++i) left(i) = std::exp(-left(i) / lags_s_[static_cast<std::size_t>(k)]);
        put(one, k, b, left);
      }
    return one;
  }

 private:
  static constexpr Index rungs = 4;  ///< of the ladder; its fifth is for calibration alone

  OutputTrace& begin(std::string location, std::string driver, std::vector<Index> channels, Index columns) {
    OutputTrace one;
    one.effect = effect_;
    one.location = std::move(location);
    one.driver = std::move(driver);
    one.stage = stage_;
    one.channels = std::move(channels);
    one.columns.resize(campaign_.rows(), columns);
    found_.push_back(std::move(one));
    return found_.back();
  }
  void put(OutputTrace& trace, Index column, std::size_t batch, const Vector& values, double zero = 0) const {
    const Index first = campaign_.first_row(batch);
    for (Index k = 0; k < values.size(); ++k) trace.columns(first + k, column) = values(k) - zero;
  }
  std::vector<Index> every_channel() const {
    std::vector<Index> result = thermometers();
    for (const Index c : displacements()) result.push_back(c);
    return result;
  }
  /// The course a calibrated simulator gives; a temperature's calibration is small and left out.
  Vector simulated(Index channel, std::size_t batch) const {
    if (channel >= campaign_.temperatures)
      return calibrated_[static_cast<std::size_t>(channel - campaign_.temperatures)][batch];
    const Matrix& all = campaign_.batches[batch].simulated;
    Vector course(all.rows());
    for (Index k = 0; k < all.rows(); ++k) course(k) = all(k, channel);
    return course;
  }

  const PairedCampaign& campaign_;
  double reference_degC_;
  std::vector<std::vector<Vector>> calibrated_;
  std::vector<double> lags_s_;
  std::string effect_;
  Stage stage_ = Stage::heat;
  std::vector<OutputTrace> found_;
};

}  // namespace thermfit
