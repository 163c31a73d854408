#pragma once

/// What is wrong between two sides before any effect: units, signs, exchanged and copied columns, clocks.
///
/// Each is a hypothesis about how a column was written down. It is weighed against the column as given by how probable
/// the other side makes it, with everything that calibration may move free within belief, and against what an effect
/// could do that looks alike (a thermometer off by degrees, a part that expands).

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/diagnosis/diagnosis.hpp"
#include "thermfit/diagnosis/sides/channel_belief.hpp"
#include "thermfit/diagnosis/sides/reading.hpp"
#include "thermfit/diagnosis/sides/side_channel.hpp"
#include "thermfit/statistics/rms.hpp"

namespace thermfit {

/// When a difference between the sides is one of how they were written down.
struct SideLimits {
  double certain_nats = 10;       ///< of log probability over everything else within belief: certain
  double suspected_nats = 4;      ///< suspected
  double level_K = 12;            ///< temperatures that agree better than this are in one unit
  double unit_within = 2.2;       ///< a factor between the sides is that of a unit where it is so near to it …
  double beyond_belief = 5;       ///< … and no miscalibration where it is beyond this
  double least_correlation = .6;  ///< of displacements that are the same but for unit or sign
  double exchanged = .9;          ///< exchanged columns must lower the misfit of both together to this share
  double plain = .5;              ///< where they lower it to this share before any calibration, that counts by itself
  double exchanged_room = .5;     ///< with the room among them: the misfit of every channel, on the average
  double copied = .5;             ///< a simulator that shows two columns alike which differ by this share of their rise
  double relative_sd = .3;        ///< what a prior standard deviation is of a number of the simulator
  double drive_leaves = .35;  ///< another clock or room must explain the channels but for this share of their course
  double late = .67;          ///< a clock that is off must lower the misfit to this share
  double room_degC = 20;      ///< rooms are as warm as that …
  double room_sd_K = 10;      ///< … within this standard deviation …
  double warmest_start_degC = 45;  ///< … and no warmer
};

namespace detail {

template <typename Scalar = double>
class SideComparison {
 public:
  SideComparison(const Sides& sides, const SideLimits& limits) : sides_(sides), limits_(limits) {
    all_.resize(sides.batches.size());
    std::iota(all_.begin(), all_.end(), std::size_t{0});
  }

  std::vector<DataProblem> run() {
    for (std::size_t c = 0; c < sides_.channels.size(); ++c)
      sides_.channels[c].displacement ? displacement(c) : temperature(c);
    if (std::none_of(found_.begin(), found_.end(), [](const DataProblem& one) { return one.certain; })) {
      copied(false);
      if (found_.empty()) exchanged();
      if (found_.empty()) copied(true);
      late();
    }
    return std::move(found_);
  }

  /// What belief leaves of the channels as given, as a share of how they move: the median.
  double share_left() {
    std::vector<double> shares;
    for (std::size_t c = 0; c < sides_.channels.size(); ++c) {
      VectorX<Scalar> moved = courses(c, c, all_).first;
      centre(moved, all_);
      const double swing = rms_of<Scalar>(moved);
      if (swing > 3 * channel(c).noise) shares.push_back(weigh(c, all_, {}).left / swing);
    }
    if (shares.empty()) return 1;
    std::nth_element(shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2), shares.end());
    return shares[shares.size() / 2];
  }

  /// log probability of all channels as given.
  double nats_as_given() {
    double sum = 0;
    for (std::size_t c = 0; c < sides_.channels.size(); ++c) sum += weigh(c, all_, {}).nats;
    return sum;
  }

 private:
  using Batches = std::vector<std::size_t>;
  using Kind = DataProblem::Kind;
  using Side = DataProblem::Side;

  const SideChannel& channel(std::size_t c) const { return sides_.channels[c]; }

  /// Every batch about its own mean: the zero of a probe is nobody's business here.
  void centre(Eigen::Ref<MatrixX<Scalar>> values, const Batches& batches) const {
    Index row = 0;
    for (const std::size_t b : batches) {
      const Index rows = sides_.time_s[b].size();
      auto part = values.middleRows(row, rows);
      for (Index j = 0; j < part.cols(); ++j) part.col(j).array() -= part.col(j).mean();
      row += rows;
    }
  }

  /// Simulated and measured samples of a channel, gaps in the measurement (and what is not simulated) 0 in both.
  std::pair<VectorX<Scalar>, VectorX<Scalar>> courses(std::size_t measured, std::size_t simulated,
                                                      const Batches& batches) const {
    VectorX<Scalar> y = stacked<Scalar>(channel(measured).measured, batches),
                    x = stacked<Scalar>(channel(simulated).simulated, batches);
    for (Index k = 0; k < y.size(); ++k)
      if (!std::isfinite(y(k) + x(k))) y(k) = x(k) = 0;
    return {std::move(y), std::move(x)};
  }

  const ChannelBelief<Scalar>& belief(std::size_t c, const Batches& batches, const MatrixX<Scalar>& beside) {
    const auto key = std::make_pair(c, batches);
    const bool plain = beside.cols() == 0;
    if (plain)
      if (const auto known = beliefs_.find(key); known != beliefs_.end()) return known->second;
    const MatrixX<Scalar> directions = directions_of(c, batches);
    MatrixX<Scalar> with(directions.rows(), directions.cols() + beside.cols());
    with.leftCols(directions.cols()) = directions;
    if (!plain) with.rightCols(beside.cols()) = beside;
    ChannelBelief<Scalar> made(std::move(with), looks_per_batch * static_cast<double>(batches.size()));
    if (!plain) return beside_ = std::move(made);
    return beliefs_.emplace(key, std::move(made)).first->second;
  }

  MatrixX<Scalar> directions_of(std::size_t c, const Batches& batches) const {
    const MatrixX<Scalar> whole = sides_.belief(c);
    std::vector<Index> first{0};
    for (const Vector& time_s : sides_.time_s) first.push_back(first.back() + time_s.size());
    Index rows = 0;
    for (const std::size_t b : batches) rows += sides_.time_s[b].size();
    MatrixX<Scalar> directions(rows, whole.cols());
    rows = 0;
    for (const std::size_t b : batches) {
      directions.middleRows(rows, sides_.time_s[b].size()) = whole.middleRows(first[b], sides_.time_s[b].size());
      rows += sides_.time_s[b].size();
    }
    if (channel(c).displacement) centre(directions, batches);
    return directions;
  }

  /// The measured channel under a reading, as what `simulated` should show; per unit of what was measured.
  WeighedGap weigh(std::size_t measured, std::size_t simulated, const Batches& batches, const Reading& reading,
                   const MatrixX<Scalar>& beside = MatrixX<Scalar>()) {
    auto [y, x] = courses(measured, simulated, batches);
    const double scale = reading.turned ? -reading.scale : reading.scale, size = std::abs(scale);
    VectorX<Scalar> gap = (scale * y - x).array() + reading.shift;
    VectorX<Scalar> moves = x, moved = y;
    centre(moves, batches), centre(moved, batches);
    if (channel(simulated).displacement) centre(gap, batches);
    const double swing = std::max(rms_of<Scalar>(moves), size * rms_of<Scalar>(moved));
    const double floor = std::max({size * channel(measured).noise, .01 * swing, 1e-9});
    WeighedGap result = belief(simulated, batches, beside).weigh(gap, floor);
    const double looks =
        std::min(looks_per_batch * static_cast<double>(batches.size()), static_cast<double>(gap.size()));
    result.nats += looks * std::log(size);
    result.left /= size;
    return result;
  }
  WeighedGap weigh(std::size_t c, const Batches& batches, const Reading& reading,
                   const MatrixX<Scalar>& beside = MatrixX<Scalar>()) {
    return weigh(c, c, batches, reading, beside);
  }

  /// By how much a reading is more probable than the channel as given, whatever looks alike added to it.
  double margin(std::size_t c, const Batches& batches, const Reading& reading) {
    const WeighedGap with = weigh(c, batches, reading);
    double given = weigh(c, batches, {}).nats;
    if (with.nats - given < limits_.suspected_nats) return with.nats - given;
    for (const VectorX<Scalar>& alike : lookalikes(c, batches))
      given = std::max(given, weigh(c, batches, {}, alike).nats);
    return with.nats - given;
  }

  /// What single effects could do to a channel: a thermometer off by ten kelvin, or by its whole swing; a part that
  /// expands as each thermometer rises, per kelvin as much as the part that expands most.
  std::vector<VectorX<Scalar>> lookalikes(std::size_t c, const Batches& batches) const {
    std::vector<VectorX<Scalar>> result;
    const auto [y, x] = courses(c, c, batches);
    if (!channel(c).displacement) {
      result.push_back(VectorX<Scalar>::Constant(x.size(), 10));
      VectorX<Scalar> rise = x;
      centre(rise, batches);
      result.push_back(std::move(rise));
      return result;
    }
    const MatrixX<Scalar> directions = directions_of(c, batches);
    const double largest = std::sqrt(directions.colwise().squaredNorm().maxCoeff() / static_cast<double>(x.size()));
    std::vector<std::pair<double, VectorX<Scalar>>> rises;
    for (std::size_t j = 0; j < sides_.channels.size(); ++j) {
      if (channel(j).displacement) continue;
      VectorX<Scalar> rise = courses(j, j, batches).second;
      centre(rise, batches);
      const double size = rms_of<Scalar>(rise);
      if (size > 0) rises.emplace_back(size, std::move(rise));
    }
    double warmest = 0;
    for (const auto& one : rises) warmest = std::max(warmest, one.first);
    const double um_per_K =
        sides_.largest_um_per_K > 0 ? sides_.largest_um_per_K : largest / limits_.relative_sd / warmest;
    for (const auto& one : rises) result.push_back(um_per_K * one.second);
    return result;
  }

  /// Tells a problem, joined with one that differs in the channel only.
  void tell(DataProblem problem) {
    for (DataProblem& one : found_)
      if (one.kind == problem.kind && one.side == problem.side && one.unit == problem.unit &&
          one.certain == problem.certain && one.batches == problem.batches && problem.kind == Kind::unit) {
        one.names.insert(one.names.end(), problem.names.begin(), problem.names.end());
        return;
      }
    found_.push_back(std::move(problem));
  }

  std::vector<std::string> names_of(const Batches& batches) const {
    std::vector<std::string> names;
    if (batches.size() == sides_.batches.size()) return names;
    for (const std::size_t b : batches) names.push_back(sides_.batches[b]);
    return names;
  }

  DataProblem problem(Kind kind, std::vector<std::string> names, double nats) const {
    DataProblem result;
    result.kind = kind;
    result.names = std::move(names);
    result.certain = nats >= limits_.certain_nats;
    result.nats = nats;
    return result;
  }

  /// Temperatures that disagree by more than any machine does, and agree in another unit: one for all batches that do.
  void temperature(std::size_t c) {
    const std::vector<Reading> readings = temperature_readings();
    Batches odd;
    std::vector<double> misfit(readings.size(), 0);
    for (const std::size_t b : all_) {
      const auto [y, x] = courses(c, c, {b});
      if (!(rms_of<Scalar>(VectorX<Scalar>(y - x)) > limits_.level_K)) continue;
      odd.push_back(b);
      for (std::size_t r = 0; r < readings.size(); ++r) misfit[r] += misfit_K(y, x, readings[r]);
    }
    if (odd.empty()) return;
    const std::size_t best = static_cast<std::size_t>(std::min_element(misfit.begin(), misfit.end()) - misfit.begin());
    const Reading& reading = readings[best];
    Batches in;
    for (const std::size_t b : all_) {
      const auto [y, x] = courses(c, c, {b});
      if (misfit_K(y, x, reading) < misfit_K(y, x, {})) in.push_back(b);
    }
    if (best == 0 || in.empty()) return;
    const double nats = margin(c, in, reading);
    if (nats < limits_.suspected_nats) return;
    DataProblem one = problem(Kind::unit, {channel(c).name}, nats);
    one.side = reading.simulated ? Side::simulated : Side::measured;
    one.unit = reading.unit;
    one.batches = names_of(in);
    tell(std::move(one));
  }

  /// What a reading leaves between temperatures, K.
  static double misfit_K(const VectorX<Scalar>& y, const VectorX<Scalar>& x, const Reading& reading) {
    const VectorX<Scalar> gap = (reading.scale * y - x).array() + reading.shift;
    return rms_of<Scalar>(gap) / (reading.simulated ? reading.scale : 1);
  }

  /// How a displacement of one side is a multiple of the other: factor and sign; as given where it is neither.
  Reading multiple(std::size_t c, const Batches& batches, double& factor) const {
    auto [y, x] = courses(c, c, batches);
    centre(y, batches), centre(x, batches);
    const double moved = y.norm(), moves = x.norm();
    factor = moves > 0 ? moved / moves : 0;
    Reading best;
    if (!(moved > 0 && moves > 0)) return best;
    const double correlation = x.dot(y) / (moved * moves);
    if (std::abs(correlation) < limits_.least_correlation) return best;
    double least = std::log(limits_.unit_within);
    const double plausible = std::abs(std::log(factor));
    if (plausible < least) least = plausible;
    bool found = plausible <= least;
    for (const LengthUnit& unit : length_units)
      for (const bool simulated : {false, true}) {
        const double expected = simulated ? unit.um : 1 / unit.um;
        const double off = std::abs(std::log(factor / expected));
        if (unit.um == 1 || off > least + 1e-9) continue;
        if (found && off > least - 1e-9 && !more_plausible(simulated, y, x)) continue;
        best = {unit.name, simulated, false, 1 / expected, 0};
        least = off;
        found = true;
      }
    if (!found && plausible > std::log(limits_.beyond_belief)) best = {"counts", false, false, 1 / factor, 0};
    best.turned = correlation < 0;
    return best;
  }

  /// Whether it is this side that moves by what no machine does.
  static bool more_plausible(bool simulated, const VectorX<Scalar>& y, const VectorX<Scalar>& x) {
    const auto odd = [](double rms) { return std::abs(std::log(rms / 20)); };  // machines are off by some 20 um
    return odd(rms_of<Scalar>(simulated ? x : y)) > odd(rms_of<Scalar>(simulated ? y : x));
  }

  void displacement(std::size_t c) {
    double factor = 1;
    const Reading whole = multiple(c, all_, factor);
    if (!whole.as_given()) {
      tell_displacement(c, all_, whole, factor);
      return;
    }
    std::map<std::pair<std::string, std::pair<bool, bool>>, std::pair<Reading, Batches>> single;
    for (const std::size_t b : all_) {
      const Reading one = multiple(c, {b}, factor);
      if (one.as_given() || one.unit == "counts") continue;
      auto& group = single[{one.unit, {one.simulated, one.turned}}];
      group.first = one;
      group.second.push_back(b);
    }
    for (const auto& entry : single) {
      multiple(c, entry.second.second, factor);
      tell_displacement(c, entry.second.second, entry.second.first, factor);
    }
  }

  void tell_displacement(std::size_t c, const Batches& batches, const Reading& reading, double factor) {
    const double nats = margin(c, batches, reading);
    if (nats < limits_.suspected_nats) return;
    const auto add = [&](Kind kind) {
      DataProblem one = problem(kind, {channel(c).name}, nats);
      one.side = kind == Kind::unit ? (reading.simulated ? Side::simulated : Side::measured) : Side::either;
      if (kind == Kind::unit) one.unit = reading.unit;
      one.figure = factor;
      one.batches = names_of(batches);
      tell(std::move(one));
    };
    if (reading.unit == "counts")
      add(Kind::factor);
    else if (!reading.unit.empty())
      add(Kind::unit);
    if (reading.turned) add(Kind::sign);
  }

  /// What a ratio of misfits before any calibration says of two channels: one look a batch, for what the simulator
  /// lacks is the same in all samples.
  double plain_nats(double ratio) const { return -2 * static_cast<double>(all_.size()) * std::log(ratio); }

  /// Thermometers whose columns were exchanged, two by two.
  void exchanged() {
    struct Pair {
      std::size_t a, b;
      double nats;
    };
    std::vector<Pair> pairs;
    const auto misfit = [&](std::size_t i, std::size_t j) {
      const auto [y, x] = courses(i, j, all_);
      return std::hypot(rms_of<Scalar>(VectorX<Scalar>(y - x)), channel(i).noise);
    };
    const auto both = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
      return std::hypot(misfit(i, j), misfit(k, l));
    };
    for (std::size_t i = 0; i < sides_.channels.size(); ++i)
      for (std::size_t j = i + 1; j < sides_.channels.size(); ++j) {
        if (channel(i).displacement != channel(j).displacement) continue;
        const double ratio = both(i, j, j, i) / both(i, i, j, j);
        if (ratio > limits_.exchanged) continue;
        if (misfit(i, j) > misfit(i, i) || misfit(j, i) > misfit(j, j)) continue;  // one faulty thermometer
        const double a = weigh(i, j, all_, {}).nats - free_nats(i), b = weigh(j, i, all_, {}).nats - free_nats(j);
        const double stretched = a > 0 && b > 0 ? a + b : 0;  // by how much less calibration must stretch
        const double nats = std::max(stretched, ratio < limits_.plain ? plain_nats(ratio) : 0.);
        if (nats > limits_.suspected_nats) pairs.push_back({i, j, nats});
      }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.nats > b.nats; });
    std::vector<std::size_t> used;
    for (const Pair& one : pairs) {
      const auto is_used = [&](std::size_t c) { return std::count(used.begin(), used.end(), c) > 0; };
      if (is_used(one.a) || is_used(one.b)) continue;
      used.insert(used.end(), {one.a, one.b});
      DataProblem told = problem(Kind::swapped, {channel(one.a).name, channel(one.b).name}, one.nats);
      told.side = Side::either;
      tell(std::move(told));
    }
  }

  /// A channel as given, its reading off by an offset and a gain of its own as far as faulty ones are.
  double free_nats(std::size_t c) {
    if (const auto known = free_nats_.find(c); known != free_nats_.end()) return known->second;
    return free_nats_[c] = found_free_nats(c);
  }

  double found_free_nats(std::size_t c) {
    MatrixX<Scalar> alike(courses(c, c, all_).second.size(), 2);
    if (channel(c).displacement) return weigh(c, all_, {}).nats;
    const std::vector<VectorX<Scalar>> faults = lookalikes(c, all_);
    alike << .2 * faults[0], .3 * faults[1];
    return std::max(weigh(c, all_, {}).nats, weigh(c, all_, {}, alike).nats);
  }

  /// Two columns of one side that are the same to the last digit while they differ on the other.
  void copied(bool simulated) {
    for (std::size_t i = 0; i < sides_.channels.size(); ++i)
      for (std::size_t j = i + 1; j < sides_.channels.size(); ++j) {
        if (channel(i).displacement != channel(j).displacement) continue;
        copied(i, j, simulated);
      }
  }

  void copied(std::size_t i, std::size_t j, bool simulated) {
    const auto side = [&](std::size_t c, bool of_simulator) -> const SeriesByBatch& {
      return of_simulator ? channel(c).simulated : channel(c).measured;
    };
    Batches same;
    for (const std::size_t b : all_) {
      const VectorX<Scalar>&one = side(i, simulated)[b], &other = side(j, simulated)[b];
      bool equal = true;
      double low = one(0), high = one(0);
      for (Index k = 0; k < one.size() && equal; ++k) {
        equal = one(k) == other(k) || (std::isnan(one(k)) && std::isnan(other(k)));
        low = std::min<double>(low, one(k)), high = std::max<double>(high, one(k));
      }
      if (equal && high - low > 8 * std::max(channel(i).noise, channel(j).noise)) same.push_back(b);
    }
    if (same.empty()) return;
    const VectorX<Scalar> apart =
        stacked<Scalar>(side(i, !simulated), same) - stacked<Scalar>(side(j, !simulated), same);
    const double differ = rms_of<Scalar>(VectorX<Scalar>(apart.array().isFinite().select(apart, 0)));
    if (differ < 4 * std::hypot(channel(i).noise, channel(j).noise)) return;
    // The one that the other side contradicts holds the copy.
    const double of_i = weigh(i, same, {}).nats, of_j = weigh(j, same, {}).nats;
    const std::size_t copy = of_i < of_j ? i : j, original = of_i < of_j ? j : i;
    double nats = 2 * limits_.certain_nats;  // noise is not read twice alike …
    if (simulated) {                         // … but two thermometers may sit on one simulated part
      if (2 * same.size() < all_.size()) return;
      VectorX<Scalar> rise = stacked<Scalar>(side(copy, false), same);
      rise = rise.array().isFinite().select(rise, 0);
      VectorX<Scalar> other = stacked<Scalar>(side(original, false), same);
      other = other.array().isFinite().select(other, 0);
      const VectorX<Scalar> start = rise;
      Index row = 0;
      for (const std::size_t b : same) {
        const Index rows = sides_.time_s[b].size();
        rise.segment(row, rows).array() -= start(row), other.segment(row, rows).array() -= start(row);
        row += rows;
      }
      const double share = differ / std::max({rms_of<Scalar>(rise), rms_of<Scalar>(other), 1e-9});
      const auto misfit = [&](std::size_t c) {
        const auto [y, x] = courses(c, c, same);
        return std::hypot(rms_of<Scalar>(VectorX<Scalar>(y - x)), channel(c).noise);
      };
      const double ratio = misfit(original) / misfit(copy);
      nats = std::max(std::abs(of_i - of_j), ratio < limits_.plain ? plain_nats(ratio) : 0.);
      if (share < limits_.copied || nats < limits_.suspected_nats) return;
    }
    DataProblem told = problem(Kind::copied, {channel(original).name, channel(copy).name}, nats);
    told.side = simulated ? Side::simulated : Side::measured;
    told.batches = names_of(same);
    tell(std::move(told));
  }

  /// A course `late_s` later, NaN where it was not yet known. `time_s` increases.
  static VectorX<Scalar> later(const VectorX<Scalar>& course, const VectorX<Scalar>& time_s, double late_s) {
    VectorX<Scalar> result(course.size());
    Index after = 1;
    for (Index k = 0; k < course.size(); ++k) {
      const double t = time_s(k) - late_s;
      if (t < time_s(0) || t > time_s(time_s.size() - 1)) {
        result(k) = std::nan("");
        continue;
      }
      while (after + 1 < time_s.size() && time_s(after) < t) ++after;
      while (after > 1 && time_s(after - 1) > t) --after;
      const double share = (t - time_s(after - 1)) / (time_s(after) - time_s(after - 1));
      result(k) = course(after - 1) + share * (course(after) - course(after - 1));
    }
    return result;
  }

  /// log ratio of the misfit of the rises of a batch when the simulated ones come later, mean over the channels that
  /// move; `better`: the share of them that it lowers.
  double later_gain(std::size_t b, double late_s, double& better) const {
    double sum = 0, count = 0;
    better = 0;
    const VectorX<Scalar>& time_s = sides_.time_s[b];
    for (const SideChannel& one : sides_.channels) {
      const VectorX<Scalar>&x = one.simulated[b], &y = one.measured[b];
      const VectorX<Scalar> moved = later(x, time_s, late_s);
      double now = 0, then = 0, n = 0, mean_now = 0, mean_then = 0, low = 1e300, high = -1e300;
      for (Index k = 0; k < x.size(); ++k) {
        if (!std::isfinite(moved(k) + y(k))) continue;
        const double a = y(k) - x(k), c = y(k) - moved(k);
        mean_now += a, mean_then += c, now += a * a, then += c * c, ++n;
        low = std::min<double>(low, x(k)), high = std::max<double>(high, x(k));
      }
      if (n < 8 || high - low < 20 * one.noise) continue;
      now = now / n - mean_now * mean_now / (n * n), then = then / n - mean_then * mean_then / (n * n);
      const double noise = one.noise * one.noise;
      const double gain = .5 * std::log((std::max(then, 0.) + noise) / (std::max(now, 0.) + noise));
      sum += gain, ++count;
      better += gain < 0;
    }
    better = count > 0 ? better / count : 0;
    return count > 0 ? sum / count : 0;
  }

  /// Everything of a batch comes later or earlier than simulated.
  void late() {
    std::vector<double> late_s(all_.size(), 0);
    Batches off;
    for (const std::size_t b : all_) {
      const VectorX<Scalar>& time_s = sides_.time_s[b];
      const double span = time_s(time_s.size() - 1) - time_s(0), step = span / static_cast<double>(time_s.size() - 1);
      double best = std::log(limits_.late), better = 0;
      for (int k = -60; k <= 60; ++k) {
        const double d = (std::abs(k) <= 30 ? k : (k > 0 ? 1 : -1) * 30 * std::pow(1.07, std::abs(k) - 30)) * step;
        if (k == 0 || std::abs(d) > span / 2) continue;
        const double gain = later_gain(b, d, better);
        if (gain < best && better > .75) best = gain, late_s[b] = d;
      }
      if (late_s[b] != 0) off.push_back(b);
    }
    if (off.empty()) return;
    const double nats = late_nats(off, late_s);
    if (nats < limits_.suspected_nats) return;
    std::vector<double> delays;
    for (const std::size_t b : off) delays.push_back(late_s[b]);
    std::sort(delays.begin(), delays.end());
    DataProblem told = problem(Kind::clock_offset, {}, nats);
    told.side = Side::either;
    told.figure = delays[delays.size() / 2];
    told.batches = names_of(off);
    tell(std::move(told));
  }

  /// By how much later simulated courses are more probable in these batches, all channels together.
  double late_nats(const Batches& batches, const std::vector<double>& late_s) {
    double sum = 0;
    const double looks = looks_per_batch * static_cast<double>(batches.size());
    for (std::size_t c = 0; c < sides_.channels.size(); ++c) {
      const std::pair<VectorX<Scalar>, VectorX<Scalar>> both = courses(c, c, batches);
      const VectorX<Scalar>&y = both.first, &x = both.second;
      MatrixX<Scalar> directions = directions_of(c, batches), moved = directions;
      VectorX<Scalar> later_x = x, there = VectorX<Scalar>::Ones(x.size());
      Index row = 0;
      for (const std::size_t b : batches) {
        const VectorX<Scalar>& time_s = sides_.time_s[b];
        const Index rows = time_s.size();
        const auto shift = [&](auto column) {
          const VectorX<Scalar> shifted = later(VectorX<Scalar>(column.segment(row, rows)), time_s, late_s[b]);
          for (Index k = 0; k < rows; ++k) {
            const bool known = std::isfinite(shifted(k));
            column(row + k) = known ? shifted(k) : 0;
            if (!known) there(row + k) = 0;
          }
        };
        shift(later_x.col(0));
        for (Index j = 0; j < moved.cols(); ++j) shift(moved.col(j));
        row += rows;
      }
      const auto weighed = [&](const VectorX<Scalar>& simulated, const MatrixX<Scalar>& along) {
        VectorX<Scalar> gap = there.cwiseProduct(VectorX<Scalar>(y - simulated));
        VectorX<Scalar> moves = y;
        centre(moves, batches);
        if (channel(c).displacement) centre(gap, batches);
        const double floor = std::max({channel(c).noise, .01 * rms_of<Scalar>(moves), 1e-9});
        return ChannelBelief<Scalar>(there.asDiagonal() * along, looks).weigh(gap, floor).nats;
      };
      sum += weighed(later_x, moved) - weighed(x, directions);
    }
    return sum;
  }

  const Sides& sides_;
  const SideLimits limits_;
  Batches all_;
  std::vector<DataProblem> found_;
  std::map<std::pair<std::size_t, Batches>, ChannelBelief<Scalar>> beliefs_;
  std::map<std::size_t, double> free_nats_;
  ChannelBelief<Scalar> beside_{MatrixX<Scalar>::Zero(1, 1), 1};
};

}  // namespace detail

/// What is wrong between the sides, certain and suspected. Nothing where they are written down alike, whatever the
/// simulator lacks. Allocates.
template <typename Scalar = double>
std::vector<DataProblem> compare_sides(const Sides& sides, const SideLimits& limits = {}) {
  return detail::SideComparison<Scalar>(sides, limits).run();
}

THERMFIT_COMPILED_TEMPLATE(std::vector<DataProblem> compare_sides<double>(const Sides&, const SideLimits&));

}  // namespace thermfit
