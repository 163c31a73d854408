#pragma once

/// Temperatures in another unit on one of the sides.

#include <algorithm>
#include <utility>
#include <vector>

#include "thermfit/diagnosis/sides/lookalikes.hpp"

namespace thermfit::detail {

/// Looks for the unit of a temperature channel.
template <typename Scalar = double>
class TemperatureUnits {
 public:
  explicit TemperatureUnits(SideWeighing<Scalar>& of) : of_(of) {}

  /// Temperatures that disagree by more than any machine does, and agree in another unit: one for all batches that do.
  std::vector<DataProblem> run(std::size_t c) const {
    const std::vector<Reading> readings = temperature_readings();
    BatchNumbers odd;
    std::vector<double> misfit(readings.size(), 0);
    for (const std::size_t b : of_.all()) {
      const auto [y, x] = of_.courses(c, c, {b});
      if (!(rms_of<Scalar>(VectorX<Scalar>(y - x)) > of_.limits().level_K)) continue;
      odd.push_back(b);
      for (std::size_t r = 0; r < readings.size(); ++r) misfit[r] += misfit_K(y, x, readings[r]);
    }
    if (odd.empty()) return {};
    const std::size_t best = static_cast<std::size_t>(std::min_element(misfit.begin(), misfit.end()) - misfit.begin());
    const Reading& reading = readings[best];
    BatchNumbers in;
    for (const std::size_t b : of_.all()) {
      const auto [y, x] = of_.courses(c, c, {b});
      if (misfit_K(y, x, reading) < misfit_K(y, x, {})) in.push_back(b);
    }
    if (best == 0 || in.empty()) return {};
    const double nats = margin<Scalar>(of_, c, in, reading);
    if (nats < of_.limits().suspected_nats) return {};
    DataProblem one = of_.problem(Kind::unit, {of_.channel(c).name}, nats);
    one.side = reading.simulated ? Side::simulated : Side::measured;
    one.unit = reading.unit;
    one.batches = of_.names_of(in);
    return {std::move(one)};
  }

 private:
  using Kind = DataProblem::Kind;
  using Side = DataProblem::Side;

  /// What a reading leaves between temperatures, K.
  static double misfit_K(const VectorX<Scalar>& y, const VectorX<Scalar>& x, const Reading& reading) {
    const VectorX<Scalar> gap = (reading.scale * y - x).array() + reading.shift;
    return rms_of<Scalar>(gap) / (reading.simulated ? reading.scale : 1);
  }

  SideWeighing<Scalar>& of_;
};

}  // namespace thermfit::detail
