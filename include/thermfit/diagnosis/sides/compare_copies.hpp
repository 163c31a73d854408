#pragma once

/// Two columns of one side that are one.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/sides/side_weighing.hpp"

namespace thermfit::detail {

/// Looks for columns that hold another one.
template <typename Scalar = double>
class CopiedColumns {
 public:
  explicit CopiedColumns(SideWeighing<Scalar>& of) : of_(of) {}

  /// Two columns of one side that are the same to the last digit while they differ on the other.
  std::vector<DataProblem> run(bool simulated) {
    for (std::size_t i = 0; i < of_.sides().channels.size(); ++i)
      for (std::size_t j = i + 1; j < of_.sides().channels.size(); ++j) {
        if (of_.channel(i).displacement != of_.channel(j).displacement) continue;
        copied(i, j, simulated);
      }
    return std::move(told_);
  }

 private:
  using Kind = DataProblem::Kind;
  using Side = DataProblem::Side;

  void copied(std::size_t i, std::size_t j, bool simulated) {
    const auto side = [&](std::size_t c, bool of_simulator) -> const SeriesByBatch& {
      return of_simulator ? of_.channel(c).simulated : of_.channel(c).measured;
    };
    BatchNumbers same;
    for (const std::size_t b : of_.all()) {
      const VectorX<Scalar>&one = side(i, simulated)[b], &other = side(j, simulated)[b];
      bool equal = true;
      double low = one(0), high = one(0);
      for (Index k = 0; k < one.size() && equal; ++k) {
        equal = one(k) == other(k) || (std::isnan(one(k)) && std::isnan(other(k)));
        low = std::min<double>(low, one(k)), high = std::max<double>(high, one(k));
      }
      if (equal && high - low > 8 * std::max(of_.channel(i).noise, of_.channel(j).noise)) same.push_back(b);
    }
    if (same.empty()) return;
    const VectorX<Scalar> apart =
        stacked<Scalar>(side(i, !simulated), same) - stacked<Scalar>(side(j, !simulated), same);
    const double differ = rms_of<Scalar>(VectorX<Scalar>(apart.array().isFinite().select(apart, 0)));
    if (differ < 4 * std::hypot(of_.channel(i).noise, of_.channel(j).noise)) return;
    // The one that the other side contradicts holds the copy.
    const double of_i = of_.weigh(i, same, {}).nats, of_j = of_.weigh(j, same, {}).nats;
    const std::size_t copy = of_i < of_j ? i : j, original = of_i < of_j ? j : i;
    double nats = 2 * of_.limits().certain_nats;  // noise is not read twice alike …
    if (simulated) {                              // … but two thermometers may sit on one simulated part
      if (2 * same.size() < of_.all().size()) return;
      VectorX<Scalar> rise = stacked<Scalar>(side(copy, false), same);
      rise = rise.array().isFinite().select(rise, 0);
      VectorX<Scalar> other = stacked<Scalar>(side(original, false), same);
      other = other.array().isFinite().select(other, 0);
      const VectorX<Scalar> start = rise;
      Index row = 0;
      for (const std::size_t b : same) {
        const Index rows = of_.sides().time_s[b].size();
        rise.segment(row, rows).array() -= start(row), other.segment(row, rows).array() -= start(row);
        row += rows;
      }
      const double share = differ / std::max({rms_of<Scalar>(rise), rms_of<Scalar>(other), 1e-9});
      const auto misfit = [&](std::size_t c) {
        const auto [y, x] = of_.courses(c, c, same);
        return std::hypot(rms_of<Scalar>(VectorX<Scalar>(y - x)), of_.channel(c).noise);
      };
      const double ratio = misfit(original) / misfit(copy);
      nats = std::max(std::abs(of_i - of_j), ratio < of_.limits().plain ? of_.plain_nats(ratio) : 0.);
      if (share < of_.limits().copied || nats < of_.limits().suspected_nats) return;
    }
    DataProblem told = of_.problem(Kind::copied, {of_.channel(original).name, of_.channel(copy).name}, nats);
    told.side = simulated ? Side::simulated : Side::measured;
    if (simulated) told.certain = false;  // one of two thermometers on one part may have a fault of its own
    told.batches = of_.names_of(same);
    told_.push_back(std::move(told));
  }

  SideWeighing<Scalar>& of_;
  std::vector<DataProblem> told_;
};

}  // namespace thermfit::detail
