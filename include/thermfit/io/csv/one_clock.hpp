#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thermfit/io/csv/field.hpp"
#include "thermfit/io/csv/options.hpp"

namespace thermfit::detail {

/// Channels with clocks of their own, put on one: rows stand at the times of the slowest clock, and of several as slow
/// at those of the one that begins last, so that no first row is lost. The other channels are linear between their
/// samples, but missing where these are further apart than `gap_steps` usual steps, or hold the last one.
class OneClock {
 public:
  static constexpr double gap_steps = 3;

  struct Row {
    const std::string* batch;
    double time_s;
    std::vector<double> values;  ///< of the channels; NaN where one has none
    std::size_t line;            ///< of the sample whose time it has
  };
  enum class Fault { none, value_without_time, time_not_increasing };

  /// The number of the clock of each channel; the channels that hold in any case, as states do.
  OneClock(std::vector<std::size_t> clock_of, std::vector<bool> held, std::size_t clocks)
      : clock_of_(std::move(clock_of)), held_(std::move(held)), clocks_(clocks) {}

  /// Takes the samples of a line: values of the channels, then of the clocks; NaN in a clock without a sample there.
  /// `clock` is the one at fault.
  Fault take(std::string_view batch, const std::vector<double>& values, std::size_t line, std::size_t& clock) {
    Samples& samples = samples_of(batch);
    for (clock = 0; clock < clocks_; ++clock) {
      const double time = values[clock_of_.size() + clock];
      const bool has_time = time == time;
      for (std::size_t c = 0; c < clock_of_.size() && !has_time; ++c)
        if (clock_of_[c] == clock && values[c] == values[c]) return Fault::value_without_time;
      if (!has_time) continue;
      Series& series = samples.clocks[clock];
      if (!series.time.empty() && time <= series.time.back()) return Fault::time_not_increasing;
      series.time.push_back(time);
      series.line.push_back(line);
      for (std::size_t c = 0; c < clock_of_.size(); ++c)
        if (clock_of_[c] == clock) samples.values[c].push_back(values[c]);
    }
    return Fault::none;
  }

  /// The rows of all batches in their order.
  std::vector<Row> rows() {
    std::vector<Row> made;
    for (const Samples& samples : batches_) {
      const std::vector<Series>& clocks = samples.clocks;
      if (std::any_of(clocks.begin(), clocks.end(), [](const Series& one) { return one.time.empty(); })) continue;
      const bool same =
          std::all_of(clocks.begin(), clocks.end(), [&](const Series& one) { return one.time == clocks[0].time; });
      agree_ = agree_ && same;
      std::vector<double> steps;
      for (const Series& one : clocks) steps.push_back(usual_step(one));
      const std::size_t base = same ? 0 : slowest(clocks, steps);
      if (&samples == &batches_.front()) base_ = base;
      double begin = clocks[base].time.front();
      for (const Series& one : clocks) begin = std::max(begin, one.time.front());
      for (std::size_t i = 0; i < clocks[base].time.size(); ++i) {
        Row row{&samples.batch, clocks[base].time[i], std::vector<double>(clock_of_.size()), clocks[base].line[i]};
        bool covered = row.time_s >= begin;
        for (std::size_t c = 0; c < clock_of_.size() && covered; ++c) {
          const Series& own = clocks[clock_of_[c]];
          covered = held_[c] || row.time_s <= own.time.back();
          const double gap = gap_steps * std::max(steps[clock_of_[c]], steps[base]);
          if (covered) row.values[c] = value_at(own, samples.values[c], held_[c], row.time_s, gap);
        }
        if (covered) made.push_back(std::move(row));
        uncovered_ += !covered;
      }
    }
    return made;
  }

  bool agree() const { return agree_; }                 ///< whether all clocks say the same in every row
  std::size_t base() const { return base_; }            ///< the clock that rows go by, in the first batch
  std::size_t uncovered() const { return uncovered_; }  ///< rows left out, as other channels begin later or end before

 private:
  struct Series {
    std::vector<double> time;
    std::vector<std::size_t> line;
  };
  struct Samples {
    std::string batch;
    std::vector<Series> clocks;
    std::vector<std::vector<double>> values;
  };

  Samples& samples_of(std::string_view batch) {
    for (std::size_t b = batches_.size(); b-- > 0;)
      if (batches_[b].batch == batch) return batches_[b];
    batches_.push_back(
        {std::string(batch), std::vector<Series>(clocks_), std::vector<std::vector<double>>(clock_of_.size())});
    return batches_.back();
  }

  static double usual_step(const Series& series) {
    if (series.time.size() < 2) return 0;
    std::vector<double> steps;
    for (std::size_t i = 1; i < series.time.size(); ++i) steps.push_back(series.time[i] - series.time[i - 1]);
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
  }

  static std::size_t slowest(const std::vector<Series>& clocks, const std::vector<double>& steps) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < clocks.size(); ++k) {
      const bool as_slow = steps[k] > 0.99 * steps[best] && steps[k] < 1.01 * steps[best];
      if (as_slow ? clocks[k].time.front() > clocks[best].time.front() : steps[k] > steps[best]) best = k;
    }
    return best;
  }

  static double value_at(const Series& clock, const std::vector<double>& values, bool held, double time, double gap) {
    const auto after = std::upper_bound(clock.time.begin(), clock.time.end(), time);
    const auto i = static_cast<std::size_t>(after - clock.time.begin()) - 1;
    if (held || clock.time[i] == time) return values[i];
    const double step = clock.time[i + 1] - clock.time[i];
    if (step > gap) return missing_value;
    return values[i] + (values[i + 1] - values[i]) * ((time - clock.time[i]) / step);
  }

  std::vector<std::size_t> clock_of_;
  std::vector<bool> held_;
  std::size_t clocks_;
  std::vector<Samples> batches_;
  bool agree_ = true;
  std::size_t base_ = 0, uncovered_ = 0;
};

}  // namespace thermfit::detail
