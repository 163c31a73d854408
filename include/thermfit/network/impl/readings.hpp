#pragma once

#include <vector>

#include "thermfit/network/impl/drive.hpp"
#include "thermfit/network/impl/integrator.hpp"
#include "thermfit/network/impl/time_grid.hpp"

namespace thermfit::detail {

/// What sensors and displacement probes show of the state, and the tangents of it.
template <typename Scalar>
class Readings {
 public:
  Readings(const Lazy<ThermalSystem, Scalar>& system, const Drive<Scalar>& drive)
      : system_(system),
        drive_(drive),
        state_columns_(system, drive),
        sensors_(static_cast<Index>(system.sensors.size())),
        samples_(drive.samples()) {
    const Index channels = sensors_ + static_cast<Index>(system.displacements.size());
    values_.resize(samples_, channels);
    tangents_.setZero(samples_ * channels, system.columns);
    for (const ThermalSystem::Sensor& sensor : system.sensors)
      any_response_ = any_response_ || sensor.response_s != 0 || sensor.response_column >= 0;
    rates_ = VectorX<Scalar>::Zero(static_cast<Index>(system.capacities.size()));
  }

  /// By how much the displacements are logged late.
  double delay_s() const {
    double sum = 0;
    for (const BoundLaw& law : system_.delays) sum += system_.value(law, Moment{});
    return sum;
  }

  /// The rates that late readings show at `end_s`: those just before, under the inputs held since `sample`.
  void take_rates(Index sample, double end_s, Integrator<Scalar>& now) {
    if (any_response_) rates_ = now.rates(sample, end_s);
  }

  void take_temperatures(Index sample, const Regime<Scalar>& regime, const Integrator<Scalar>& now) {
    const double time_s = drive_.time_s(sample);
    if (!state_columns_.columns().empty())
      block_.noalias() = regime.outputs.leftCols(sensors_).transpose() * now.modal_tangents();
    for (Index s = 0; s < sensors_; ++s) {
      const ThermalSystem::Sensor& sensor = system_.sensors[static_cast<std::size_t>(s)];
      const bool air = sensor.node < 0;
      double degC = air ? drive_.ambient(sample, time_s) : now.temperatures()(sensor.node);
      if (!air)
        for (const auto& [neighbour, share] : sensor.placement)
          degC += share * (now.temperatures()(neighbour) - now.temperatures()(sensor.node));
      const bool late = sensor.response_s != 0 || sensor.response_column >= 0;
      if (!air && late) degC -= sensor.response_s * rates_(sensor.node);
      values_(sample, s) = degC + sensor.offset_K;
      if (system_.columns == 0) continue;
      auto row = tangents_.row(s * samples_ + sample);
      if (sensor.response_column >= 0) row(sensor.response_column) -= rates_(sensor.node);
      if (!air)
        scatter(block_, s, row);
      else if (drive_.ambient_moves())
        row = drive_.ambient_tangent(sample, time_s);
      if (sensor.column >= 0) row(sensor.column) += 1;
      for (std::size_t k = 0; k < sensor.placement_columns.size(); ++k)
        if (const Column column = sensor.placement_columns[k]; column >= 0)
          row(column) += now.temperatures()(sensor.placement[k].first) - now.temperatures()(sensor.node);
    }
  }

  void take_displacements(Index sample, const GridPoint& point, const Regime<Scalar>& regime, Integrator<Scalar>& now) {
    const VectorX<Scalar>& degC = now.temperatures();
    const Index outputs = static_cast<Index>(system_.displacements.size());
    if (!state_columns_.columns().empty())
      block_.noalias() = regime.outputs.rightCols(outputs).transpose() * now.modal_tangents();
    for (Index d = 0; d < outputs; ++d) {
      const ThermalSystem::Displacement& output = system_.displacements[static_cast<std::size_t>(d)];
      double z = 0;
      for (const auto& [node, um_per_K] : output.um_per_K) z += um_per_K * (degC(node) - system_.reference_degC);
      const Moment moment = drive_.moment(point.sample, point.time_s, degC.data());
      for (const auto& term : output.terms) z += system_.value(term.law, moment);
      values_(sample, sensors_ + d) = z;
      if (system_.columns == 0) continue;
      auto row = tangents_.row((sensors_ + d) * samples_ + sample);
      scatter(block_, d, row);
      for (std::size_t k = 0; k < output.um_per_K.size(); ++k)
        if (output.columns[k] >= 0) row(output.columns[k]) += degC(output.um_per_K[k].first) - system_.reference_degC;
      for (const auto& term : output.terms) add_term_tangent(term, point, regime, now, row);
      if (!system_.delays.empty() && drive_.time_s(sample) - delay_s() > drive_.time_s(0)) {
        const double speed = displacement_rate(output, point, now);
        for (const BoundLaw& law : system_.delays)
          system_.derivatives(law, Moment{}, [&](Column column, double slope) { row(column) -= speed * slope; });
      }
    }
  }

  /// What acts on whole series: play and the like, zeroing, laws of readings.
  void finish() {
    for (Index d = 0; d < static_cast<Index>(system_.displacements.size()); ++d) {
      const ThermalSystem::Displacement& output = system_.displacements[static_cast<std::size_t>(d)];
      auto series = values_.col(sensors_ + d);
      auto block = tangents_.middleRows((sensors_ + d) * samples_, samples_);
      for (const auto& one : output.operators) {
        MatrixX<Scalar> tangents = block;
        const BoundLaw::Owner& owner = system_.owners[one.owner];
        one.law(series, tangents, owner.values.data(), owner.columns.data());
        block = tangents;
      }
      if (output.free_datum) {
        series.array() -= double(series.mean());
        const RowVectorX<Scalar> mean = block.colwise().mean();
        block.rowwise() -= mean;
        continue;
      }
      if (!output.zero_at_first_sample) continue;
      series.array() -= double(series(0));
      const RowVectorX<Scalar> first = block.row(0);
      block.rowwise() -= first;
    }
    for (Index s = 0; s < sensors_; ++s)
      for (const BoundLaw& law : system_.sensors[static_cast<std::size_t>(s)].laws) apply_reading(s, law);
  }

  MatrixX<Scalar>& values() { return values_; }
  RowMatrixX<Scalar>& tangents() { return tangents_; }

 private:
  /// Adds a row of tangents of the state to a row of all parameters.
  template <class Block, class Row>
  void scatter(const Block& block, Index from, Row& row) const {
    const std::vector<Column>& columns = state_columns_.columns();
    for (std::size_t j = 0; j < columns.size(); ++j) row(columns[j]) += block(from, static_cast<Index>(j));
  }

  template <class Row>
  void add_term_tangent(const ThermalSystem::Displacement::Term& term, const GridPoint& point,
                        const Regime<Scalar>& regime, const Integrator<Scalar>& now, Row& row) {
    VectorX<Scalar> degC = now.temperatures();
    const Moment moment = drive_.moment(point.sample, point.time_s, degC.data());
    for (const Index node : term.depends_on) {
      const double kept = degC(node), step = 1e-3;
      degC(node) = kept + step;
      const double above = system_.value(term.law, moment);
      degC(node) = kept - step;
      const double slope = (above - system_.value(term.law, moment)) / (2 * step);
      degC(node) = kept;
      if (slope != 0) {
        const RowVectorX<Scalar> moved = regime.propagator.modes().col(node).transpose() * now.modal_tangents();
        scatter(slope * moved, 0, row);
      }
    }
    if (drive_.ambient_moves()) {
      Moment above = moment, below = moment;
      above.ambient_degC += 1e-3;
      below.ambient_degC -= 1e-3;
      row += (system_.value(term.law, above) - system_.value(term.law, below)) / 2e-3 *
             drive_.ambient_tangent(point.sample, point.time_s);
      // The difference to the first sample moves too.
      above = below = moment;
      above.first_ambient_degC += 1e-3;
      below.first_ambient_degC -= 1e-3;
      row += (system_.value(term.law, above) - system_.value(term.law, below)) / 2e-3 *
             drive_.ambient_tangent(0, drive_.time_s(0));
    }
    system_.derivatives(term.law, moment, [&](Column column, double slope) { row(column) += slope; });
  }

  /// dz/dt along the trajectory.
  double displacement_rate(const ThermalSystem::Displacement& output, const GridPoint& point, Integrator<Scalar>& now) {
    const VectorX<Scalar> rates = now.rates(point.sample, point.time_s);
    double speed = 0;
    for (const auto& [node, um_per_K] : output.um_per_K) speed += um_per_K * rates(node);
    if (output.terms.empty()) return speed;
    const double step_s = 0.01;
    const VectorX<Scalar> later = now.temperatures() + step_s * rates, sooner = now.temperatures() - step_s * rates;
    Moment after = drive_.moment(point.sample, point.time_s, later.data()), before = after;
    before.temperature_degC = sooner.data();
    for (auto [moment, shift_s] : {std::pair(&after, step_s), std::pair(&before, -step_s)}) {
      moment->time_s += shift_s;
      moment->ambient_degC += shift_s * drive_.ambient_rate(point.sample);
      moment->measured_ambient_degC += shift_s * drive_.measured_ambient_rate(point.sample);
    }
    for (const auto& term : output.terms)
      speed += (system_.value(term.law, after) - system_.value(term.law, before)) / (2 * step_s);
    return speed;
  }

  void apply_reading(Index s, const BoundLaw& law) {
    for (Index k = 0; k < samples_; ++k) {
      Moment now = drive_.moment(k, drive_.time_s(k), nullptr);
      now.reading_degC = values_(k, s);
      if (system_.columns > 0) {
        Moment above = now, below = now;
        above.reading_degC += 1e-3;
        below.reading_degC -= 1e-3;
        auto row = tangents_.row(s * samples_ + k);
        row *= (system_.value(law, above) - system_.value(law, below)) / 2e-3;
        system_.derivatives(law, now, [&](Column column, double slope) { row(column) += slope; });
      }
      values_(k, s) = system_.value(law, now);
    }
  }

  const Lazy<ThermalSystem, Scalar>& system_;
  const Drive<Scalar>& drive_;
  const StateColumns<Scalar> state_columns_;
  const Index sensors_, samples_;
  MatrixX<Scalar> values_;       ///< samples x channels
  RowMatrixX<Scalar> tangents_;  ///< (channel * samples + sample) x parameters
  MatrixX<Scalar> block_;
  bool any_response_ = false;
  VectorX<Scalar> rates_;  ///< dtheta/dt of every node before the present sample; at rest before the first
};

}  // namespace thermfit::detail
