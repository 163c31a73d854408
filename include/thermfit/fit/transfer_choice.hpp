#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "thermfit/fit/transfer_system.hpp"

namespace thermfit {

/// Settings of the method `transfer`. What is not given is chosen by leaving batches out.
struct TransferOptions {
  bool intercept = true;                     ///< a free constant; needless where errors start at 0, as rises do
  std::optional<double> rise_penalty;        ///< of the rises, 0 or more
  std::optional<double> lag_penalty;         ///< of the lagged rises; infinite: none of them
  std::optional<double> climate_penalty;     ///< of the rises times the climate; infinite: none of them
  std::optional<double> input_penalty;       ///< of changes of known inputs, and of their lags
  std::optional<double> difference_penalty;  ///< of differences of points
  std::optional<PenaltyScale> scale;         ///< what coefficients are measured in
  double least_climate_range_K = 1;          ///< batches whose starts differ by less tell nothing of the climate
  std::size_t most_groups =
      12;  ///< batches are left out one by one, or, if there are more, in so many groups, 2 at least
};

/// Penalties that are tried: 1e-4 to 10 in half decades, then infinity, at which a block is gone. A sensor reads to
/// about a hundredth of its rise: below 1e-4, the square of that, its last digit would be fitted.
inline std::vector<double> transfer_penalty_grid() {
  std::vector<double> grid;
  for (int half_decade = -8; half_decade <= 2; ++half_decade) grid.push_back(std::pow(10.0, half_decade / 2.0));
  grid.push_back(std::numeric_limits<double>::infinity());
  return grid;
}

namespace detail {

/// Walks penalties and lags to the least error on batches left out of `batches`, and sees no other batch.
template <typename Scalar>
class TransferChoice {
 public:
  using Batches = std::vector<const TransferBatch<Scalar>*>;

  TransferChoice(const Batches& batches, Index error, const TransferOptions& options)
      : batches_(batches), error_(error), options_(options), grid_(transfer_penalty_grid()), none_(grid_.size() - 1) {
    const ClimateRange<Scalar> range = climate_range(batches);
    centre_ = range.mean;
    has_lag_ = batches.front()->has_lag;
    has_inputs_ = batches.front()->inputs > 0;
    has_differences_ = batches.front()->differences > 0;
    has_climate_ = range.highest - range.lowest >= static_cast<Scalar>(options.least_climate_range_K);
    systems_.resize(batches.front()->products.size());
    leave_out_groups();
  }

  /// The penalties with the least geometric mean over batches of the mean square left in each by a model of the others:
  /// the profile likelihood where every batch has a noise of its own, unknown, so that a batch which nothing predicts
  /// does not decide alone. Half decades are walked from the best of rises alone and of every lag in whole ones.
  TransferPenalties<Scalar> choose() {
    best_ = alone(none_ / 2, 0);
    Place least = best_;
    for (std::size_t scale = 0; scale < (options_.scale ? 1 : 2); ++scale) {
      best_ = alone(none_ / 2, scale);
      for (std::size_t rise = 0; rise < none_; rise += 2) consider(alone(rise, scale));
      const std::size_t rise = best_[0];
      Place with_lag = best_;
      for (std::size_t lag = 0; has_lag_ && lag < systems_.size(); ++lag) {
        best_ = alone(rise, scale);
        best_[1] = rise;
        best_[lag_at] = lag;
        walk({1, 0, 4}, 2);
        if (error(best_) < error(with_lag)) with_lag = best_;
      }
      best_ = with_lag;
      walk({1, 0, 2, 3, 4, 5}, 2);
      walk({1, 0, 2, 3, 4, 5}, 1);
      if (scale == 0 || error(best_) < error(least)) least = best_;
    }
    return penalties(least);
  }

 private:
  // In the grid for rises, lagged rises, climate, inputs, lagged inputs, differences; the lag; the scale.
  using Place = std::array<std::size_t, 8>;
  static constexpr std::size_t lag_at = 6, scale_at = 7;

  /// Rises alone.
  Place alone(std::size_t rise, std::size_t scale) const { return {rise, none_, none_, none_, none_, none_, 0, scale}; }

  struct Group {
    Batches out;
    ClimateRange<Scalar> climate;  // of the others
  };

  /// Groups that span all climates, in an order that does not depend on that of the batches.
  void leave_out_groups() {
    std::sort(batches_.begin(), batches_.end(), [](const TransferBatch<Scalar>* a, const TransferBatch<Scalar>* b) {
      if (a->climate_degC != b->climate_degC) return a->climate_degC < b->climate_degC;
      const MatrixX<Scalar>&x = a->products.front(), &y = b->products.front();
      return std::lexicographical_compare(x.data(), x.data() + x.size(), y.data(), y.data() + y.size());
    });
    const std::size_t groups = std::min(std::max<std::size_t>(2, options_.most_groups), batches_.size());
    for (std::size_t g = 0; g < groups; ++g) {
      Group group;
      Batches others;
      for (std::size_t b = 0; b < batches_.size(); ++b) (b % groups == g ? group.out : others).push_back(batches_[b]);
      group.climate = climate_range(others);
      groups_.push_back(std::move(group));
    }
  }

  const std::vector<TransferSystem<Scalar>>& systems(std::size_t lag) {
    std::vector<TransferSystem<Scalar>>& systems = systems_[lag];
    if (!systems.empty()) return systems;
    const TransferSystem<Scalar> all(batches_, lag, centre_);
    for (const Group& group : groups_) systems.push_back(all.without(group.out, lag));
    return systems;
  }

  TransferPenalties<Scalar> penalties(const Place& place) const {
    const auto at = [&](std::size_t block, bool there, const std::optional<double>& given) {
      return static_cast<Scalar>(there ? given.value_or(grid_[place[block]]) : grid_[none_]);
    };
    return {at(0, true, options_.rise_penalty),
            at(1, has_lag_, options_.lag_penalty),
            at(2, has_climate_, options_.climate_penalty),
            options_.scale.value_or(place[scale_at] == 0 ? PenaltyScale::block : PenaltyScale::column),
            place[lag_at],
            at(3, has_inputs_, options_.input_penalty),
            at(4, has_inputs_ && has_lag_, options_.input_penalty),
            at(5, has_differences_, options_.difference_penalty)};
  }

  Scalar error(const Place& place) {
    const auto known = known_.find(place);
    if (known != known_.end()) return known->second;
    const TransferPenalties<Scalar> chosen = penalties(place);
    constexpr Scalar resolved = Scalar(1e-6);  // of an error's mean square: a thousandth of it left is as good as none
    Scalar sum = 0, count = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const ClimateRange<Scalar>& climate = groups_[g].climate;
      const auto model = systems(place[lag_at])[g].solve(error_, chosen, climate.mean, options_.intercept);
      for (const TransferBatch<Scalar>* batch : groups_[g].out) {
        const auto left = residuals(model, *batch, place[lag_at], climate.factor(batch->climate_degC), error_);
        if (left.rows == 0) continue;
        const Index response = batch->columns() + error_;
        const Scalar whole = batch->products[place[lag_at]](response, response);
        sum += std::log(left.sum_of_squares() / static_cast<Scalar>(left.rows) + resolved * whole +
                        std::numeric_limits<Scalar>::min());
        ++count;
      }
    }
    Scalar mean = std::exp(sum / std::max(Scalar(1), count));
    if (!std::isfinite(mean)) mean = std::numeric_limits<Scalar>::max();
    known_.emplace(place, mean);
    return mean;
  }

  bool consider(const Place& place) {
    constexpr Scalar rounding = Scalar(1e-9);
    if (!(error(place) < (1 - rounding) * error(best_))) return false;
    best_ = place;
    return true;
  }

  bool fixed(std::size_t block) const {
    if (block == 0) return options_.rise_penalty.has_value();
    if (block == 3) return !has_inputs_ || options_.input_penalty;
    if (block == 4) return !has_inputs_ || !has_lag_ || options_.input_penalty;
    if (block == 5) return !has_differences_ || options_.difference_penalty;
    return block == 1 ? !has_lag_ || options_.lag_penalty : !has_climate_ || options_.climate_penalty;
  }

  /// One block after the other by `size` steps of the grid while it pays, and to none and back.
  void walk(const std::vector<std::size_t>& blocks, std::size_t size) {
    for (bool moved = true; moved;) {
      moved = false;
      for (const std::size_t block : blocks) {
        if (fixed(block)) continue;
        Place other = best_;
        other[block] = best_[block] == none_ ? none_ / 2 : none_;
        if (consider(other)) moved = true;
        for (const bool up : {false, true})
          while (best_[block] < none_) {
            Place next = best_;
            if (up ? next[block] + size >= none_ : next[block] < size) break;
            next[block] = up ? next[block] + size : next[block] - size;
            if (!consider(next)) break;
            moved = true;
          }
      }
    }
  }

  Batches batches_;
  Index error_;
  TransferOptions options_;
  std::vector<double> grid_;
  std::size_t none_;
  bool has_lag_ = false, has_climate_ = false, has_inputs_ = false, has_differences_ = false;
  Scalar centre_ = 0;
  std::vector<Group> groups_;
  std::vector<std::vector<TransferSystem<Scalar>>> systems_;  // per lag, per group
  std::map<Place, Scalar> known_;
  Place best_{};
};

}  // namespace detail
}  // namespace thermfit
