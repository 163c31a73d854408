#pragma once

/// Which channels of which batches do not agree with the others, as other batches say.

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "thermfit/compiled.hpp"
#include "thermfit/findings/leave_out_residuals.hpp"
#include "thermfit/findings/series_scale.hpp"

namespace thermfit {

/// When a channel disagrees.
struct AgreementLimits {
  double false_alarms = 1e-3;      ///< expected in a sound campaign, as far as its own scatter tells
  double tail = 0.25;              ///< share of the scatter that the tail beyond is judged by
  double ridge = 1e-5;             ///< share of a channel's variance
  double dead_factor = 5;          ///< what moves less by that than it should does not respond
  std::size_t fewest_batches = 4;  ///< below, nobody knows which batch is right
};

/// A channel of a batch that does not agree with the others.
template <typename Scalar = double>
struct Disagreement {
  std::size_t batch;        ///< index of the batch
  Index channel;            ///< index of the channel
  double rms;               ///< of its residual, in its unit
  double limit;             ///< what of it is usual for this channel in this batch
  std::vector<Index> kept;  ///< channels it was predicted by, with itself, ascending
  MatrixX<Scalar> weights;  ///< as in LeaveOutResiduals, for `kept`
};

namespace detail {

/// Beyond which one more value like `all` is not expected: their tail beyond a quantile as exponential, with the mean m
/// of n exceedances; the predictive tail (1 + x / (n m))^-n allows for how few they are. Infinite for fewer than two.
inline double scatter_limit(std::vector<double> all, const AgreementLimits& limits) {
  const double count = static_cast<double>(all.size());
  const auto beyond = static_cast<std::size_t>(limits.tail * count);
  if (beyond < 2) return HUGE_VAL;
  std::sort(all.begin(), all.end());
  const double start = all[all.size() - beyond - 1], n = static_cast<double>(beyond);
  double mean = 0;
  for (std::size_t i = all.size() - beyond; i < all.size(); ++i) mean += (all[i] - start) / n;
  return start + n * mean * (std::pow(limits.tail * count / limits.false_alarms, 1 / n) - 1);
}

template <typename Scalar>
class Agreement {
 public:
  Agreement(const std::vector<CentredProducts<Scalar>>& batches, VectorX<Scalar> floor, const AgreementLimits& limits)
      : batches_(batches), floor_(std::move(floor)), limits_(limits) {}

  /// Judges all of `judged` by the batches of `sound`, each left out of its own regression.
  void judge(const std::vector<std::size_t>& sound, const std::vector<std::size_t>& judged,
             const std::vector<Index>& kept) {
    excess_.clear();
    residuals_.clear();
    usual_.clear();
    const auto add = [&](std::size_t b) {
      if (residuals_.count(b) > 0) return;
      CentredProducts<Scalar> training{MatrixX<Scalar>::Zero(floor_.size(), floor_.size()), 0};
      for (const std::size_t other : sound)
        if (other != b) {
          training.products += batches_[other].products;
          training.rows += batches_[other].rows;
        }
      residuals_.emplace(b, leave_out_residuals<Scalar>(batches_[b], training, kept, floor_, Scalar(limits_.ridge)));
    };
    for (const std::size_t b : sound) add(b);
    for (const std::size_t b : judged) add(b);
    const auto count = static_cast<Index>(kept.size());
    VectorX<Scalar> middle(count);
    MatrixX<Scalar> middle_without(count, count);
    const auto over_sound = [&](auto&& value) {
      std::vector<double> values;
      for (const std::size_t b : sound) values.push_back(static_cast<double>(value(residuals_.at(b))));
      return Scalar(median(std::move(values)));
    };
    for (Index c = 0; c < count; ++c) {
      middle(c) = over_sound([&](const auto& one) { return one.log_sd(c); });
      for (Index k = 0; k < count; ++k)
        middle_without(c, k) = over_sound([&](const auto& one) { return one.log_sd_without(c, k); });
    }
    for (const auto& [b, one] : residuals_) {
      VectorX<Scalar> excess(count), usual(count);
      for (Index c = 0; c < count; ++c) {
        std::vector<double>
            others;  // how far the batch as a whole is off what is usual, by those that c cannot disturb
        for (Index k = 0; k < count; ++k)
          if (k != c) others.push_back(static_cast<double>(one.log_sd_without(c, k) - middle_without(c, k)));
        const double whole = others.size() < 2 ? 0 : median(std::move(others));
        usual(c) = middle(c) + Scalar(whole);
        excess(c) = one.log_sd(c) - usual(c);
      }
      excess_.emplace(b, excess);
      usual_.emplace(b, usual);
    }
    limit_ = limit_of(sound);
  }

  double limit() const { return limit_; }
  double worst(std::size_t b) const { return static_cast<double>(excess_.at(b).maxCoeff()); }
  Index worst_channel(std::size_t b) const {
    Index channel = 0;
    excess_.at(b).maxCoeff(&channel);
    return channel;
  }
  double worst_rms(std::size_t b) const { return std::exp(residuals_.at(b).log_sd(worst_channel(b))); }
  double worst_allowed(std::size_t b) const { return std::exp(double(usual_.at(b)(worst_channel(b))) + limit_); }
  const LeaveOutResiduals<Scalar>& residuals(std::size_t b) const { return residuals_.at(b); }

 private:
  double limit_of(const std::vector<std::size_t>& sound) const {
    std::vector<double> all;
    for (const std::size_t b : sound)
      for (Index c = 0; c < excess_.at(b).size(); ++c) all.push_back(static_cast<double>(excess_.at(b)(c)));
    return scatter_limit(std::move(all), limits_);
  }

  const std::vector<CentredProducts<Scalar>>& batches_;
  VectorX<Scalar> floor_;
  AgreementLimits limits_;
  std::map<std::size_t, LeaveOutResiduals<Scalar>> residuals_;
  std::map<std::size_t, VectorX<Scalar>> excess_, usual_;
  double limit_ = HUGE_VAL;
};

}  // namespace detail

/// How much less each channel of each batch moved than it should, batches x channels: minus the logarithm of its rms
/// beside what is usual for the channel and for the batch (medians over batches, then channels). `floor` as below.
/// Allocates.
template <typename Scalar = double>
MatrixX<Scalar> missing_movement(const std::vector<CentredProducts<Scalar>>& batches, const VectorX<Scalar>& floor) {
  const auto count = static_cast<Index>(batches.size());
  MatrixX<Scalar> result(count, floor.size());
  for (Index b = 0; b < count; ++b)
    for (Index c = 0; c < floor.size(); ++c) {
      const CentredProducts<Scalar>& one = batches[static_cast<std::size_t>(b)];
      const Scalar square = one.rows > 0 ? one.products(c, c) / one.rows : Scalar(0);
      result(b, c) = -std::log(square + floor(c) * floor(c)) / 2;
    }
  const auto middle = [](const auto& values) {
    std::vector<double> all;
    for (Index i = 0; i < values.size(); ++i) all.push_back(static_cast<double>(values(i)));
    return Scalar(median(std::move(all)));
  };
  for (Index c = 0; c < floor.size(); ++c) result.col(c).array() -= middle(result.col(c));
  for (Index b = 0; b < count; ++b) result.row(b).array() -= middle(result.row(b));
  return result;
}

/// Channels that do not agree with the others, worst first within a batch.
///
/// Each channel of each batch is predicted by the others, with a regression from sound batches other than it; what
/// counts is the logarithm of the rms residual beyond what is usual for the channel (over batches) and the batch (over
/// channels that the one judged cannot disturb). Its limit follows from the scatter among sound batches and a rate of
/// false alarms. Sound batches are found from the half that fits best, those that agree joining in turn, so that a
/// faulty batch is not its own measure. In a faulty batch the worst channel is left out, and the rest judged anew.
/// `left_out` lists channels of a batch that are known to be faulty; `floor` the rms noise of a reading of each
/// channel. Nothing for fewer than `fewest_batches` batches or three channels. Allocates.
template <typename Scalar = double>
std::vector<Disagreement<Scalar>> disagreements(const std::vector<CentredProducts<Scalar>>& batches,
                                                const std::vector<std::vector<Index>>& left_out,
                                                const VectorX<Scalar>& floor, const AgreementLimits& limits = {}) {
  std::vector<Disagreement<Scalar>> found;
  const Index channels = floor.size();
  if (channels < 3) return found;
  std::vector<std::size_t> all, whole;
  std::vector<Index> every;
  for (Index c = 0; c < channels; ++c) every.push_back(c);
  for (std::size_t b = 0; b < batches.size(); ++b)
    if (batches[b].rows > static_cast<Scalar>(channels)) {
      all.push_back(b);
      if (left_out[b].empty()) whole.push_back(b);
    }
  if (whole.size() < limits.fewest_batches) return found;
  detail::Agreement<Scalar> agreement(batches, floor, limits);
  agreement.judge(whole, whole, every);
  std::vector<std::pair<double, std::size_t>> order;
  for (const std::size_t b : whole) {
    double most = -HUGE_VAL;
    for (Index c = 0; c < channels; ++c) {
      std::vector<double> others;
      for (const std::size_t o : whole) others.push_back(static_cast<double>(agreement.residuals(o).log_sd(c)));
      most = std::max(most, static_cast<double>(agreement.residuals(b).log_sd(c)) - median(std::move(others)));
    }
    order.emplace_back(most, b);
  }
  std::stable_sort(order.begin(), order.end());
  std::vector<std::size_t> sound;
  for (std::size_t i = 0; i < std::max<std::size_t>(3, (whole.size() + 1) / 2); ++i) sound.push_back(order[i].second);
  std::sort(sound.begin(), sound.end());
  while (true) {
    agreement.judge(sound, whole, every);
    order.clear();
    for (const std::size_t b : whole)
      if (!std::binary_search(sound.begin(), sound.end(), b) && agreement.worst(b) <= agreement.limit())
        order.emplace_back(agreement.worst(b), b);
    if (order.empty()) break;
    std::stable_sort(order.begin(), order.end());
    for (std::size_t i = 0; i < (order.size() + 1) / 2; ++i) sound.push_back(order[i].second);
    std::sort(sound.begin(), sound.end());
  }
  std::vector<std::size_t> suspects;
  for (const std::size_t b : all)
    if (!left_out[b].empty() || agreement.worst(b) > agreement.limit()) suspects.push_back(b);
  for (const std::size_t b : suspects) {
    std::vector<std::size_t> judges;
    for (const std::size_t o : sound)
      if (o != b) judges.push_back(o);
    std::vector<Index> kept;
    for (const Index c : every)
      if (std::find(left_out[b].begin(), left_out[b].end(), c) == left_out[b].end()) kept.push_back(c);
    const std::size_t first = found.size();
    while (kept.size() >= 3 && judges.size() >= 3) {
      agreement.judge(judges, {b}, kept);
      if (agreement.worst(b) <= agreement.limit()) break;
      const Index worst = agreement.worst_channel(b);
      found.push_back(
          {b, kept[static_cast<std::size_t>(worst)], agreement.worst_rms(b), agreement.worst_allowed(b), {}, {}});
      kept.erase(kept.begin() + worst);
    }
    for (std::size_t f = first; f < found.size(); ++f) {  // each beside sound channels only
      Disagreement<Scalar>& one = found[f];
      one.kept = kept;
      one.kept.insert(std::upper_bound(one.kept.begin(), one.kept.end(), one.channel), one.channel);
      agreement.judge(judges, {b}, one.kept);
      const auto own = std::find(one.kept.begin(), one.kept.end(), one.channel) - one.kept.begin();
      one.weights = agreement.residuals(b).weights.col(own);
    }
  }
  return found;
}
THERMFIT_COMPILED_TEMPLATE(std::vector<Disagreement<double>> disagreements<double>(
    const std::vector<CentredProducts<double>>&, const std::vector<std::vector<Index>>&, const VectorX<double>&,
    const AgreementLimits&));

}  // namespace thermfit
