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
  bool intercept = true;                  ///< a free constant; needless where errors start at 0, as rises do
  std::optional<double> rise_penalty;     ///< of the rises, 0 or more
  std::optional<double> lag_penalty;      ///< of the lagged rises; infinite: none of them
  std::optional<double> climate_penalty;  ///< of the rises times the climate; infinite: none of them
  std::optional<PenaltyScale> scale;      ///< what coefficients are measured in
  double least_climate_range_K = 1;       ///< batches whose starts differ by less tell nothing of the climate
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
    has_climate_ = range.highest - range.lowest >= static_cast<Scalar>(options.least_climate_range_K);
    systems_.resize(batches.front()->products.size());
    leave_out_groups();
  }

  /// The penalties with the least sum over batches of the mean square left in each by a model of the others. Half
  /// decades are walked from the best of rises alone and of every lag in whole ones.
  TransferPenalties<Scalar> choose() {
    best_ = {none_ / 2, none_, none_, 0, 0};
    Place least = best_;
    for (std::size_t scale = 0; scale < (options_.scale ? 1 : 2); ++scale) {
      best_ = {none_ / 2, none_, none_, 0, scale};
      for (std::size_t rise = 0; rise < none_; rise += 2) consider({rise, none_, none_, 0, scale});
      const std::size_t alone = best_[0];
      Place with_lag = best_;
      for (std::size_t lag = 0; has_lag_ && lag < systems_.size(); ++lag) {
        best_ = {alone, alone, none_, lag, scale};
        walk({1, 0}, 2);
        if (error(best_) < error(with_lag)) with_lag = best_;
      }
      best_ = with_lag;
      walk({1, 0, 2}, 2);
      walk({1, 0, 2}, 1);
      if (scale == 0 || error(best_) < error(least)) least = best_;
    }
    return penalties(least);
  }

 private:
  using Place = std::array<std::size_t, 5>;  // in the grid for rises, lagged rises, climate; the lag; the scale

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
    return {at(0, true, options_.rise_penalty), at(1, has_lag_, options_.lag_penalty),
            at(2, has_climate_, options_.climate_penalty),
            options_.scale.value_or(place[4] == 0 ? PenaltyScale::block : PenaltyScale::column), place[3]};
  }

  Scalar error(const Place& place) {
    const auto known = known_.find(place);
    if (known != known_.end()) return known->second;
    const TransferPenalties<Scalar> chosen = penalties(place);
    Scalar sum = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const ClimateRange<Scalar>& climate = groups_[g].climate;
      const auto model = systems(place[3])[g].solve(error_, chosen, climate.mean, options_.intercept);
      for (const TransferBatch<Scalar>* batch : groups_[g].out) {
        const auto left = residuals(model, *batch, place[3], climate.factor(batch->climate_degC), error_);
        if (left.rows > 0) sum += left.sum_of_squares() / static_cast<Scalar>(left.rows);
      }
    }
    if (!std::isfinite(sum)) sum = std::numeric_limits<Scalar>::max();
    known_.emplace(place, sum);
    return sum;
  }

  bool consider(const Place& place) {
    constexpr Scalar rounding = Scalar(1e-9);
    if (!(error(place) < (1 - rounding) * error(best_))) return false;
    best_ = place;
    return true;
  }

  bool fixed(std::size_t block) const {
    if (block == 0) return options_.rise_penalty.has_value();
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
  bool has_lag_ = false, has_climate_ = false;
  Scalar centre_ = 0;
  std::vector<Group> groups_;
  std::vector<std::vector<TransferSystem<Scalar>>> systems_;  // per lag, per group
  std::map<Place, Scalar> known_;
  Place best_{};
};

}  // namespace detail
}  // namespace thermfit
