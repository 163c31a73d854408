#pragma once

/// Columns that were exchanged, two by two.

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/sides/lookalikes.hpp"

namespace thermfit::detail {

/// Looks for pairs of channels that agree better the other way round.
template <typename Scalar = double>
class ExchangedColumns {
 public:
  explicit ExchangedColumns(SideWeighing<Scalar>& of) : of_(of) {}

  /// Thermometers whose columns were exchanged, two by two.
  std::vector<DataProblem> run() {
    struct Pair {
      std::size_t a, b;
      double nats;
    };
    std::vector<Pair> pairs;
    const auto misfit = [&](std::size_t i, std::size_t j) {
      const auto [y, x] = of_.courses(i, j, of_.all());
      return std::hypot(rms_of<Scalar>(VectorX<Scalar>(y - x)), of_.channel(i).noise);
    };
    const auto both = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
      return std::hypot(misfit(i, j), misfit(k, l));
    };
    for (std::size_t i = 0; i < of_.sides().channels.size(); ++i)
      for (std::size_t j = i + 1; j < of_.sides().channels.size(); ++j) {
        if (of_.channel(i).displacement != of_.channel(j).displacement) continue;
        const double ratio = both(i, j, j, i) / both(i, i, j, j);
        if (ratio > of_.limits().exchanged) continue;
        if (misfit(i, j) > misfit(i, i) || misfit(j, i) > misfit(j, j)) continue;  // one faulty thermometer
        const double a = of_.weigh(i, j, of_.all(), {}).nats - free_nats(i),
                     b = of_.weigh(j, i, of_.all(), {}).nats - free_nats(j);
        const double stretched = a > 0 && b > 0 ? a + b : 0;  // by how much less calibration must stretch
        const double nats = std::max(stretched, ratio < of_.limits().plain ? of_.plain_nats(ratio) : 0.);
        if (nats > of_.limits().suspected_nats) pairs.push_back({i, j, nats});
      }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.nats > b.nats; });
    std::vector<std::size_t> used;
    std::vector<DataProblem> told;
    for (const Pair& one : pairs) {
      const auto is_used = [&](std::size_t c) { return std::count(used.begin(), used.end(), c) > 0; };
      if (is_used(one.a) || is_used(one.b)) continue;
      used.insert(used.end(), {one.a, one.b});
      DataProblem one_told = of_.problem(Kind::swapped, {of_.channel(one.a).name, of_.channel(one.b).name}, one.nats);
      one_told.side = Side::either;
      told.push_back(std::move(one_told));
    }
    return told;
  }

 private:
  using Kind = DataProblem::Kind;
  using Side = DataProblem::Side;

  /// A channel as given, its reading off by an offset and a gain of its own as far as faulty ones are.
  double free_nats(std::size_t c) {
    if (const auto known = free_nats_.find(c); known != free_nats_.end()) return known->second;
    return free_nats_[c] = found_free_nats(c);
  }

  double found_free_nats(std::size_t c) {
    MatrixX<Scalar> alike(of_.courses(c, c, of_.all()).second.size(), 2);
    if (of_.channel(c).displacement) return of_.weigh(c, of_.all(), {}).nats;
    const std::vector<VectorX<Scalar>> faults = lookalikes<Scalar>(of_, c, of_.all());
    alike << .2 * faults[0], .3 * faults[1];
    return std::max(of_.weigh(c, of_.all(), {}).nats, of_.weigh(c, of_.all(), {}, alike).nats);
  }

  SideWeighing<Scalar>& of_;
  std::map<std::size_t, double> free_nats_;
};

}  // namespace thermfit::detail
