#pragma once

/// Probes that count from another zero than the other side does.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "thermfit/batch/error_reference.hpp"
#include "thermfit/diagnosis/sides/side_weighing.hpp"
#include "thermfit/number.hpp"

namespace thermfit::detail {

/// Looks for batches in which a displacement is off by a constant.
template <typename Scalar = double>
class Datums {
 public:
  explicit Datums(SideWeighing<Scalar>& of) : of_(of) {}

  /// Batches in which displacement `c` counts from another zero, with how far it is off in the note; nothing where the
  /// zero is part of what is measured.
  std::vector<DataProblem> run(std::size_t c) {
    const SideChannel& channel = of_.channel(c);
    if (!channel.displacement || channel.absolute) return {};
    const auto at_zero = [](const Vector& course) { return course.size() > 0 && course(0) == 0; };
    const auto zeros = std::count_if(channel.simulated.begin(), channel.simulated.end(), at_zero);
    const bool from_start = 2 * static_cast<std::size_t>(zeros) > channel.simulated.size();  // by its convention
    bool simulated_off = from_start;
    std::vector<std::pair<std::size_t, double>> off;
    double nats = 1e300, swing = 0, count = 0;
    for (const std::size_t b : of_.all()) {
      const auto [y, x] = of_.courses(c, c, {b});
      swing += (y.array() - y.mean()).square().sum() + (x.array() - x.mean()).square().sum();
      count += static_cast<double>(y.size());
    }
    const double least =
        std::max(of_.limits().datum_noises * channel.noise, of_.limits().datum_share * std::sqrt(swing / count));
    for (const std::size_t b : of_.all()) {
      const VectorX<Scalar>&measured = channel.measured[b], &simulated = channel.simulated[b];
      const VectorX<Scalar> gap = measured - simulated;
      const double start = error_start(gap).value_um;
      if (!(std::abs(start) > least)) continue;
      const double gained = from_start ? of_.limits().certain_nats : nats_of(c, b, start);
      if (gained < of_.limits().certain_nats) continue;
      nats = std::min(nats, gained);
      simulated_off = simulated_off && !at_zero(simulated);
      off.emplace_back(b, start);
    }
    if (off.empty()) return {};
    DataProblem told = of_.problem(DataProblem::Kind::datum, {channel.name}, nats);
    told.side = simulated_off ? DataProblem::Side::simulated : DataProblem::Side::measured;
    for (const auto& [b, start] : off) {
      told.batches.push_back(of_.sides().batches[b]);
      told.note += (told.note.empty() ? "" : ", ") + of_.sides().batches[b] + " by " + fixed_text(start, 1) + " um";
      if (std::abs(start) > std::abs(told.figure)) told.figure = start;
    }
    return {std::move(told)};
  }

 private:
  /// By how much a free constant makes a batch more probable than calibration and an expansion that is missing.
  double nats_of(std::size_t c, std::size_t b, double start) {
    auto [y, x] = of_.courses(c, c, {b});
    const VectorX<Scalar> gap = y - x;
    const MatrixX<Scalar> directions = of_.uncentred_directions_of(c, {b});
    const double floor = std::max({of_.channel(c).noise, .01 * rms_of<Scalar>(VectorX<Scalar>(y)), 1e-9});
    const auto with = [&](const VectorX<Scalar>& beside) {
      MatrixX<Scalar> along(directions.rows(), directions.cols() + 1);
      along << directions, beside;
      return ChannelBelief<Scalar>(std::move(along), looks_per_batch).weigh(gap, floor).nats;
    };
    double given = with(VectorX<Scalar>::Zero(gap.size()));
    const double largest = std::sqrt(directions.colwise().squaredNorm().maxCoeff() / static_cast<double>(gap.size()));
    for (std::size_t j = 0; j < of_.sides().channels.size(); ++j) {
      if (of_.channel(j).displacement) continue;
      const VectorX<Scalar> warm = of_.courses(j, j, {b}).second.array() - of_.limits().room_degC;
      const double size = rms_of<Scalar>(warm);
      if (size > 0) given = std::max(given, with(largest / of_.limits().relative_sd / size * warm));
    }
    return with(VectorX<Scalar>::Constant(gap.size(), std::abs(start))) - given;
  }

  SideWeighing<Scalar>& of_;
};

}  // namespace thermfit::detail
