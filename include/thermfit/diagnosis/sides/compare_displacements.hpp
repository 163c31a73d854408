#pragma once

/// Displacements in another unit, with another factor, or turned round on one of the sides.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/sides/lookalikes.hpp"

namespace thermfit::detail {

/// Looks for unit and sign of a displacement.
template <typename Scalar = double>
class DisplacementUnits {
 public:
  explicit DisplacementUnits(SideWeighing<Scalar>& of) : of_(of) {}

  /// What is wrong with displacement `c`, in all batches or in some.
  std::vector<DataProblem> run(std::size_t c) {
    double factor = 1;
    const Reading whole = multiple(c, of_.all(), factor);
    if (!whole.as_given()) {
      tell_displacement(c, of_.all(), whole, factor);
      return std::move(told_);
    }
    std::map<std::pair<std::string, std::pair<bool, bool>>, std::pair<Reading, BatchNumbers>> single;
    for (const std::size_t b : of_.all()) {
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
    return std::move(told_);
  }

 private:
  using Kind = DataProblem::Kind;
  using Side = DataProblem::Side;

  /// How a displacement of one side is a multiple of the other: factor and sign; as given where it is neither.
  Reading multiple(std::size_t c, const BatchNumbers& batches, double& factor) const {
    auto [y, x] = of_.courses(c, c, batches);
    of_.centre(y, batches), of_.centre(x, batches);
    const double moved = y.norm(), moves = x.norm();
    factor = moves > 0 ? moved / moves : 0;
    Reading best;
    if (!(moved > 0 && moves > 0)) return best;
    const double correlation = x.dot(y) / (moved * moves);
    if (std::abs(correlation) < of_.limits().least_correlation) return best;
    double least = std::log(of_.limits().unit_within);
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
    if (!found && plausible > std::log(of_.limits().beyond_belief)) best = {"counts", false, false, 1 / factor, 0};
    best.turned = correlation < 0;
    return best;
  }

  /// Whether it is this side that moves by what no machine does.
  static bool more_plausible(bool simulated, const VectorX<Scalar>& y, const VectorX<Scalar>& x) {
    const auto odd = [](double rms) { return std::abs(std::log(rms / 20)); };  // machines are off by some 20 um
    return odd(rms_of<Scalar>(simulated ? x : y)) > odd(rms_of<Scalar>(simulated ? y : x));
  }

  void tell_displacement(std::size_t c, const BatchNumbers& batches, const Reading& reading, double factor) {
    const double nats = margin<Scalar>(of_, c, batches, reading);
    if (nats < of_.limits().suspected_nats) return;
    const auto add = [&](Kind kind) {
      DataProblem one = of_.problem(kind, {of_.channel(c).name}, nats);
      one.side = kind == Kind::unit ? (reading.simulated ? Side::simulated : Side::measured) : Side::either;
      if (kind == Kind::unit) one.unit = reading.unit;
      one.figure = factor;
      one.batches = of_.names_of(batches);
      told_.push_back(std::move(one));
    };
    if (reading.unit == "counts")
      add(Kind::factor);
    else if (!reading.unit.empty())
      add(Kind::unit);
    if (reading.turned) add(Kind::sign);
  }

  SideWeighing<Scalar>& of_;
  std::vector<DataProblem> told_;
};

}  // namespace thermfit::detail
