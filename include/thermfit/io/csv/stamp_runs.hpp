#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "thermfit/io/csv/stamp.hpp"

namespace thermfit::detail {

/// Rows that a clock gives the same stamp, as one does that tells minutes only: how many a stamp, where all are alike.
class StampRuns {
 public:
  void look_at(const Stamp& stamp) {
    whole_ = whole_ && stamp.fraction == 0;
    if (!lengths_.empty() && stamp.seconds == last_s_) {
      ++lengths_.back();
      return;
    }
    if (!lengths_.empty()) steps_.push_back(((stamp.seconds - last_s_) % 86400 + 86400) % 86400);
    lengths_.push_back(1);
    last_s_ = stamp.seconds;
  }

  /// Two or more where the stamps are evenly apart and every one that is neither the first nor the last has as many
  /// rows; two such are needed. Else 0.
  std::size_t rows_a_stamp() const {
    if (!whole_ || lengths_.size() < 4 || lengths_[1] < 2) return 0;
    const std::size_t rows = lengths_[1];
    const bool even = std::all_of(lengths_.begin() + 1, lengths_.end() - 1, [&](std::size_t n) { return n == rows; }) &&
                      lengths_.front() <= rows && lengths_.back() <= rows &&
                      std::all_of(steps_.begin(), steps_.end(), [&](std::int64_t step) { return step == steps_[0]; });
    return even ? rows : 0;
  }
  std::int64_t stamps_apart_s() const { return steps_.front(); }  ///< where rows_a_stamp() is not 0
  std::size_t rows_before() const {
    return lengths_[1] - lengths_.front();
  }  ///< of the first stamp, which are not there

 private:
  std::vector<std::size_t> lengths_;
  std::vector<std::int64_t> steps_;
  std::int64_t last_s_ = 0;
  bool whole_ = true;
};

}  // namespace thermfit::detail
